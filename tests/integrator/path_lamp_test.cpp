// SPDX-License-Identifier: Apache-2.0
// Lamps with a size against closed forms.
#include <numbers>

#include "core/scene/lamp.h"
#include "tests/integrator/path_estimate.h"

namespace petzval::test {
namespace {

constexpr double kLampAlbedoOverPi = 0.5 / std::numbers::pi;

World floor_under_lamp(const BallLamp& lamp) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    add_lamps(world.scene, std::array{lamp});
    finish_scene(world.scene);
    world.bvh = std::make_unique<Bvh>(world.scene, Traversal::Robust);
    world.lights = std::make_unique<LightChoice>(world.scene, LightChoiceKind::Tree);
    return world;
}

Ray to_lit_floor(V2f) {
    return ray_to(V3f(0, 0, 0.5f), V3f(0.f));
}

// A ball that shines alike all over lights as its centre would, at any distance, where all of it is
// above the horizon: Gauss' theorem.
TEST(PathLamp, LightsAsAPointWould) {
    for (const float radius_m : {0.01f, 0.5f, 2.5f}) {
        const World world = floor_under_lamp({V3f(0, 3, 4), radius_m, Rgb(100.f)});
        const double truth = kLampAlbedoOverPi * 100 / 25 * 0.8;
        const Mean both = radius_m < 0.1f  // paths hardly ever find it by chance
                              ? estimate(world, integrator::PathOptions(), 1024, to_lit_floor)
                              : expect_techniques_agree(world, integrator::PathOptions(), 1024,
                                                        to_lit_floor, 0.2);
        EXPECT_TRUE(agrees(both, truth, 1e-3 * truth)) << radius_m << ": " << both << truth;
        EXPECT_LT(both.error, 2e-3 * truth) << radius_m;
    }
}

TEST(PathLamp, IsSeenAsBrightAsItIs) {
    const World world = floor_under_lamp({V3f(0, 3, 4), 0.5f, Rgb(100.f)});
    const auto at = [&](const V3f& target) {
        return estimate(world, integrator::PathOptions(), 4,
                        [&](V2f) { return ray_to(V3f(0, -2, 1), target); });
    };
    const double nits = 100 / (std::numbers::pi * 0.25);
    EXPECT_NEAR(at(V3f(0, 3, 4)).value, nits, 5e-3 * nits);
    EXPECT_NEAR(at(V3f(0.49f, 3, 4)).value, nits, 5e-3 * nits);
    EXPECT_NEAR(at(V3f(0.51f, 3, 4)).value, 0, 1e-6);
}

// Irradiance by a ball whose radiance towards w is the falloff of w's cosine, along its axis: over
// the cap of directions to the ball.
double beam_irradiance(double intensity, double radius, double distance, const Beam& beam) {
    const double radiance = intensity / (std::numbers::pi * radius * radius);
    const double end = std::asin(radius / distance);
    constexpr int steps = 100000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double angle = (i + 0.5) * end / steps;
        sum += double(beam.falloff(static_cast<float>(std::cos(angle)))) * std::cos(angle) *
               std::sin(angle);
    }
    return radiance * 2 * std::numbers::pi * sum * end / steps;
}

TEST(PathLamp, ABeamFallsOffByDirection) {
    const Beam beam{V3f(0, 0, -1), 0.99f, 0.97f};
    // The whole ball within the inner cone, some of it between the cones, some of it beyond them.
    for (const float radius_m : {0.1f, 0.4f, 0.9f}) {
        const World world = floor_under_lamp({V3f(0, 0, 2), radius_m, Rgb(8.f), -1, beam});
        const double truth = kLampAlbedoOverPi * beam_irradiance(8, radius_m, 2, beam);
        const Mean both =
            expect_techniques_agree(world, integrator::PathOptions(), 4096, to_lit_floor, 0.2);
        EXPECT_TRUE(agrees(both, truth, 3e-3 * truth)) << radius_m << ": " << both << truth;
    }
    EXPECT_NEAR(beam_irradiance(8, 0.1, 2, beam), 2, 1e-6);
    // No light sample goes to a lamp from beyond its cones.
    World dark = floor_under_lamp({V3f(0, 0, 2), 0.1f, Rgb(8.f), -1, beam});
    for (uint32_t i = 0; i < dark.scene.lights.size(); ++i)
        EXPECT_EQ(dark.lights->probability(i, {V3f(3, 0, 0), V3f(0, 0, 1), false}), 0.f);
    const Beam aside{unit(V3f(1, 0, 0)), 0.99f, 0.97f};
    const World world = floor_under_lamp({V3f(0, 0, 2), 0.1f, Rgb(8.f), -1, aside});
    EXPECT_EQ(estimate(world, integrator::PathOptions(), 64, to_lit_floor).value, 0);
    // Seen from within its cone, and from without.
    const auto seen = [&](const V3f& from) {
        return estimate(world, integrator::PathOptions(), 4,
                        [&](V2f) { return ray_to(from, V3f(0, 0, 2)); })
            .value;
    };
    EXPECT_NEAR(seen(V3f(5, 0, 2)), 8 / (std::numbers::pi * 0.01), 2);
    EXPECT_EQ(seen(V3f(-5, 0, 2)), 0);
}

}  // namespace
}  // namespace petzval::test
