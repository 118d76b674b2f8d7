// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_sampling.h"

#include <numbers>

#include "core/light/emission.h"
#include "core/scene/scene.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "tests/support/chi_square.h"
#include "tests/support/jacobian.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

using test::Random;

const Bands kRgb = Bands::rgb();

std::array<V3d, 3> corners(const Scene& scene, const TriangleLight& light) {
    const auto c = triangle_corners(scene, light.instance, light.triangle);
    return {V3d(c[0]), V3d(c[1]), V3d(c[2])};
}

// Distance along w from p to the triangle's plane, and whether the point is inside. Double
// precision.
std::optional<double> meet(const std::array<V3d, 3>& c, const V3d& p, const V3d& w) {
    const V3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double t = (c[0] - p).dot(n) / w.dot(n);
    const V3d at = p + w * t;
    for (int i = 0; i < 3; ++i)
        if ((c[(i + 1) % 3] - c[i]).cross(at - c[i]).dot(n) < 0) return std::nullopt;
    return t > 0 ? std::optional(t) : std::nullopt;
}

TEST(PointLight, FollowsTheInverseSquare) {
    const PointLight light{V3f(1, 5, 2), Rgb(90, 180, 45)};
    const auto s = sample_light(Scene(), light, V3f(1, 2, 2), V2f(0.3f), kRgb);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->direction, V3f(0, 1, 0));
    EXPECT_EQ(s->target, light.position);
    EXPECT_TRUE(s->delta);
    EXPECT_FALSE(s->at_infinity);
    EXPECT_EQ(s->pdf, 1.f);
    EXPECT_FLOAT_EQ(s->radiance[0], 10);
    EXPECT_FLOAT_EQ(s->radiance[1], 20);
    EXPECT_FLOAT_EQ(s->radiance[2], 5);
    EXPECT_FALSE(sample_light(Scene(), light, light.position, V2f(0.3f), kRgb));
}

// KHR_lights_punctual: scale = 1 / max(0.001, cos inner - cos outer), offset = - cos outer * scale.
double spot_factor(double inner, double outer, double angle) {
    const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer));
    const double offset = -std::cos(outer) * scale;
    const double attenuation = std::clamp(std::cos(angle) * scale + offset, 0.0, 1.0);
    return attenuation * attenuation;
}

SpotLight spot(double inner, double outer) {
    return {V3f(0, 3, 0), V3f(0, -1, 0), Rgb(9.f), static_cast<float>(std::cos(inner)),
            static_cast<float>(std::cos(outer))};
}

TEST(SpotLight, FallsOffAsItsSpecificationSays) {
    for (const auto& [inner, outer] : {std::pair(0.2, 0.7), {0.0, 1.5}, {0.6, 0.6001}}) {
        for (double angle = 0; angle < 1.5; angle += 0.01) {
            const V3f p(0, 3 - static_cast<float>(2 * std::cos(angle)),
                        static_cast<float>(2 * std::sin(angle)));
            const auto s = sample_light(Scene(), spot(inner, outer), p, V2f(0.f), kRgb);
            const double expected = 9 / 4.0 * spot_factor(inner, outer, angle);
            EXPECT_NEAR(s ? s->radiance[0] : 0, expected, 2e-3) << inner << " " << angle;
        }
    }
    EXPECT_FALSE(sample_light(Scene(), spot(0.2, 0.7), V3f(0, 6, 0), V2f(0.f), kRgb));
}

TEST(SpotLight, PowerIsTheIntegralOfTheFalloff) {
    for (const auto& [inner, outer] :
         {std::pair(0.2, 0.7), {0.0, std::numbers::pi / 2}, {0.6, 0.6001}, {0.0, 0.03}}) {
        double integral = 0;
        for (int i = 0; i < 200000; ++i) {
            const double angle = (i + 0.5) * std::numbers::pi / 200000;
            integral += spot_factor(inner, outer, angle) * 2 * std::numbers::pi * std::sin(angle) *
                        std::numbers::pi / 200000;
        }
        EXPECT_NEAR(light_power(Scene(), spot(inner, outer)), 9 * integral, 2e-3 * 9 * integral);
    }
    EXPECT_FLOAT_EQ(light_power(Scene(), PointLight{V3f(0.f), Rgb(1.f)}), 4 * kPi);
}

