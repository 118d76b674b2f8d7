// SPDX-License-Identifier: Apache-2.0
// Paths through glass and what it absorbs.
#include "tests/integrator/path_estimate.h"

namespace petzval::integrator {
namespace {

using test::bundle;
using test::diffuse_material;
using test::emitter_material;
using test::estimate;
using test::Mean;
using test::place;
using test::quad;
using test::ray_to;
using test::sphere;
using test::World;

// A solid glass ball takes nothing away from a white sky.
TEST(Path, ClearGlassVanishesInAWhiteSky) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.has_volume = true;
    place(world.scene, sphere(V3f(0.f), 1.f, 64, true), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    PathOptions options;
    options.max_depth = 200;
    const Mean e = estimate(world, options, 2048, bundle);
    // Facets and smooth normals disagree at the rim.
    EXPECT_TRUE(test::agrees(e, 1, 0.01)) << e;
    EXPECT_LT(e.error, 0.002);
}

TEST(Path, AbsorptionFollowsBeerAndLambert) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = 1;  // nothing bends or reflects: only the way inside counts
    m.has_volume = true;
    m.attenuation_color = Rgb(0.25f);
    m.attenuation_distance_m = 0.5f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    place(world.scene, quad(V3f(-2, -2, -1), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const Mean e =
        estimate(world, PathOptions(), 64, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
    EXPECT_NEAR(e.value, std::pow(0.25, 1.0 / 0.5), 1e-4);
}

// The camera may stand in the volume: what lies between it and the back of a face counts.
TEST(Path, ACameraInsideAVolumeSeesItsAbsorption) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = 1;
    m.has_volume = true;
    m.attenuation_color = Rgb(0.25f);
    m.attenuation_distance_m = 0.5f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    place(world.scene, quad(V3f(-2, -2, -1), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const auto seen = [&](V3f eye, V3f target) {
        return estimate(world, PathOptions(), 64, [&](V2f) { return ray_to(eye, target); }).value;
    };
    for (const float depth : {0.25f, 0.5f, 1.f - 1e-6f})
        EXPECT_NEAR(seen(V3f(0, 0, -1 + depth), V3f(0, 0, -2)), std::pow(0.25, double(depth) / 0.5),
                    1e-4)
            << depth;
    // Aslant: the way is longer.
    EXPECT_NEAR(seen(V3f(0, 0, -0.5f), V3f(0.5f, 0, 0)), std::pow(0.25, 0.5 * std::sqrt(2.) / 0.5),
                1e-4);
    EXPECT_NEAR(seen(V3f(0, 0, 3), V3f(0.f)), std::pow(0.25, 1 / 0.5), 1e-4);
    EXPECT_NEAR(seen(V3f(0, 0, -3), V3f(0, 0, -4)), 1, 1e-6);
}

// A path that has left an inner volume is in the outer one again, as the next face says.
TEST(Path, TheOuterVolumeAbsorbsBehindTheInnerOne) {
    World world;
    const auto slab = [&](float front, float back, float colour) {
        Material m;
        m.metallic = 0;
        m.roughness = 0;
        m.transmission = 1;
        m.ior = 1;
        m.has_volume = true;
        m.attenuation_color = Rgb(colour);
        m.attenuation_distance_m = 1;
        place(world.scene, quad(V3f(-2, -2, front), V3f(4, 0, 0), V3f(0, 4, 0)), m);
        place(world.scene, quad(V3f(-2, -2, back), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    };
    slab(0, -4, 0.5f);
    slab(-1, -2, 0.25f);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    PathOptions options;
    options.roulette_depth = 16;
    const Mean e = estimate(world, options, 4, [](V2f) { return ray_to(V3f(0, 0, 3), V3f(0.f)); });
    EXPECT_NEAR(e.value, 0.5 * 0.25 * 0.25, 1e-4);
}

// Light on its way through a volume is absorbed whichever technique finds it.
TEST(Path, TechniquesAgreeInsideAVolume) {
    World world;
    Material m;
    m.metallic = 0;
    m.roughness = 0.6f;
    m.transmission = 1;
    m.ior = 1.2f;
    m.has_volume = true;
    m.attenuation_color = Rgb(0.5f);
    m.attenuation_distance_m = 1.5f;
    place(world.scene, sphere(V3f(0.f), 1.5f, 24, false), m);
    place(world.scene, quad(V3f(-0.6f, -0.6f, 0.2f), V3f(1.2f, 0, 0), V3f(0, 1.2f, 0)),
          diffuse_material(0.7f));
    place(world.scene, quad(V3f(-0.5f, 0.7f, 0.3f), V3f(1, 0, 0), V3f(0, 0, 0.7f)),
          emitter_material(5.f));
    world.finish();
    PathOptions options;
    options.max_depth = 6;
    test::expect_techniques_agree(world, options, 8192, bundle, 0.03);
}

}  // namespace
}  // namespace petzval::integrator
