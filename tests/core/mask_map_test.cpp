// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/mask_map.h"

#include <gtest/gtest.h>

#include <random>

#include "core/sampling/warp.h"
#include "core/scene/coverage.h"
#include "core/traversal/barycentric.h"
#include "core/traversal/embree.h"
#include "tests/support/scenes.h"

namespace petzval {
namespace {

class Draws {
  public:
    explicit Draws(unsigned seed) : engine_(seed) {}
    float operator()(float low = 0, float high = 1) {
        return std::uniform_real_distribution<float>(low, high)(engine_);
    }
    V3f direction() {
        const float a = (*this)(), b = (*this)();
        return uniform_sphere({a, b});
    }

  private:
    std::mt19937 engine_;
};

// Blobs with edges a few texels soft. Bytes, or floats of the same values.
Image blobs(int width, int height, bool bytes) {
    Image image;
    image.width = width, image.height = height;
    std::vector<uint8_t> codes;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // No period of the picture: its opposite borders differ.
            const float wave = std::sin(0.11f * float(x) + 1) + std::sin(0.13f * float(y));
            codes.insert(codes.end(), 3, 255);
            codes.push_back(static_cast<uint8_t>(255 * clamp_unit(0.5f + 2 * wave)));
        }
    if (bytes)
        image.texels = codes;
    else
        image.texels = std::vector<float>(codes.begin(), codes.end());
    if (!bytes)
        for (float& t : std::get<std::vector<float>>(image.texels)) t *= 1.f / 255.f;
    return image;
}

Material masked_material(Wrap wrap_u, Wrap wrap_v) {
    Material m = test::diffuse_material(0.5f);
    m.alpha_mode = AlphaMode::Mask;
    m.alpha = 0.9f;
    m.alpha_cutoff = 0.3f;
    m.base_color_texture.image = 0;
    m.base_color_texture.wrap_u = wrap_u, m.base_color_texture.wrap_v = wrap_v;
    return m;
}

struct Kind {
    Wrap u, v;
    bool instanced;
};

// Loose triangles of many sizes and shapes, at world coordinates, or placed five times.
Scene triangles(const Kind& kind, Draws& random, bool bytes = true) {
    Scene scene;
    scene.images.push_back(blobs(160, 120, bytes));
    Material m = masked_material(kind.u, kind.v);
    m.base_color_texture.u_row = {1.2f, 0.3f, 0.1f};
    m.base_color_texture.nearest = kind.u == Wrap::MirroredRepeat;
    Mesh mesh;
    const float spread = kind.instanced ? 4.f : 40.f;
    for (uint32_t i = 0; i < 60; ++i) {
        const float size = std::pow(10.f, random(-2, 1));
        const V3f at = random.direction() * random(0, spread);
        const V2f uv(random(-2, 2), random(-2, 2));
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(at + random.direction() * size);
            mesh.uv[0].push_back(uv + V2f(random(-1, 1), random(-1, 1)));
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    test::place(scene, std::move(mesh), m);
    if (kind.instanced) {
        scene.instances.clear();
        for (int i = 0; i < 5; ++i) {
            Instance instance;
            M44f& to_world = instance.to_world;
            instance.identity = false;
            const V3f z = random.direction(), x = unit(z.cross(random.direction())), y = z.cross(x);
            const float scale = std::pow(10.f, random(-1, 1));
            const V3f stretch(scale, scale * random(0.4f, 1), scale * random(0.4f, 1));
            for (int k = 0; k < 3; ++k) {
                to_world[0][k] = x[k] * stretch.x, to_world[1][k] = y[k] * stretch.y;
                to_world[2][k] = z[k] * stretch.z;
                to_world[3][k] = random(-30, 30);
            }
            const M44f back = to_world.inverse();
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) instance.to_local[j][k] = back[j][k];
            scene.instances.push_back(instance);
        }
    }
    finish_scene(scene);
    return scene;
}

V3f corner(const Scene& scene, uint32_t instance, uint32_t vertex) {
    const Instance& placed = scene.instances[instance];
    const V3f& p = scene.meshes[placed.mesh].positions[vertex];
    return placed.identity ? p : p * placed.to_world;
}

// A ray to a random point of a triangle; hard: from far and along its plane too.
Ray ray_to_some_triangle(const Scene& scene, Draws& random, bool hard = true) {
    const auto pick = [&](size_t count) {
        return std::min(static_cast<uint32_t>(random() * float(count)), uint32_t(count - 1));
    };
    const uint32_t instance = pick(scene.instances.size()), triangle = pick(60);
    const V3f a = corner(scene, instance, 3 * triangle),
              b = corner(scene, instance, 3 * triangle + 1),
              c = corner(scene, instance, 3 * triangle + 2);
    const float s = random(), t = random(0, 1 - s);
    const V3f at = a + (b - a) * s + (c - a) * t, normal = unit((b - a).cross(c - a));
    V3f away = random.direction();
    away += normal * (normal.dot(away) * (std::pow(10.f, hard ? random(-4, 0) : 0) - 1));
    Ray ray;
    ray.origin = at + unit(away) * ((b - a).length() * std::pow(10.f, random(-1, hard ? 3 : 1)));
    ray.direction = (at - ray.origin) * (random() < 0.5f ? 1 / (at - ray.origin).length() : 1);
    return ray;
}

constexpr Kind kKinds[] = {{Wrap::Repeat, Wrap::ClampToEdge, false},
                           {Wrap::ClampToEdge, Wrap::MirroredRepeat, true},
                           {Wrap::MirroredRepeat, Wrap::Repeat, true},
                           {Wrap::Repeat, Wrap::Repeat, false}};

// The opaque scene tells what Embree's coordinates are; what the map says of them must be what
// coverage() says of the exact ones.
TEST(MaskMap, AnswersAsTheExactPlaceDoes) {
    Draws random(5);
    for (const Kind& kind : kKinds)
        for (const Traversal traversal : {Traversal::Robust, Traversal::Fast}) {
            const Scene scene = triangles(kind, random);
            Scene opaque = scene;
            for (Material& m : opaque.materials) m.alpha_mode = AlphaMode::Opaque;
            const Bvh bvh(opaque, traversal);
            const Mesh& mesh = scene.meshes[0];
            const MaskMap map(scene, scene.materials[mesh.material]);
            const MaskedMesh masked(scene, mesh, map);
            ASSERT_FALSE(masked.empty());
            int hits = 0, answers = 0, easy = 0, easy_answers = 0, covered = 0, wrong = 0;
            for (int i = 0; i < 100000; ++i) {
                const bool hard = i % 2 == 0;
                const Ray ray = ray_to_some_triangle(scene, random, hard);
                embree::Context context = embree::new_context();
                RTCRayHit q{};
                q.ray.org_x = ray.origin.x, q.ray.org_y = ray.origin.y, q.ray.org_z = ray.origin.z;
                q.ray.dir_x = ray.direction.x, q.ray.dir_y = ray.direction.y;
                q.ray.dir_z = ray.direction.z;
                q.ray.tfar = kInfinity, q.ray.mask = ~0u;
                q.hit.geomID = q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                embree::intersect(bvh.native(), context, nullptr, q);
                if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
                ++hits, easy += !hard;
                const uint32_t instance = kind.instanced ? q.hit.instID[0] : 0;
                V3f direction = ray.direction;
                float more = 0;
                if (kind.instanced) {
                    const Instance& placed = scene.instances[instance];
                    direction = direction * placed.to_local;
                    more = MaskedMesh::rounding_of(placed, ray, q.ray.tfar);
                }
                const auto answer = masked.covers(q.hit.primID, {q.hit.u, q.hit.v},
                                                  {q.hit.Ng_x, q.hit.Ng_y, q.hit.Ng_z}, direction,
                                                  q.ray.tfar, more);
                if (!answer) continue;
                const bool exact = coverage(scene, instance, q.hit.primID,
                                            barycentric(scene, instance, q.hit.primID, ray)) > 0;
                ++answers, easy_answers += !hard;
                covered += exact;
                wrong += *answer != exact;
            }
            EXPECT_EQ(wrong, 0) << "of " << answers;
            EXPECT_GT(hits, 90000);
            EXPECT_GT(easy_answers, 0.3 * easy);
            EXPECT_GT(answers - easy_answers, 0.05 * hits);
            EXPECT_GT(covered, 0.1 * answers);
            EXPECT_LT(covered, 0.9 * answers);
        }
}

// A texture of floats has no map.
TEST(MaskMap, RaysMeetTheSameWithoutIt) {
    for (const Kind& kind : kKinds) {
        Draws random(6), again(6);
        const Scene scene = triangles(kind, random), exact = triangles(kind, again, false);
        ASSERT_TRUE(MaskMap(exact, exact.materials[0]).answers.empty());
        const Bvh with(scene, Traversal::Robust), without(exact, Traversal::Robust);
        EXPECT_GT(with.bytes(), without.bytes() + 160 * 120 / 4 - 200);
        int holes = 0, differ = 0;
        for (int i = 0; i < 20000; ++i) {
            const Ray ray = ray_to_some_triangle(scene, random);
            const auto a = with.intersect(ray), b = without.intersect(ray);
            differ += a.has_value() != b.has_value() ||
                      (a && (a->instance != b->instance || a->triangle != b->triangle));
            differ += with.occluded(ray) != without.occluded(ray);
            holes += !a;
        }
        EXPECT_EQ(differ, 0);
        EXPECT_GT(holes, 2000);
    }
}

// Within the margin of a hole's border nothing is said, and beyond it everything, whether the
// cutoff lies at the border or the factor moves it.
TEST(MaskMap, SaysNothingNearTheBorder) {
    Scene scene;
    Image halves;  // left covered, right not
    halves.width = 64, halves.height = 1;
    std::vector<uint8_t> texels;
    for (int x = 0; x < 64; ++x)
        texels.insert(texels.end(), {255, 255, 255, static_cast<uint8_t>(x < 32 ? 200 : 100)});
    halves.texels = texels;
    scene.images.push_back(halves);
    Material m = masked_material(Wrap::ClampToEdge, Wrap::ClampToEdge);
    m.alpha = 1, m.alpha_cutoff = 0.5f;
    Mesh mesh = test::quad(V3f(0), V3f(1, 0, 0), V3f(0, 1, 0));
    const auto says = [&](float texel) {
        const MaskMap map(scene, m);
        return MaskedMesh(scene, mesh, map)
            .covers(0, {texel / 64, 0}, V3f(0, 0, 1), V3f(0, 0, 1), 1, 0);
    };
    EXPECT_EQ(says(0.1f), true);
    EXPECT_EQ(says(28.f), true);
    EXPECT_EQ(says(30.5f), std::nullopt);
    EXPECT_EQ(says(33.5f), std::nullopt);
    EXPECT_EQ(says(36.f), false);
    EXPECT_EQ(says(63.9f), false);
    m.base_color_texture.wrap_u = Wrap::Repeat;
    EXPECT_EQ(says(1.f), std::nullopt);
    EXPECT_EQ(says(63.f), std::nullopt);
    m.alpha_cutoff = 0.3f;
    EXPECT_EQ(says(33.f), true);
    m.alpha = 0.3f;
    EXPECT_EQ(says(33.f), false);
    m.alpha = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(says(5.f), std::nullopt);
    m.alpha_mode = AlphaMode::Blend;
    EXPECT_TRUE(MaskMap(scene, m).answers.empty());
}

TEST(MaskMap, ColoursMotionAndHugeTextureCoordinatesAreLeftToTheExactWay) {
    Scene scene;
    scene.images.push_back(blobs(64, 64, true));
    test::place(scene, test::quad(V3f(0), V3f(1, 0, 0), V3f(0, 1, 0)),
                masked_material(Wrap::Repeat, Wrap::Repeat));
    const MaskMap map(scene, scene.materials[0]);
    const auto empty = [&](const Mesh& mesh) { return MaskedMesh(scene, mesh, map).empty(); };
    Mesh mesh = scene.meshes[0];
    EXPECT_FALSE(empty(mesh));
    mesh.colours.assign(4, V4f(1));
    EXPECT_TRUE(empty(mesh));
    mesh = scene.meshes[0], mesh.steps.resize(2);
    EXPECT_TRUE(empty(mesh));
    mesh = scene.meshes[0], mesh.uv[0].clear();
    EXPECT_TRUE(empty(mesh));
    for (const float far : {1e4f, std::numeric_limits<float>::quiet_NaN()}) {
        mesh = scene.meshes[0], mesh.uv[0][2].x = far;
        EXPECT_TRUE(empty(mesh));
    }
    const Ray ray{V3f(1, 0, 0), V3f(0, 0, 1)};
    const auto rounding = [&](const Instance& i) { return MaskedMesh::rounding_of(i, ray, 1); };
    Instance placed;
    EXPECT_LT(rounding(placed), 6.f);
    placed.moves = true;
    EXPECT_EQ(rounding(placed), kInfinity);
    placed.moves = false;
    placed.to_world[2][2] = 1e-3f, placed.to_local[2][2] = 1e3f;
    EXPECT_EQ(rounding(placed), kInfinity);
}

}  // namespace
}  // namespace petzval
