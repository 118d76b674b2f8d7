// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/bvh.h"

#include <gtest/gtest.h>

#include <random>

#include "core/light/light_sampling.h"
#include "core/sampling/warp.h"
#include "core/shading/surface.h"
#include "core/traversal/embree.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::diffuse_material;
using test::emitter_material;
using test::place;
using test::quad;
using test::sphere;

class Triangles {
  public:
    explicit Triangles(unsigned seed) : engine_(seed) {}
    float operator()() { return std::min(uniform_(engine_), kOneMinus); }
    V3f direction() {
        const float a = (*this)(), b = (*this)();
        return uniform_sphere({a, b});
    }

  private:
    std::mt19937 engine_;
    std::uniform_real_distribution<float> uniform_;
};

struct Crossing {
    int hits = 0, self_hits = 0, leaks = 0;
};

// Rays from inside a closed convex mesh: each must hit; what leaves the hit outward must hit
// nothing, what leaves it inward must hit the other side.
Crossing cross_convex(const Scene& scene, const Bvh& bvh, V3f centre, float radius, int rays) {
    Triangles random(17);
    Crossing count;
    for (int i = 0; i < rays; ++i) {
        Ray ray;
        ray.origin = centre + random.direction() * (0.5f * radius * random());
        ray.direction = random.direction();
        const auto hit = bvh.intersect(ray);
        if (!hit) {
            ++count.leaks;
            continue;
        }
        ++count.hits;
        const Surface s = make_surface(scene, ray.direction, *hit);
        V3f away = random.direction();
        if (away.dot(s.ng) < 0) away = -away;
        Ray out;
        out.origin = offset_origin(s.p, s.p_error, s.ng, away);
        out.direction = away;
        count.self_hits += bvh.intersect(out).has_value();
        Ray in;
        in.origin = offset_origin(s.p, s.p_error, s.ng, -away);
        in.direction = -away;
        const auto far_side = bvh.intersect(in);
        if (!far_side)
            ++count.leaks;
        else
            count.self_hits += far_side->triangle == hit->triangle;
    }
    return count;
}

TEST(Math, NeighboursAreThoseOfTheLibrary) {
    for (uint32_t i = 0; i < 100000; ++i) {
        const float a = i == 0 ? 0.f : i == 1 ? -0.f : std::bit_cast<float>(hash32(i));
        if (!std::isfinite(a)) continue;
        ASSERT_EQ(neighbour(a, true), std::nextafter(a, kInfinity)) << a;
        ASSERT_EQ(neighbour(a, false), std::nextafter(a, -kInfinity)) << a;
    }
}

// The offset follows the error of the point, so that neither the scale of a scene nor its distance
// from the origin matters.
TEST(Bvh, RaysLeaveSurfacesAtEveryScaleAndPlace) {
    for (const float radius : {1e-4f, 1e-2f, 1.f, 1e3f, 1e6f})
        for (const float away : {0.f, 10.f, 1e3f}) {
            Scene scene;
            const V3f centre(away * radius, -0.7f * away * radius, 0.3f * away * radius);
            place(scene, sphere(centre, radius, 24, false), diffuse_material(0.5f));
            finish_scene(scene);
            const Bvh bvh(scene, Traversal::Robust);
            const Crossing count = cross_convex(scene, bvh, centre, radius, 20000);
            EXPECT_EQ(count.self_hits, 0) << "radius " << radius << " away " << away;
            EXPECT_EQ(count.leaks, 0) << "radius " << radius << " away " << away;
            EXPECT_EQ(count.hits, 20000);
        }
}

// Embree by itself takes AVX-512 where there is some, which rounds otherwise than AVX2.
TEST(Bvh, TracesWithInstructionsThatEveryProcessorHas) {
    Scene scene;
    place(scene, sphere(V3f(0.f), 1.f, 4, false), diffuse_material(0.5f));
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    RTCDevice device = rtcGetSceneDevice(bvh.native());
    EXPECT_EQ(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED), 0);
    EXPECT_EQ(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED), 1);
    rtcReleaseDevice(device);
}

// Barycentric coordinates by Cramer's rule in long double.
V2f cramer(const std::array<V3f, 3>& corner, const Ray& ray) {
    using V3 = Imath::Vec3<long double>;
    const V3 a(corner[0]), d(ray.direction), e1 = V3(corner[1]) - a, e2 = V3(corner[2]) - a;
    const V3 s = V3(ray.origin) - a, p = d.cross(e2), q = s.cross(e1);
    const long double determinant = e1.dot(p);
    return {static_cast<float>(s.dot(p) / determinant), static_cast<float>(d.dot(q) / determinant)};
}

