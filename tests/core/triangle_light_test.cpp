// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_sampling.h"

#include <numbers>

#include "core/scene/scene.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "tests/support/chi_square.h"
#include "tests/support/jacobian.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

using test::Random;

const Bands kTriangleRgb = Bands::rgb();

std::array<V3d, 3> corners(const Scene& scene, const TriangleLight& light) {
    const auto c = triangle_corners(scene, light.instance, light.triangle);
    return {V3d(c[0]), V3d(c[1]), V3d(c[2])};
}

// Distance along w from p to the triangle's plane, and whether the point is inside. Double
// precision.
std::optional<double> meet_triangle(const std::array<V3d, 3>& c, const V3d& p, const V3d& w) {
    const V3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double t = (c[0] - p).dot(n) / w.dot(n);
    const V3d at = p + w * t;
    for (int i = 0; i < 3; ++i)
        if ((c[(i + 1) % 3] - c[i]).cross(at - c[i]).dot(n) < 0) return std::nullopt;
    return t > 0 ? std::optional(t) : std::nullopt;
}

// From afar by area, from nearby by solid angle.
TEST(TriangleLight, SamplesFollowTheDensity) {
    Scene scene = test::lamp_scene();
    finish_scene(scene);
    const TriangleLight light{0, 0};
    const auto c = corners(scene, light);
    const V3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    for (const V3f& p : {V3f(0.2f, 0.1f, -0.3f), V3f(0.2f, 1.5f, -0.3f), V3f(0.3f, 1.9f, 0.3f)}) {
        const auto pdf = [&](const V3f& w) -> double {
            const auto t = meet_triangle(c, V3d(p), V3d(w));
            if (!t) return 0;
            return triangle_light_pdf(scene, light, p, static_cast<float>(*t * *t),
                                      static_cast<float>(normal.dot(V3d(w))));
        };
        const auto draw = [&](V2f u) -> std::optional<V3f> {
            const auto s = sample_light(scene, light, p, u, kTriangleRgb);
            if (!s) return std::nullopt;
            EXPECT_NEAR(s->pdf, pdf(s->direction) > 0 ? pdf(s->direction) : s->pdf, 1e-3 * s->pdf);
            return s->direction;
        };
        const auto turned = [](const V3f& w) { return V3f(w.x, -w.z, w.y); };  // y to z
        EXPECT_TRUE(test::chi_square_sphere(
            [&](Random& random) { return turned(*draw(random.next2())); },
            [&](const V3f& w) { return pdf(V3f(w.x, w.z, -w.y)); }, 1, 100000, 3))
            << p;
        EXPECT_TRUE(test::jacobian_matches(draw, pdf, 2)) << p;
    }
}

// A point on the lamp itself, on its rim, at its corners and in its plane.
TEST(TriangleLight, StaysFiniteForAPointOfItself) {
    Scene scene = test::lamp_scene(Rgb(1.f), true);
    finish_scene(scene);
    const TriangleLight light{0, 0};
    const auto c = triangle_corners(scene, 0, 0);
    for (const V3f& p : {c[0], c[1], (c[0] + c[1]) * 0.5f, (c[0] + c[1] + c[2]) / 3.f,
                         c[0] * 2.f - c[1], c[0] * 1.1f - c[1] * 0.05f - c[2] * 0.05f}) {
        Random random(4);
        for (int i = 0; i < 1000; ++i) {
            const auto s = sample_light(scene, light, p, random.next2(), kTriangleRgb);
            if (!s) continue;  // rounding may leave p a little before the plane
            ASSERT_TRUE(s->pdf > 0 && std::isfinite(s->pdf)) << p;
            ASSERT_NEAR(s->direction.length(), 1, 1e-3) << p;
        }
    }
}

// Irradiance from a polygon of constant radiance: Lambert 1760; Baum et al. 1989, equation 2.
double lambert_irradiance(const std::array<V3d, 3>& c, const V3d& p, const V3d& n) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const V3d a = (c[i] - p).normalized(), b = (c[(i + 1) % 3] - p).normalized();
        sum += std::acos(a.dot(b)) * a.cross(b).normalized().dot(n);
    }
    return std::fabs(sum) / 2;
}

