// SPDX-License-Identifier: Apache-2.0
// Layers of materials in whole paths: leaves lit from behind, coats over panes, both techniques.
#include <numbers>

#include "tests/integrator/path_estimate.h"

namespace petzval::integrator {
namespace {

using test::bundle;
using test::emitter_material;
using test::estimate;
using test::expect_agrees;
using test::Mean;
using test::place;
using test::quad;
using test::ray_to;
using test::World;

Mean seen_from(const World& world, const V3f& eye, uint32_t samples, int max_depth) {
    PathOptions options;
    options.max_depth = max_depth;
    return estimate(world, options, samples, [&](V2f) { return ray_to(eye, V3f(0.1f, 0.2f, 0)); });
}

Material leaf_material(float share) {
    Material m = test::diffuse_material(0.5f);
    m.diffuse_transmission = share;
    m.diffuse_transmission_color = Rgb(0.8f, 0.4f, 0.2f);
    return m;
}

TEST(Leaf, ShowsTheLightsBehindIt) {
    const auto lit = [](const Light& light) {
        World world;
        place(world.scene, quad(V3f(-9, -9, 0), V3f(18, 0, 0), V3f(0, 18, 0)),
              leaf_material(0.25f));
        world.scene.lights.push_back(light);
        world.finish();
        return world;
    };
    const double behind = 0.25 * 0.8 / std::numbers::pi, before = 0.75 * 0.5 / std::numbers::pi;
    const V3f down = unit(V3f(0, -3, -4));
    const World sun = lit(SunLight{down, Rgb(10.f)});  // over the sheet
    expect_agrees(seen_from(sun, V3f(0, 1, -3), 16, 4), behind * 10 * 0.8, "behind");
    expect_agrees(seen_from(sun, V3f(0, 1, 3), 16, 4), before * 10 * 0.8, "before");
    const World point = lit(PointLight{V3f(0.1f, 0.2f, 2), Rgb(6.f)});
    expect_agrees(seen_from(point, V3f(0, 1, -3), 16, 4), behind * 6 / 4, "point");
}

TEST(Leaf, IsNotSeenInAWhiteFurnace) {
    for (const float thickness : {0.f, 1.f}) {
        World world;
        Material leaf = test::diffuse_material(1.f);
        leaf.diffuse_transmission = 0.4f;
        leaf.has_volume = thickness > 0;
        place(world.scene, test::box(V3f(-0.5f), V3f(0.5f)), leaf);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const Mean e = seen_from(world, V3f(2, 3, 4), 256, 200);
        EXPECT_TRUE(test::agrees(e, 1, 0.004)) << thickness << ": " << e;
    }
}

// Between two faces of a closed leaf light is absorbed as in any volume: what crosses both is what
// is seen of a lamp behind, at the square of the share that one passes.
TEST(Leaf, WithAVolumeAbsorbs) {
    const auto through = [](float left) {
        World world;
        Material leaf = test::diffuse_material(0.f);
        leaf.diffuse_transmission = 1;
        leaf.has_volume = true;
        leaf.attenuation_color = Rgb(left);
        leaf.attenuation_distance_m = 1;
        place(world.scene, test::box(V3f(-50, -50, -0.001f), V3f(50, 50, 0)), leaf);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        PathOptions options;
        options.max_depth = 2;  // both faces, and no more
        return estimate(world, options, 4096, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
    };
    const Mean clear = through(1.f), dark = through(1e-30f);
    EXPECT_TRUE(test::agrees(clear, 1, 0.001)) << clear;
    // The mean over a diffuse sheet's directions of a^(1 / cos), with a = 10^-0.03: 2 E3(-ln a).
    const double depth = 0.001 * 30 * std::numbers::ln10;
    double expected = 0;
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double cosine = (i + 0.5) / n;
        expected += 2 * cosine * std::exp(-depth / cosine) / n;
    }
    EXPECT_TRUE(test::agrees(dark, expected, 0.001)) << dark << ", not " << expected;
}

// White takes nothing, however often: rounding must not let light grow.
TEST(Attenuation, WhiteAbsorbsNothingAtAnyDistance) {
    Material m;
    m.attenuation_color = Rgb(1.f);
    m.attenuation_distance_m = 1e-30f;
    Bands bands = Bands::rgb();
    bands.red = splat(0.3f);
    bands.green = splat(0.4f);
    bands.blue = splat(0.30000007f);  // a sum above 1
    for (int i = 0; i < 3; ++i) EXPECT_EQ(transmittance(m, 1.f, bands)[i], 1.f);
    m.attenuation_color = Rgb(0.5f);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(transmittance(m, 1.f, bands)[i], 0.f);
}

TEST(CoatedSurface, APaneWithACoatLetsItsShareThrough) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          test::diffuse_material(0.5f));
    Material pane = test::diffuse_material(1.f);
    pane.roughness = 0;
    pane.specular = 1;
    pane.transmission = 1;
    pane.coat = 0.5f;
    place(world.scene, quad(V3f(-50, -50, 1), V3f(100, 0, 0), V3f(0, 100, 0)), pane);
    world.scene.lights.push_back(PointLight{V3f(0, 3, 4), Rgb(100.f)});
    world.finish();
    const double schlick = 0.04 + 0.96 * std::pow(0.2, 5);
    PathOptions options;
    options.max_depth = 1;
    expect_agrees(
        estimate(world, options, 16, [](V2f) { return ray_to(V3f(0.7f, 0, 0.9f), V3f(0.f)); }),
        0.5 / std::numbers::pi * (1 - schlick) * (1 - 0.5 * schlick) * 100 / 25 * 0.8, "point");
}

// A lamp shines from below its coat.
TEST(CoatedSurface, DimsWhatItEmits) {
    World world;
    Material lamp = emitter_material(3.f);
    lamp.coat = 0.5f;
    lamp.coat_roughness = 0.3f;
    place(world.scene, quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0)), lamp);
    place(world.scene, quad(V3f(-1, -1, 1), V3f(0, 2, 0), V3f(2, 0, 0)),
          test::diffuse_material(0.5f));
    world.finish();
    const V3f from(0, 0, 0.6f), to(0.8f, 0, 0);  // cosine 0.6
    PathOptions seen;
    seen.max_depth = 0;
    expect_agrees(estimate(world, seen, 16, [&](V2f) { return ray_to(from, to); }),
                  3 * (1 - 0.5 * (0.04 + 0.96 * std::pow(0.4, 5))), "seen");
    PathOptions once;
    once.max_depth = 1;
    test::expect_techniques_agree(
        world, once, 4096, [](V2f u) { return ray_to(V3f(0, 0, 0.5f), V3f(u.x, u.y, 1)); }, 0.01);
}

TEST(CoatedSurface, TechniquesAgree) {
    World world;
    Material m = test::diffuse_material(0.6f);
    m.roughness = 0.5f;
    m.specular = 1;
    m.coat = 0.8f;
    m.coat_roughness = 0.4f;
    m.sheen_color = Rgb(0.5f);
    m.sheen_roughness = 0.5f;
    m.anisotropy = 0.5f;
    m.iridescence = 0.5f;
    m.diffuse_transmission = 0.3f;
    place(world.scene, quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0)), m);
    place(world.scene, quad(V3f(-1, -1, 3), V3f(0, 2, 0), V3f(2, 0, 0)), emitter_material(3.f));
    place(world.scene, quad(V3f(-1, -1, -2), V3f(2, 0, 0), V3f(0, 2, 0)), emitter_material(2.f));
    world.finish();
    test::expect_techniques_agree(world, {}, 4096, bundle, 0.01);
}

}  // namespace
}  // namespace petzval::integrator