// Embree's own coordinates come from an approximate reciprocal, which is another number on
// processors of another maker. Those of a hit must have nothing but the rounding to float.
TEST(Bvh, CoordinatesOfAHitFollowFromRayAndTriangleAlone) {
    for (const bool instanced : {false, true}) {
        Scene scene;
        place(scene, sphere(V3f(0.f), 1.f, 24, false), diffuse_material(0.5f));
        Instance& instance = scene.instances[0];
        instance.identity = !instanced;
        instance.to_world.setScale(V3f(2.f, 4.f, 0.5f));  // exact, and so is its inverse
        instance.to_local = M33f(0.5f, 0, 0, 0, 0.25f, 0, 0, 0, 2.f);
        finish_scene(scene);
        const Bvh bvh(scene, Traversal::Robust);
        Triangles random(23);
        int differing = 0;
        for (int i = 0; i < 20000; ++i) {
            Ray ray;
            ray.origin = random.direction() * (0.4f * random());
            ray.direction = random.direction();
            const auto hit = bvh.intersect(ray);
            ASSERT_TRUE(hit);
            const V2f b = cramer(triangle_corners(scene, hit->instance, hit->triangle), ray);
            for (int k = 0; k < 2; ++k)
                differing += b[k] > 1e-3f && neighbour(b[k], true) != hit->barycentric[k] &&
                             neighbour(b[k], false) != hit->barycentric[k] &&
                             b[k] != hit->barycentric[k];
        }
        EXPECT_EQ(differing, 0) << instanced;
    }
}

TEST(Bvh, CoordinatesStayInsideTheTriangle) {
    Scene scene;
    place(scene, sphere(V3f(0.f), 1.f, 24, false), diffuse_material(0.5f));
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    const Mesh& mesh = scene.meshes[0];
    size_t met = 0;
    for (const V3f& corner : mesh.positions)  // along edges too, where a rounding decides
        for (const V3f& other : mesh.positions) {
            Ray ray;
            ray.origin = V3f(0.f);
            ray.direction = corner + (other - corner) * 0.25f;
            if (ray.direction.length() < 0.1f) continue;
            const auto hit = bvh.intersect(ray);
            if (!hit) continue;  // the sphere's seam has vertices of its own on either side
            ++met;
            const V2f b = hit->barycentric;
            ASSERT_TRUE(b.x >= 0.f && b.y >= 0.f && b.x + b.y <= 1.f + 1e-7f) << b.x << ' ' << b.y;
        }
    EXPECT_GT(met, mesh.positions.size() * mesh.positions.size() / 2);
}

TEST(Bvh, RaysLeaveInstancedSurfaces) {
    Scene scene;
    place(scene, sphere(V3f(0.f), 1.f, 24, false), diffuse_material(0.5f));
    Instance& instance = scene.instances[0];
    M44f m;
    m.scale(V3f(3.f, 3.f, 3.f));
    m[3][0] = 40.f, m[3][1] = -2.f, m[3][2] = 7.f;
    instance.identity = false;
    instance.to_world = m;
    instance.to_local = linear_part(m.inverse());
    finish_scene(scene);
    EXPECT_NEAR(scene.bounds.min.x, 37.f, 1e-4f);
    EXPECT_NEAR(scene.bounds.max.z, 10.f, 1e-4f);
    const Bvh bvh(scene, Traversal::Robust);
    const Crossing count = cross_convex(scene, bvh, V3f(40, -2, 7), 3.f, 50000);
    EXPECT_EQ(count.self_hits, 0);
    EXPECT_EQ(count.leaks, 0);
}

// A mirroring matrix turns the winding, not the front: glTF's front of a mirrored sphere is
// outside.
TEST(Bvh, MirroredInstancesKeepTheirFrontOutside) {
    for (const bool smooth : {false, true}) {
        Scene scene;
        place(scene, sphere(V3f(0.5f, 0, 0), 1.f, 24, smooth), emitter_material(1.f));
        scene.materials[0].double_sided = false;
        Instance& instance = scene.instances[0];
        M44f m;
        m.scale(V3f(-2.f, 1.f, 1.5f));
        instance.identity = false;
        instance.flips = true;
        instance.to_world = m;
        instance.to_local = linear_part(m.inverse());
        finish_scene(scene);
        const Bvh bvh(scene, Traversal::Robust);
        Triangles random(3);
        for (int i = 0; i < 1000; ++i) {
            Ray ray;
            const V3f outward = random.direction();
            ray.origin = V3f(-1.f, 0, 0) + outward * 9.f;
            ray.direction = -outward;
            const auto hit = bvh.intersect(ray);
            ASSERT_TRUE(hit);
            const Surface s = make_surface(scene, ray.direction, *hit);
            EXPECT_TRUE(s.front);
            EXPECT_LT(s.ng.dot(ray.direction), 0.f);
            EXPECT_GT(s.ns.dot(s.ng), 0.5f);
            // A light sample of the very triangle shines to where the hit says the front is.
            const Light light = TriangleLight{hit->instance, hit->triangle};
            EXPECT_TRUE(sample_light(scene, light, ray.origin, V2f(0.3f, 0.4f), Bands::rgb()));
        }
    }
}

