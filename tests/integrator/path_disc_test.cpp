// SPDX-License-Identifier: Apache-2.0
// Suns with a disc, flat lamps, and lamps that are not seen, against closed forms.
#include <numbers>

#include "core/light/small_features.h"
#include "core/scene/lamp.h"
#include "tests/integrator/path_estimate.h"

namespace petzval::test {
namespace {

constexpr double kAlbedoOverPi = 0.5 / std::numbers::pi;

SunLight sun(const V3f& direction, float illuminance_lx, double angle_deg) {
    const double half_rad = angle_deg * std::numbers::pi / 360;
    SunLight out{unit(direction), Rgb(illuminance_lx)};
    out.versine = static_cast<float>(1 - std::cos(half_rad));
    return out;
}

void add_floor(World& world) {
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
}

World floor_under(const SunLight& light) {
    World world;
    add_floor(world);
    world.scene.lights.push_back(light);
    world.finish();
    return world;
}

World floor_under(const FlatLamp& lamp) {
    World world;
    add_floor(world);
    add_lamps(world.scene, std::array{lamp});
    world.finish();
    return world;
}

Ray to_floor(V2f) {
    return ray_to(V3f(3, 0, 0.5f), V3f(0.f));
}

/// Radiance along one ray.
double disc_seen(const World& world, const V3f& from, const V3f& direction) {
    return estimate(world, integrator::PathOptions(), 2,
                    [&](V2f) { return ray_to(from, from + direction); })
        .value;
}

// An even disc that stands above the horizon lights as a point in its middle would, with the same
// illuminance on a surface that faces it.
TEST(SunDisc, KeepsTheIlluminanceOfThePoint) {
    const V3f down(0, -3, -4);
    for (const double angle_deg : {0.02, 0.53, 10., 70.}) {
        const World world = floor_under(sun(down, 10, angle_deg));
        const double truth = kAlbedoOverPi * 10 * 0.8;
        const Mean both = angle_deg < 5 ? estimate(world, integrator::PathOptions(), 256, to_floor)
                                        : expect_techniques_agree(world, integrator::PathOptions(),
                                                                  4096, to_floor, 0.1);
        EXPECT_TRUE(agrees(both, truth, 1e-3 * truth)) << angle_deg << ": " << both << truth;
        EXPECT_LT(both.error, 2e-3 * truth) << angle_deg;
    }
    // Half the sky: radiance E / pi from everywhere.
    const World half = floor_under(sun(V3f(0, 0, -1), 10, 180));
    expect_agrees(estimate(half, integrator::PathOptions(), 4096, to_floor), kAlbedoOverPi * 10,
                  "half");
}

// The edge of a roof at height h cuts a segment from the disc, which is a circle of radius
// tan(half) on a plane at height 1: what is left is (acos t - t sqrt(1 - t^2)) / pi.
TEST(SunDisc, CastsAPenumbra) {
    const double half_rad = std::numbers::pi / 180, height = 2;
    World world;
    add_floor(world);
    place(world.scene, quad(V3f(-40, -40, 2), V3f(40, 0, 0), V3f(0, 80, 0)), diffuse_material(0.f));
    world.scene.lights.push_back(sun(V3f(0, 0, -1), 10, 2));
    world.finish();
    for (const double t : {-1.2, -0.6, 0., 0.5, 0.9, 1.2}) {  // of the rim, from the middle
        const auto x = static_cast<float>(-t * std::tan(half_rad) * height);
        const double inside = std::clamp(t, -1., 1.);
        const double truth = kAlbedoOverPi * 10 *
                             (std::acos(inside) - inside * std::sqrt(1 - inside * inside)) /
                             std::numbers::pi;
        const Mean found = estimate(world, integrator::PathOptions(), 1024,
                                    [&](V2f) { return ray_to(V3f(4, 0, 0.5f), V3f(x, 0, 0)); });
        EXPECT_TRUE(agrees(found, truth, 2e-3 * kAlbedoOverPi * 10)) << t << found << truth;
    }
}

TEST(SunDisc, IsSeenInTheSkyAndInMirrors) {
    const double half_rad = 0.53 * std::numbers::pi / 360;
    const double nits = 10 / (std::numbers::pi * std::sin(half_rad) * std::sin(half_rad));
    Material mirror;
    mirror.roughness = 0;
    for (const bool unseen : {false, true}) {
        SunLight light = sun(V3f(0, 0, -1), 10, 0.53);
        light.unseen = unseen;
        World world;
        place(world.scene, quad(V3f(-5, -5, 0), V3f(10, 0, 0), V3f(0, 10, 0)), mirror);
        world.scene.lights.push_back(light);
        world.finish();
        const auto leaning = [&](double rim) {
            return V3f(static_cast<float>(std::tan(rim * half_rad)), 0, 1);
        };
        for (const double rim : {0., 0.99, 1.01}) {
            const double there = rim < 1 ? nits : 0;
            EXPECT_NEAR(disc_seen(world, V3f(0, 0, 1), leaning(rim)), unseen ? 0 : there,
                        1e-2 * nits);
            const V3f down(leaning(rim).x, 0, -1);
            EXPECT_NEAR(disc_seen(world, V3f(0, 0, 1), down), there, 1e-2 * nits) << unseen << rim;
        }
        const std::vector<SmallFeature> features = small_features_of(world.scene);
        ASSERT_EQ(features.size(), 1u);
        EXPECT_TRUE(features[0].at_infinity && features[0].is_lamp());
        EXPECT_NEAR(features[0].reach_m, half_rad, 1e-5);
        EXPECT_NEAR(features[0].radiance * features[0].area_m2, 10, 1e-3);
    }
}

TEST(SunDisc, IsNotSeenThroughATransparentBackground) {
    const World world = floor_under(sun(V3f(0, 0, -1), 10, 0.53));
    integrator::PathOptions options;
    options.transparent = true;
    float alpha = 0;
    const Mean e = estimate(
        world, options, 2, [](V2f) { return ray_to(V3f(0, 0, 1), V3f(0, 0, 2)); }, &alpha);
    EXPECT_EQ(e.value, 0);
    EXPECT_EQ(alpha, 0.f);
}

/// A lamp at height h over the origin that shines down, -z being down already.
FlatLamp over_floor(float height, V2f size_m, bool ellipse) {
    FlatLamp lamp;
    lamp.to_world.setTranslation(V3f(0, 0, height));
    lamp.size_m = size_m;
    lamp.ellipse = ellipse;
    lamp.intensity_cd = Rgb(6.f);
    return lamp;
}

// Configuration factors of a differential plane to a parallel disc, r^2 / (r^2 + h^2) (Howell,
// B-12), and to a rectangle over it, four times C-11.
TEST(FlatLamp, LightsByItsConfigurationFactor) {
    for (const float r : {0.05f, 0.5f, 2.f}) {
        const World world = floor_under(over_floor(1, V2f(2 * r), true));
        const double truth = kAlbedoOverPi * 6 / (1 + double(r) * double(r));
        const Mean found = estimate(world, integrator::PathOptions(), 4096, to_floor);
        EXPECT_TRUE(agrees(found, truth, 1e-3 * truth)) << r << ": " << found << truth;
        EXPECT_LT(found.error, 3e-3 * truth);
    }
    for (const V2f& size : {V2f(0.1f, 0.2f), V2f(1, 2)}) {
        const World world = floor_under(over_floor(1, size, false));
        const double a = double(size.x) / 2, b = double(size.y) / 2;
        const double nits = 6 / (double(size.x) * double(size.y));
        const double root_a = std::sqrt(1 + a * a), root_b = std::sqrt(1 + b * b);
        const double truth =
            kAlbedoOverPi * nits * 2 *
            (a / root_a * std::atan(b / root_a) + b / root_b * std::atan(a / root_b));
        const Mean found = estimate(world, integrator::PathOptions(), 4096, to_floor);
        EXPECT_TRUE(agrees(found, truth, 1e-3 * truth)) << size << ": " << found << truth;
    }
}

TEST(FlatLamp, LightsFromAfarAsAPointOfItsIntensity) {
    for (const bool ellipse : {false, true}) {
        const World world = floor_under(over_floor(20, V2f(0.3f, 0.5f), ellipse));
        const double truth = kAlbedoOverPi * 6 / 400;
        const Mean found = estimate(world, integrator::PathOptions(), 256, to_floor);
        EXPECT_TRUE(agrees(found, truth, 1e-3 * truth)) << found << truth;
    }
}

TEST(FlatLamp, ShinesFromItsFrontAlone) {
    FlatLamp lamp = over_floor(1, V2f(0.4f, 0.2f), false);
    const double nits = 6 / 0.08;
    for (const bool unseen : {false, true}) {
        lamp.unseen = unseen;
        const World world = floor_under(lamp);
        const double below = disc_seen(world, V3f(0.1f, 0, 0.5f), V3f(0, 0, 1));
        EXPECT_NEAR(below, unseen ? 0 : nits, 1e-4 * nits);
        EXPECT_NEAR(disc_seen(world, V3f(0.25f, 0, 0.5f), V3f(0, 0, 1)), 0, 1e-6);
        // From behind it is not there: the lit floor shows.
        EXPECT_GT(disc_seen(world, V3f(0, 0, 2), V3f(0, 0, -1)), 0.1);
        EXPECT_LT(disc_seen(world, V3f(0, 0, 2), V3f(0, 0, -1)), 6);
    }
    lamp.to_world = M44f();
    lamp.to_world.rotate(V3f(kPi, 0, 0));  // upwards
    lamp.to_world *= M44f().setTranslation(V3f(0, 0, 1));
    EXPECT_EQ(estimate(floor_under(lamp), integrator::PathOptions(), 64, to_floor).value, 0);
}

// What is not seen lights and is mirrored; panes before it change nothing of that.
TEST(UnseenLamp, IsNotSeenThroughPanesEither) {
    Material pane = glass_material(1.5f), mirror;
    pane.has_volume = false;
    pane.roughness = 0;
    pane.double_sided = true;
    mirror.roughness = 0;
    for (const bool unseen : {false, true}) {
        BallLamp ball{V3f(0, 0, 3), 0.5f, Rgb(10.f)};
        ball.unseen = unseen;
        World world;
        add_floor(world);
        place(world.scene, quad(V3f(-5, -5, 1), V3f(10, 0, 0), V3f(0, 10, 0)), pane);
        place(world.scene, quad(V3f(-5, 4, 0), V3f(10, 0, 0), V3f(0, 0, 5)), mirror);
        add_lamps(world.scene, std::array{ball});
        world.finish();
        EXPECT_EQ(disc_seen(world, V3f(0, 0, 2), V3f(0, 0, 1)) > 5, !unseen);
        EXPECT_EQ(disc_seen(world, V3f(0, 0, 0.5f), V3f(0, 0, 1)) > 5, !unseen) << "behind a pane";
        EXPECT_GT(disc_seen(world, V3f(0, 0, 2), V3f(0, 4, 0.5f)), 5) << "in the mirror";
        EXPECT_GT(estimate(world, integrator::PathOptions(), 64, to_floor).value, 0.1);
    }
}

}  // namespace
}  // namespace petzval::test