TEST(TriangleLight, EstimatesLambertsIrradiance) {
    Scene plain = test::lamp_scene(Rgb(2.f));
    Scene moved = test::lamp_scene(Rgb(2.f));
    M44f matrix;
    matrix.setEulerAngles(V3f(0.3f, 0.2f, -0.1f));
    matrix[3][1] = 1.f;
    moved.instances[0] = test::placed(0, matrix);
    uint32_t seed = 3;
    for (Scene* scene : {&plain, &moved}) {
        finish_scene(*scene);
        const TriangleLight light{0, 0};
        const V3f p(0.1f, 0.2f, 0.f), n = unit(V3f(0.2f, 1.f, 0.1f));
        Random random(seed++);
        test::Moments moments;
        for (int i = 0; i < 50000; ++i) {
            const auto s = sample_light(*scene, light, p, random.next2(), kTriangleRgb);
            moments.add(s ? s->radiance[1] * s->direction.dot(n) / s->pdf : 0);
        }
        const double expected = 2 * lambert_irradiance(corners(*scene, light), V3d(p), V3d(n));
        EXPECT_TRUE(test::agrees(moments, expected))
            << moments.mean() << " +- " << moments.standard_error() << ", not " << expected;
    }
}

// A point so near to a large lamp that rounding moves the points of the lamp aside.
TEST(TriangleLight, EstimatesLambertsIrradianceNearALargeLamp) {
    for (const float size : {1e2f, 1e4f}) {
        Scene scene;
        scene.materials = {test::glowing(Rgb(1.f), true)};
        scene.meshes = {test::one_triangle(V3f(-3.1f, 0.1f, -2) * size, V3f(3, 0.2f, -2.2f) * size,
                                           V3f(0.1f, 0.3f, 4) * size)};
        scene.instances.resize(1);
        finish_scene(scene);
        const TriangleLight light{0, 0};
        const auto c = corners(scene, light);
        const V3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
        const V3d on_lamp = c[0] * 0.3 + c[1] * 0.4 + c[2] * 0.3;
        const V3f p(on_lamp + normal * (normal.y > 0 ? -1e-5 : 1e-5) * double(size));
        const V3f wall = unit(V3f(1, 0.2f, 0.1f));
        Random random(7);
        test::Moments moments;
        for (int i = 0; i < 100000; ++i) {
            const auto s = sample_light(scene, light, p, random.next2(), kTriangleRgb);
            const float cosine = s ? s->direction.dot(wall) : 0;
            moments.add(cosine > 0 ? double(s->radiance[1] * cosine / s->pdf) : 0);
        }
        // By a grid of directions: those that meet the lamp.
        double expected = 0;
        constexpr int kSide = 2000;
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                const float z = 1 - 2 * (float(j) + 0.5f) / kSide;
                const float r = std::sqrt(1 - z * z), a = 2 * kPi * (float(i) + 0.5f) / kSide;
                const V3f w(r * std::cos(a), z, r * std::sin(a));
                if (w.dot(wall) > 0 && meet_triangle(c, V3d(p), V3d(w)))
                    expected += double(w.dot(wall)) * 4 * std::numbers::pi / (kSide * kSide);
            }
        EXPECT_NEAR(moments.mean(), expected, 0.01 * expected) << size;
    }
}

TEST(TriangleLight, ShinesOnTheSideThatItsMaterialSays) {
    const V3f below(0.2f, 0, 0.2f), above(0.2f, 5, 0.2f);
    M44f mirror;
    mirror.setScale(V3f(-1, 1, 1));
    for (const bool mirrored : {false, true})
        for (const bool double_sided : {false, true}) {
            Scene scene = test::lamp_scene(Rgb(1.f), double_sided);
            if (mirrored) scene.instances[0] = test::placed(0, mirror);
            finish_scene(scene);
            const TriangleLight light{0, 0};
            EXPECT_TRUE(sample_light(scene, light, below, V2f(0.4f), kTriangleRgb)) << mirrored;
            EXPECT_EQ(sample_light(scene, light, above, V2f(0.4f), kTriangleRgb).has_value(),
                      double_sided);
        }
    // Mirrored and already in world space: the corners stand as they are, only the sides change.
    Scene scene = test::lamp_scene(Rgb(1.f));
    scene.instances[0].flips = true;
    finish_scene(scene);
    EXPECT_FALSE(sample_light(scene, TriangleLight{0, 0}, below, V2f(0.4f), kTriangleRgb));
    EXPECT_TRUE(sample_light(scene, TriangleLight{0, 0}, above, V2f(0.4f), kTriangleRgb));
}

