// SPDX-License-Identifier: Apache-2.0
#include "core/scene/lamp.h"

#include <gtest/gtest.h>

#include "core/light/light_sampling.h"
#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

Scene lit_by(const BallLamp& lamp, size_t count = 1) {
    Scene scene;
    add_lamps(scene, std::vector<BallLamp>(count, lamp));
    return scene;
}

V3f lamp_direction(uint32_t i) {
    const auto unit_float = [](uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
    return uniform_sphere(V2f(unit_float(sobol_0(i)), unit_float(sobol_1(i))));
}

// Intensity in a direction: radiance times the area that the ball shows, by its triangles.
double intensity(const Scene& scene, const V3f& direction) {
    double shown_m2 = 0;
    for (uint32_t i = 0; i < scene.meshes[0].triangles.size(); ++i) {
        const auto c = triangle_corners(scene, 0, i);
        const V3d twice_area = (V3d(c[1]) - V3d(c[0])).cross(V3d(c[2]) - V3d(c[0]));
        shown_m2 += std::max(twice_area.dot(V3d(direction)), 0.) / 2;
    }
    return shown_m2 * double(scene.materials[0].emissive[1]);
}

TEST(BallLamp, SendsItsIntensityInAllDirections) {
    const Scene scene = lit_by({V3f(1, 2, 3), 0.2f, Rgb(2, 40, 3)});
    double sum = 0, least = kInfinity, most = 0;
    constexpr uint32_t count = 4096;
    for (uint32_t i = 0; i < count; ++i) {
        const double found = intensity(scene, lamp_direction(i));
        sum += found;
        least = std::min(least, found);
        most = std::max(most, found);
    }
    EXPECT_NEAR(sum / count, 40, 40e-5);
    EXPECT_GT(least, 40 * 0.999);
    EXPECT_LT(most, 40 * 1.001);
    EXPECT_EQ(scene.meshes[0].triangles.size(), 1280u);
    for (uint32_t i = 0; i < scene.meshes[0].triangles.size(); ++i) {
        const auto c = triangle_corners(scene, 0, i);
        EXPECT_GT((c[1] - c[0]).cross(c[2] - c[0]).dot(c[0] - V3f(1, 2, 3)), 0);  // outwards
    }
    for (const V3f& p : scene.meshes[0].positions)
        EXPECT_NEAR((p - V3f(1, 2, 3)).length(), 0.2f, 1e-6f);
}

TEST(BallLamp, PowerIsThatOfThePoint) {
    Scene scene = lit_by({V3f(0), 0.3f, Rgb(1.f)});
    finish_scene(scene);
    double power = 0;
    for (const Light& light : scene.lights) power += double(light_power(scene, light));
    EXPECT_NEAR(power, 4 * double(kPi), 1e-4);
}

TEST(BallLamp, PowerOfABeamIsThatOfTheSpot) {
    for (const auto& [inner, outer] : {std::pair(0.95f, 0.8f), {0.999f, 0.99f}, {0.5f, 0.01f}}) {
        const Beam beam{unit(V3f(1, -2, 0.5f)), inner, outer};
        Scene scene = lit_by({V3f(0), 0.3f, Rgb(1.f), -1, beam});
        finish_scene(scene);
        double power = 0;
        for (const Light& light : scene.lights) power += double(light_power(scene, light));
        const double spot =
            double(light_power(scene, SpotLight{V3f(0), beam.direction, Rgb(1.f), inner, outer}));
        EXPECT_NEAR(power, spot, 0.01 * spot) << outer;
    }
}

TEST(BallLamp, ManyHaveFewerTrianglesEach) {
    const BallLamp lamp{V3f(0), 1.f, Rgb(1.f)};
    EXPECT_EQ(lit_by(lamp, 800).meshes[799].triangles.size(), 1280u);
    const Scene many = lit_by(lamp, 1000);
    EXPECT_EQ(many.meshes[0].triangles.size(), 320u);
    EXPECT_NEAR(intensity(many, unit(V3f(1, 2, 3))), 1, 5e-3);
    EXPECT_EQ(lit_by(lamp, 20000).meshes[0].triangles.size(), 20u);
}

// What faces away from the whole cone is not chosen.
TEST(BallLamp, OfABeamOnlyWhatFacesItHasPower) {
    const Beam beam{V3f(0, -1, 0), 0.95f, 0.8f};
    Scene scene = lit_by({V3f(0), 0.3f, Rgb(1.f), -1, beam});
    finish_scene(scene);
    const double sine = std::sqrt(1 - 0.8 * 0.8);
    for (const Light& light : scene.lights) {
        const auto& triangle = std::get<TriangleLight>(light);
        const auto c = triangle_corners(scene, triangle.instance, triangle.triangle);
        const float cosine = unit((c[1] - c[0]).cross(c[2] - c[0])).dot(beam.direction);
        if (std::fabs(cosine + sine) < 0.01) continue;
        EXPECT_EQ(light_power(scene, light) > 0, cosine > -sine) << cosine;
    }
}

}  // namespace
}  // namespace petzval