TEST(Bvh, NoRayPassesAlongSharedEdges) {
    Scene scene;
    place(scene, sphere(V3f(0.f), 1.f, 12, false), diffuse_material(0.5f));
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    const Mesh& mesh = scene.meshes[0];
    int leaks = 0, rays = 0;
    for (const auto& t : mesh.triangles)
        for (int edge = 0; edge < 3; ++edge)
            for (int k = 0; k <= 16; ++k) {
                const V3f a = mesh.positions[t[edge]], b = mesh.positions[t[(edge + 1) % 3]];
                Ray ray;
                ray.origin = V3f(0.013f, -0.02f, 0.007f);
                ray.direction = unit(a + (b - a) * (static_cast<float>(k) / 16.f) - ray.origin);
                leaks += !bvh.intersect(ray);
                ++rays;
            }
    EXPECT_EQ(leaks, 0) << "of " << rays;
}

Scene leaf_scene(AlphaMode mode) {
    Scene scene;
    Material m = diffuse_material(0.5f);
    m.alpha_mode = mode;
    Image checks;  // 16 x 16, alpha 0 and 255 in turn for MASK, 64 everywhere for BLEND
    checks.width = checks.height = 16;
    std::vector<uint8_t> texels;
    for (int i = 0; i < 256; ++i) {
        const bool on = (i + i / 16) % 2 == 0;
        const uint8_t alpha = mode == AlphaMode::Mask ? (on ? 255 : 0) : 64;
        texels.insert(texels.end(), {255, 255, 255, alpha});
    }
    checks.texels = texels;
    scene.images.push_back(checks);
    m.base_color_texture.image = 0;
    m.base_color_texture.nearest = true;
    // Long thin triangles in a fan of slants invite spatial splits, which call a filter twice.
    for (int i = 0; i < 200; ++i) {
        const float a = 0.031f * static_cast<float>(i);
        place(scene,
              quad(V3f(-5 * std::cos(a), -5 * std::sin(a), 0.01f * static_cast<float>(i)),
                   V3f(10 * std::cos(a), 10 * std::sin(a), 0.02f),
                   V3f(-0.05f * std::sin(a), 0.05f * std::cos(a), 0.3f)),
              m);
    }
    finish_scene(scene);
    return scene;
}

// Were a filter's answer to change between two calls for one triangle, the two structures, which
// split triangles differently, would disagree.
TEST(Bvh, CutoutsAnswerTheSameHoweverOftenTheyAreAsked) {
    for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
        const Scene scene = leaf_scene(mode);
        const Bvh robust(scene, Traversal::Robust), fast(scene, Traversal::Fast);
        EXPECT_TRUE(robust.has_cutouts());
        Triangles random(23);
        int differ = 0, hits = 0;
        for (int i = 0; i < 40000; ++i) {
            Ray ray;
            ray.origin = V3f(8 * random() - 4, 8 * random() - 4, 9);
            ray.direction = unit(V3f(0.2f * random() - 0.1f, 0.2f * random() - 0.1f, -1));
            ray.alpha_seed = hash32(static_cast<uint32_t>(i));
            const auto a = robust.intersect(ray), b = fast.intersect(ray);
            hits += a.has_value();
            differ += a.has_value() != b.has_value() || (a && a->instance != b->instance);
            EXPECT_EQ(a.has_value(), robust.occluded(ray));
        }
        EXPECT_GT(hits, 1000);
        EXPECT_LE(differ, 4);  // edges, where the two tests for a triangle may round apart
    }
}

TEST(Bvh, BlendPassesItsShareOfRays) {
    Scene scene;
    Material m = diffuse_material(0.5f);
    m.alpha_mode = AlphaMode::Blend;
    m.alpha = 0.3f;
    place(scene, quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0)), m);
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    int hits = 0;
    constexpr int n = 40000;
    for (int i = 0; i < n; ++i) {
        Ray ray;
        ray.origin = V3f(0.1f, 0.2f, 1);
        ray.direction = V3f(0, 0, -1);
        ray.alpha_seed = hash32(static_cast<uint32_t>(i));
        hits += bvh.intersect(ray).has_value();
    }
    EXPECT_TRUE(test::agrees({hits / double(n), std::sqrt(0.3 * 0.7 / n)}, 0.3)) << hits;
}

TEST(Bvh, EmptySceneHasNothingToHit) {
    Scene scene;
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    Ray ray;
    ray.direction = V3f(0, 0, -1);
    EXPECT_FALSE(bvh.intersect(ray));
    EXPECT_FALSE(bvh.occluded(ray));
}

}  // namespace
}  // namespace petzval