Image checker() {
    Image image{"checker", 2, 2, std::vector<float>(16, 0.f)};
    auto& texels = std::get<std::vector<float>>(image.texels);
    for (const int i : {0, 3}) std::fill_n(&texels[4 * i], 4, 1.f);
    return image;
}

TEST(TriangleLight, ShowsWhatAHitShows) {
    Scene scene = test::lamp_scene();
    scene.images = {checker()};
    scene.materials[0].emissive_texture.image = 0;
    finish_scene(scene);
    const TriangleLight light{0, 0};
    const auto c = corners(scene, light);
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const auto s =
            sample_light(scene, light, V3f(0.3f, 0.2f, 0.1f), random.next2(), kTriangleRgb);
        if (!s) continue;  // a black texel
        const V3d at = V3d(s->target) - c[0], e1 = c[1] - c[0], e2 = c[2] - c[0];
        const V3d n = e1.cross(e2);
        const V2f b(static_cast<float>(at.cross(e2).dot(n) / n.length2()),
                    static_cast<float>(e1.cross(at).dot(n) / n.length2()));
        const Rgb expected = emitted_radiance(scene, 0, 0, b, true);
        for (int k = 0; k < 3; ++k) ASSERT_NEAR(s->radiance[k], expected[k], 1e-4);
    }
}

// Whether or not its texture lies where the base colour's does.
TEST(TriangleLight, ASurfaceEmitsWhatLightSamplesSay) {
    for (const bool apart : {false, true})
        for (const bool double_sided : {false, true}) {
            Scene scene = test::lamp_scene(Rgb(1.f), double_sided);
            scene.images = {checker(), checker()};
            scene.materials[0].base_color_texture.image = 1;
            scene.materials[0].emissive_texture.image = 0;
            if (apart) scene.materials[0].emissive_texture.u_row = {0.5f, 0.2f, 0.1f};
            finish_scene(scene);
            Random random(9);
            for (int i = 0; i < 400; ++i) {
                const V2f b = random.next2() * 0.5f;
                const V3f along = random.direction();
                const Surface s = make_surface(scene, along, Hit{b, 0, 0});
                const Rgb found = read_material(scene, s, -along, kTriangleRgb).emitted;
                const Rgb expected = emitted_radiance(scene, 0, 0, b, s.front);
                for (int k = 0; k < 3; ++k) ASSERT_EQ(found[k], expected[k]);
            }
        }
}

TEST(TriangleLight, CutoutsShineWithTheirCoverage) {
    Scene scene = test::lamp_scene(Rgb(8.f));
    scene.materials[0].alpha = 0.25f;
    finish_scene(scene);
    const auto radiance = [&](AlphaMode mode) {
        scene.materials[0].alpha_mode = mode;
        const auto s =
            sample_light(scene, TriangleLight{0, 0}, V3f(0.2f, 0, 0), V2f(0.5f), kTriangleRgb);
        return s ? s->radiance[0] : 0.f;
    };
    EXPECT_FLOAT_EQ(radiance(AlphaMode::Opaque), 8);
    EXPECT_FLOAT_EQ(radiance(AlphaMode::Blend), 2);
    EXPECT_FLOAT_EQ(radiance(AlphaMode::Mask), 0);
    scene.materials[0].alpha_cutoff = 0.25f;
    EXPECT_FLOAT_EQ(radiance(AlphaMode::Mask), 8);
}