TEST(SunLight, ShinesFromInfinity) {
    const SunLight light{unit(V3f(1, -2, 0.5f)), Rgb(1000, 900, 800)};
    const auto s = sample_light(Scene(), light, V3f(7, 8, 9), V2f(0.f), kRgb);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->direction, -light.direction);
    EXPECT_TRUE(s->at_infinity && s->delta);
    EXPECT_EQ(s->radiance[1], 900.f);
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
            const auto t = meet(c, V3d(p), V3d(w));
            if (!t) return 0;
            return triangle_light_pdf(scene, light, p, static_cast<float>(*t * *t),
                                      static_cast<float>(normal.dot(V3d(w))));
        };
        const auto draw = [&](V2f u) -> std::optional<V3f> {
            const auto s = sample_light(scene, light, p, u, kRgb);
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
TEST(TriangleLight, SendsNothingAlongItself) {
    Scene scene = test::lamp_scene(Rgb(1.f), true);
    finish_scene(scene);
    const TriangleLight light{0, 0};
    const auto c = triangle_corners(scene, 0, 0);
    for (const V3f& p : {c[0], c[1], (c[0] + c[1]) * 0.5f, (c[0] + c[1] + c[2]) / 3.f,
                         c[0] * 2.f - c[1], c[0] * 1.1f - c[1] * 0.05f - c[2] * 0.05f}) {
        Random random(4);
        for (int i = 0; i < 1000; ++i) {
            const auto s = sample_light(scene, light, p, random.next2(), kRgb);
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
            const auto s = sample_light(*scene, light, p, random.next2(), kRgb);
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
            const auto s = sample_light(scene, light, p, random.next2(), kRgb);
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
                if (w.dot(wall) > 0 && meet(c, V3d(p), V3d(w)))
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
            EXPECT_TRUE(sample_light(scene, light, below, V2f(0.4f), kRgb)) << mirrored;
            EXPECT_EQ(sample_light(scene, light, above, V2f(0.4f), kRgb).has_value(), double_sided);
        }
    // Mirrored and already in world space: the corners stand as they are, only the sides change.
    Scene scene = test::lamp_scene(Rgb(1.f));
    scene.instances[0].flips = true;
    finish_scene(scene);
    EXPECT_FALSE(sample_light(scene, TriangleLight{0, 0}, below, V2f(0.4f), kRgb));
    EXPECT_TRUE(sample_light(scene, TriangleLight{0, 0}, above, V2f(0.4f), kRgb));
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
        const auto s = sample_light(scene, light, V3f(0.3f, 0.2f, 0.1f), random.next2(), kRgb);
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
                const Rgb found = read_material(scene, s, -along, kRgb).emitted;
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
        const auto s = sample_light(scene, TriangleLight{0, 0}, V3f(0.2f, 0, 0), V2f(0.5f), kRgb);
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
        const auto s = sample_light(scene, TriangleLight{0, 0}, p, random.next2(), kRgb);
        if (!s) continue;
        const auto t = meet(corners(scene, {0, 0}), V3d(p), V3d(s->target - p));
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
                const auto s =
                    sample_light(scene, TriangleLight{0, 0}, shadow.origin, random.next2(), kRgb);
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
    EXPECT_FALSE(sample_light(scene, scene.lights[0], V3f(0.f), V2f(0.5f), kRgb));
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

TEST(SkyLight, IsTheSky) {
    Scene scene = test::lamp_scene();
    // The upper half shines, the lower is black.
    std::vector<float> rgb;
    for (int i = 0; i < 32 * 16; ++i)
        for (const float c : {3.f, 2.f, 1.f}) rgb.push_back(i < 32 * 8 ? c : 0.f);
    scene.sky = Sky::picture(rgb, 32, 16, 0.f, 1.f);
    finish_scene(scene);
    const auto s = sample_light(scene, scene.lights.back(), V3f(0.f), V2f(0.2f, 0.3f), kRgb);
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->at_infinity);
    EXPECT_FALSE(s->delta);
    EXPECT_NEAR(s->radiance[0], 3.f, 1e-3);
    EXPECT_NEAR(s->pdf, scene.sky.pdf(s->direction), 1e-4 * s->pdf);
    EXPECT_FALSE(sample_light(Scene(), SkyLight{}, V3f(0.f), V2f(0.5f), kRgb));
    // Flux through the sphere about the scene: pi L through each part of its surface, of what is
    // brighter than the mean.
    const double radius = scene.bounds.size().length() / 2;
    EXPECT_NEAR(
        light_power(scene, SkyLight{}),
        std::numbers::pi * scene.sky.drawn_luminance() * 4 * std::numbers::pi * radius * radius,
        1e-2);
}

TEST(Scene, FinishingAddsLightsAndBounds) {
    Scene scene = test::lamp_scene();
    scene.materials.push_back(Material{});
    scene.materials.push_back(test::glowing(Rgb(1.f)));
    scene.materials.back().unlit = true;
    Mesh two = scene.meshes[0];
    two.triangles.push_back({0, 2, 1});
    Mesh dark = two, unlit = two, empty = two;
    dark.material = 1;
    unlit.material = 2;
    empty.triangles.clear();
    scene.meshes.insert(scene.meshes.end(), {two, dark, unlit, empty});
    M44f matrix;
    matrix.setTranslation(V3f(10, 0, 0));
    scene.instances = {test::placed(2, M44f()), test::placed(1, matrix), test::placed(3, M44f()),
                       test::placed(4, M44f()), Instance{}};
    scene.lights = {PointLight{V3f(0.f), Rgb(1.f)}};
    scene.sky = Sky::picture({0, 0, 0, 9, 9, 9}, 2, 1, 0.f, 1.f);
    finish_scene(scene);

    ASSERT_EQ(scene.lights.size(), 1u + 2 + 1 + 1);
    EXPECT_EQ(scene.instances[1].first_light, 1);
    EXPECT_EQ(scene.instances[4].first_light, 3);
    for (const int i : {0, 2, 3}) EXPECT_EQ(scene.instances[i].first_light, -1);
    const auto& second = std::get<TriangleLight>(scene.lights[2]);
    EXPECT_EQ(second.instance, 1u);
    EXPECT_EQ(second.triangle, 1u);
    EXPECT_TRUE(std::holds_alternative<SkyLight>(scene.lights.back()));
    EXPECT_FLOAT_EQ(scene.bounds.min.x, -0.5f);
    EXPECT_FLOAT_EQ(scene.bounds.max.x, 11.1f);
    EXPECT_FLOAT_EQ(scene.bounds.max.y, 2.2f);
    EXPECT_FLOAT_EQ(triangle_corners(scene, 1, 0)[1].x, 11.1f);

    Scene nothing;
    nothing.sky = Sky::uniform(Rgb(1.f));  // found by BSDF samples alone
    finish_scene(nothing);
    EXPECT_EQ(nothing.sky_light, -1);
    EXPECT_TRUE(nothing.bounds.isEmpty());
    EXPECT_TRUE(nothing.lights.empty());
}

}  // namespace
}  // namespace petzval
