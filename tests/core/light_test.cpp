// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_sampling.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "tests/support/lamp.h"

namespace petzval {
namespace {

const Bands kRgb = Bands::rgb();

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

TEST(ProfileLight, OfOneIntensityIsAPoint) {
    Scene scene;
    scene.profiles.emplace_back(ProfilePole::Forward, std::vector<float>{0, 180},
                                std::vector<float>{0, 360}, std::vector<float>(4, 3.f));
    const PointLight point{V3f(1, 5, 2), Rgb(90, 180, 45)};
    const ProfileLight profile{point.position, V3f(0, 0, 1),    V3f(1, 0, 0),
                               V3f(0, 1, 0),   Rgb(30, 60, 15), 0};
    for (const V3f& p : {V3f(1, 2, 2), V3f(1, 7, 2), V3f(3, 4, -8)}) {
        const auto expected = sample_light(scene, point, p, V2f(0.3f), kRgb);
        const auto found = sample_light(scene, profile, p, V2f(0.3f), kRgb);
        ASSERT_TRUE(expected && found);
        EXPECT_EQ(found->direction, expected->direction);
        EXPECT_EQ(found->target, expected->target);
        EXPECT_TRUE(found->delta && !found->at_infinity);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(found->radiance[i], expected->radiance[i]);
    }
    EXPECT_FALSE(sample_light(scene, profile, profile.position, V2f(0.3f), kRgb));
    EXPECT_NEAR(light_power(scene, profile), light_power(scene, point),
                1e-5 * light_power(scene, point));
}

TEST(ProfileLight, ShinesAsItStands) {
    Scene scene;  // 8 cd along f, 4 at right angles to it towards x, 2 towards y, nothing behind
    scene.profiles.emplace_back(ProfilePole::Forward, std::vector<float>{0, 90},
                                std::vector<float>{0, 90, 180, 270, 360},
                                std::vector<float>{8, 4, 8, 2, 8, 1, 8, 3, 8, 4});
    const ProfileLight light{V3f(0), V3f(0, 0, 1), V3f(1, 0, 0), V3f(0, 1, 0), Rgb(1.f), 0};
    const auto towards = [&](const V3f& d) {
        const auto s = sample_light(scene, light, d, V2f(0.f), kRgb);
        return s ? s->radiance[0] : 0;
    };
    EXPECT_FLOAT_EQ(towards(V3f(0, 1, 0)), 8);
    EXPECT_NEAR(towards(unit(V3f(0, 1e-5f, 1))), 4, 1e-4);
    EXPECT_NEAR(towards(unit(V3f(1, 1e-5f, 0))), 2, 1e-4);
    EXPECT_NEAR(towards(unit(V3f(0, 1e-5f, -1))), 1, 1e-4);
    EXPECT_NEAR(towards(unit(V3f(-1, 1e-5f, 0))), 3, 1e-4);
    EXPECT_NEAR(towards(2.f * unit(V3f(0, 1, 1))), 6 / 4., 1e-4);
    EXPECT_EQ(towards(V3f(0, -1, 0.5f)), 0);
    // Every way of choosing picks it where it shines.
    for (const auto kind : {LightChoiceKind::Tree, LightChoiceKind::Power}) {
        scene.lights = {light, PointLight{V3f(3, 3, 3), Rgb(1.f)}};
        const LightChoice choice(scene, kind);
        for (const V3f& d : {V3f(0, 1, 0), unit(V3f(1, 0.01f, 0)), unit(V3f(0, 1, -1))})
            EXPECT_GT(choice.probability(0, {d, -d, false}), 0) << d;
    }
}

TEST(SunLight, ShinesFromInfinity) {
    const SunLight light{unit(V3f(1, -2, 0.5f)), Rgb(1000, 900, 800)};
    const auto s = sample_light(Scene(), light, V3f(7, 8, 9), V2f(0.f), kRgb);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->direction, -light.direction);
    EXPECT_TRUE(s->at_infinity && s->delta);
    EXPECT_EQ(s->radiance[1], 900.f);
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