// A shadow ray to the target must not meet the light itself, at any scale and distance.
TEST(TriangleLight, ShadowRaysEndBeforeTheLight) {
    Random random(6);
    for (int i = 0; i < 20000; ++i) {
        const float scale = std::pow(10.f, 8 * random.next() - 4);
        const float distance = std::pow(10.f, 6 * random.next() - 3);
        const V3f centre = random.direction() * std::pow(10.f, 6 * random.next() - 3) * scale;
        Scene scene;
        scene.materials = {test::glowing(Rgb(1.f), true)};
        scene.meshes = {test::one_triangle(centre + random.direction() * scale,
                                           centre + random.direction() * scale,
                                           centre + random.direction() * scale)};
        scene.instances.resize(1);
        const V3f p = centre + random.direction() * (distance * scale);
        const auto s = sample_light(scene, TriangleLight{0, 0}, p, random.next2(), kTriangleRgb);
        if (!s) continue;
        const auto t = meet_triangle(corners(scene, {0, 0}), V3d(p), V3d(s->target - p));
        ASSERT_GT(t.value_or(kInfinity), 1.0) << "scale " << scale << " distance " << distance;
    }
}

TEST(TriangleLight, TheTraversalAgrees) {
    Random random(7);
    int rays = 0, hits = 0;
    for (int i = 0; i < 60; ++i) {
        const float scale = std::pow(10.f, 6 * random.next() - 3);
        const V3f centre = random.direction() * (100 * random.next() * scale);
        Scene scene;
        scene.materials = {test::glowing(Rgb(1.f), true)};
        scene.meshes = {test::one_triangle(centre + random.direction() * scale,
                                           centre + random.direction() * scale,
                                           centre + random.direction() * scale)};
        scene.instances = {test::placed(0, M44f().rotate(random.direction()))};
        for (const Traversal traversal : {Traversal::Robust, Traversal::Fast}) {
            const Bvh bvh(scene, traversal);
            for (int k = 0; k < 300; ++k) {
                Ray shadow;
                shadow.origin = random.direction() * (100 * random.next() * scale);
                const auto s = sample_light(scene, TriangleLight{0, 0}, shadow.origin,
                                            random.next2(), kTriangleRgb);
                if (!s) continue;
                shadow.direction = s->target - shadow.origin;
                shadow.t_max = kOneMinus;
                ASSERT_FALSE(bvh.occluded(shadow)) << "scale " << scale << " sample " << k;
                shadow.direction = s->direction;
                shadow.t_max = kInfinity;
                hits += bvh.occluded(shadow);
                ++rays;
            }
        }
    }
    EXPECT_GT(hits, 0.99 * rays);  // the direction itself does lead to the lamp
}

TEST(TriangleLight, ZeroAreaIsNoLight) {
    Scene scene;
    scene.materials = {test::glowing(Rgb(1.f), true)};
    scene.meshes = {test::one_triangle(V3f(0, 1, 0), V3f(1, 1, 0), V3f(2, 1, 0))};
    scene.instances.resize(1);
    finish_scene(scene);
    EXPECT_EQ(light_power(scene, scene.lights[0]), 0.f);
    EXPECT_FALSE(sample_light(scene, scene.lights[0], V3f(0.f), V2f(0.5f), kTriangleRgb));
}

TEST(TriangleLight, PowerIsAreaTimesPiTimesSides) {
    Scene scene = test::lamp_scene(Rgb(2.f));
    finish_scene(scene);
    const auto c = corners(scene, {0, 0});
    const double area = (c[1] - c[0]).cross(c[2] - c[0]).length() / 2;
    EXPECT_NEAR(light_power(scene, TriangleLight{0, 0}), 2 * std::numbers::pi * area, 1e-5);
    scene.materials[0].double_sided = true;
    EXPECT_NEAR(light_power(scene, TriangleLight{0, 0}), 4 * std::numbers::pi * area, 1e-5);
    scene.images = {checker()};
    scene.materials[0].emissive_texture.image = 0;
    EXPECT_NEAR(light_power(scene, TriangleLight{0, 0}), 2 * std::numbers::pi * area,
                0.1 * std::numbers::pi * area);
}

TEST(TriangleLight, BlackTexelsStillLeaveAChance) {
    Scene scene = test::lamp_scene(Rgb(2.f));
    scene.images = {Image{"black", 1, 1, std::vector<uint8_t>{0, 0, 0, 255}}};
    scene.materials[0].emissive_texture.image = 0;
    finish_scene(scene);
    const float power = light_power(scene, TriangleLight{0, 0});
    EXPECT_GT(power, 0.f);
    EXPECT_LT(power, 0.02f);
}

}  // namespace
}  // namespace petzval
