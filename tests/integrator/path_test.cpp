// SPDX-License-Identifier: Apache-2.0
#include "integrator/path/path.h"

#include <numbers>
#include <tuple>

#include "tests/integrator/path_estimate.h"

namespace petzval::integrator {
namespace {

using test::bundle;
using test::diffuse_material;
using test::emitter_material;
using test::estimate;
using test::expect_agrees;
using test::Mean;
using test::place;
using test::quad;
using test::ray_to;
using test::sphere;
using test::World;

// Inside a closed diffuse emitter radiance is emission / (1 - albedo), whatever its shape.
TEST(Path, ClosedSphereHasItsKnownRadiance) {
    World world;
    Mesh inside = sphere(V3f(0.f), 2.f, 16, false);
    place(world.scene, inside, emitter_material(0.7f, 0.6f));
    world.finish();
    PathOptions options;
    options.max_depth = 1000;
    for (const Technique technique : {Technique::Mis, Technique::BsdfOnly, Technique::LightOnly}) {
        options.technique = technique;
        const Mean e = estimate(world, options, 1024, [](V2f u) {
            return ray_to(V3f(0.3f, 0.2f, -0.1f), V3f(u.x * 6 - 3, u.y * 6 - 3, 1));
        });
        expect_agrees(e, 0.7 / (1 - 0.6), "closed sphere");
    }
}

TEST(Path, WhiteObjectsVanishInAWhiteSky) {
    for (const float metallic : {0.f, 1.f})
        for (const float roughness : {0.f, 0.3f, 1.f}) {
            World world;
            Material m;
            m.metallic = metallic;
            m.roughness = roughness;
            place(world.scene, sphere(V3f(0.f), 1.f, 48, true), m);
            world.scene.sky = Sky::uniform(Rgb(1.f));
            world.finish();
            PathOptions options;
            options.max_depth = 64;
            const Mean e = estimate(world, options, 2048, bundle);
            EXPECT_TRUE(test::agrees(e, 1, 0.005)) << metallic << ' ' << roughness << ": " << e;
            EXPECT_LT(e.error, 0.002) << metallic << ' ' << roughness;
        }
}

World lit_floor(Light light) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    world.scene.lights.push_back(light);
    world.finish();
    return world;
}

TEST(Path, PunctualLightsGiveTheirIlluminance) {
    const auto centre = [](V2f) { return ray_to(V3f(0, 0, 4), V3f(0.f)); };
    const double albedo_over_pi = 0.5 / std::numbers::pi;
    const World point = lit_floor(PointLight{V3f(0, 3, 4), Rgb(100.f)});
    expect_agrees(estimate(point, PathOptions(), 16, centre), albedo_over_pi * 100 / 25 * 0.8,
                  "point");
    const World sun = lit_floor(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
    expect_agrees(estimate(sun, PathOptions(), 16, centre), albedo_over_pi * 10 * 0.8, "sun");
    const World spot = lit_floor(SpotLight{V3f(0, 0, 2), V3f(0, 0, -1), Rgb(8.f), 0.9f, 0.8f});
    expect_agrees(estimate(spot, PathOptions(), 16, centre), albedo_over_pi * 8 / 4, "spot");
}

// A disk's worth of closed form: a square emitter seen from below its centre. Configuration factor
// of a differential plane to a parallel rectangle corner, times four (Howell, C-11).
TEST(Path, SquareEmitterMatchesItsConfigurationFactor) {
    World world;
    place(world.scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    Material light = emitter_material(3.f);
    place(world.scene, quad(V3f(-1, -1, 2), V3f(0, 2, 0), V3f(2, 0, 0)), light);
    world.finish();
    const double a = 0.5, b = 0.5;  // half sides over the distance
    const double corner = 1 / (2 * std::numbers::pi) *
                          (a / std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a)) +
                           b / std::sqrt(1 + b * b) * std::atan(a / std::sqrt(1 + b * b)));
    const double truth = 0.5 * 3 * 4 * corner;
    PathOptions options;
    options.max_depth = 1;
    for (const Technique technique : {Technique::Mis, Technique::LightOnly, Technique::BsdfOnly}) {
        options.technique = technique;
        const Mean e =
            estimate(world, options, 4096, [](V2f) { return ray_to(V3f(3, 0, 1.9f), V3f(0.f)); });
        expect_agrees(e, truth, "square");
    }
}

// Three estimators of one integral: lights only, BSDF only, both.
TEST(Path, TechniquesAgree) {
    World world;
    Material floor;
    floor.base_color = Rgb(0.6f);
    floor.metallic = 0.3f;
    floor.roughness = 0.4f;
    floor.double_sided = true;
    place(world.scene, quad(V3f(-3, -3, -1), V3f(6, 0, 0), V3f(0, 6, 0)), floor);
    place(world.scene, sphere(V3f(0, 0, 0), 0.6f, 24, true), diffuse_material(0.7f));
    place(world.scene, quad(V3f(-1, 1.5f, 1), V3f(2, 0, 0), V3f(0, 1, 0.5f)),
          emitter_material(5.f));
    std::vector<float> sky(3 * 32 * 16, 0.2f);
    for (int i = 0; i < 12; ++i) sky[3 * (4 * 32 + 3 * 4) + static_cast<size_t>(i)] = 20.f;
    world.scene.sky = Sky::picture(sky, 32, 16, 0.f, 1.f);
    world.finish();
    PathOptions options;
    options.max_depth = 4;
    const auto by = [&](Technique technique) {
        options.technique = technique;
        return estimate(world, options, 4096, [](V2f u) {
            return ray_to(V3f(0, 0.5f, 4), V3f(2 * u.x - 1, 2 * u.y - 1, -0.5f));
        });
    };
    const Mean both = by(Technique::Mis);
    for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
        const Mean one = by(technique);
        EXPECT_TRUE(test::agrees(both - one, 0)) << both << " and " << one;
        EXPECT_LT(one.error, 0.01 * one.value);
        EXPECT_LE(both.error, one.error);  // what combining the two is for
    }
}

// A lamp that is half transparent, so that a shadow ray may pass it: rounding leaves its own points
// a little beside its plane, from where it would fill half of what they see.
TEST(Path, AFlatLampDoesNotLightItself) {
    for (const V3f& moved : {V3f(0.f), V3f(10, 20, 30)}) {
        World world;
        Material lamp = emitter_material(1.f);
        lamp.base_color = Rgb(0.8f);
        lamp.double_sided = true;
        lamp.alpha_mode = AlphaMode::Blend;
        lamp.alpha = 0.5f;
        place(world.scene, quad(V3f(-2, -2, -0.3f) + moved, V3f(4, 0, 0.7f), V3f(0.3f, 4, 1)),
              lamp);
        world.finish();
        PathOptions options;
        options.max_depth = 1;
        const auto by = [&](Technique technique) {
            options.technique = technique;
            return estimate(world, options, 4096, [&](V2f u) {
                return ray_to(V3f(0.2f, 0.1f, 4) + moved, V3f(2 * u.x - 1, 2 * u.y - 1, 0) + moved);
            });
        };
        const Mean found = by(Technique::BsdfOnly);
        EXPECT_NEAR(found.value, 0.5, 0.01);
        EXPECT_NEAR(by(Technique::LightOnly).value, found.value, 1e-5);
        EXPECT_NEAR(by(Technique::Mis).value, found.value, 1e-5);
    }
}

// The same by the light tree, whose probabilities depend on the vertex: emitters of one side and of
// two, a bulb and a sky, a glossy floor below and a pane that transmits.
TEST(Path, TechniquesAgreeWithTheLightTree) {
    World world;
    Material floor = diffuse_material(0.6f);
    floor.metallic = 0.3f;
    floor.roughness = 0.4f;
    place(world.scene, quad(V3f(-3, -3, -1), V3f(6, 0, 0), V3f(0, 6, 0)), floor);
    Material pane = diffuse_material(0.9f);
    pane.transmission = 0.7f;
    pane.roughness = 0.5f;
    place(world.scene, quad(V3f(-0.5f, -0.5f, 0.2f), V3f(1, 0, 0), V3f(0, 1, 0.3f)), pane);
    Material one_sided = emitter_material(5.f);
    one_sided.double_sided = false;
    place(world.scene, quad(V3f(-1, 1.5f, 1), V3f(2, 0, 0), V3f(0, 1, 0.5f)), one_sided);
    place(world.scene, quad(V3f(-1.5f, -1, -0.6f), V3f(0, 0.4f, 0), V3f(0, 0, 0.4f)),
          emitter_material(8.f, 0.5f));
    place(world.scene, sphere(V3f(1, -0.5f, -0.5f), 0.2f, 8, false), emitter_material(3.f, 0.2f));
    std::vector<float> sky(3 * 32 * 16, 0.03f);
    std::fill_n(&sky[3 * (3 * 32 + 5)], 30, 1.f);
    world.scene.sky = Sky::picture(sky, 32, 16, 0.f, 1.f);
    world.finish();
    PathOptions options;
    options.max_depth = 4;
    const auto measure = [&](Technique technique, LightChoiceKind kind) {
        options.technique = technique;
        world.lights = std::make_unique<LightChoice>(world.scene, kind);
        return estimate(world, options, 8192, [](V2f u) {
            return ray_to(V3f(0, -0.5f, 4), V3f(2 * u.x - 1, 2 * u.y - 1, -0.5f));
        });
    };
    const Mean mis = measure(Technique::Mis, LightChoiceKind::Tree);
    for (const Mean& other : {measure(Technique::LightOnly, LightChoiceKind::Tree),
                              measure(Technique::BsdfOnly, LightChoiceKind::Tree),
                              measure(Technique::Mis, LightChoiceKind::Power)}) {
        EXPECT_TRUE(test::agrees(mis - other, 0)) << mis << " and " << other;
        EXPECT_LT(other.error, 0.01 * other.value);
    }
}

TEST(Path, CoverageMixesSurfaceAndSky) {
    World world;
    Material m = diffuse_material(0.f);
    m.alpha_mode = AlphaMode::Blend;
    m.alpha = 0.25f;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    world.scene.sky = Sky::uniform(Rgb(2.f));
    world.finish();
    expect_agrees(estimate(world, PathOptions(), 4096, bundle), 0.75 * 2, "blend");
    PathOptions options;
    options.transparent = true;
    float alpha = 0;
    const Mean e = estimate(world, options, 4096, bundle, &alpha);
    EXPECT_EQ(e.value, 0.0);
    EXPECT_NEAR(alpha, 0.25f, 0.01f);
}

TEST(Path, BacksOfSingleSidedSurfacesAreCulledFromViewButCastShadows) {
    World world;
    Material m = diffuse_material(0.5f);
    m.double_sided = false;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(0, 4, 0), V3f(4, 0, 0)), m);  // front away from us
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    EXPECT_NEAR(estimate(world, PathOptions(), 16, bundle).value, 1.0, 1e-5);

    World shaded;
    place(shaded.scene, quad(V3f(-50, -50, -1), V3f(100, 0, 0), V3f(0, 100, 0)),
          diffuse_material(0.5f));
    place(shaded.scene, quad(V3f(-2, -2, 0), V3f(0, 4, 0), V3f(4, 0, 0)), m);
    shaded.scene.lights.push_back(SunLight{V3f(0, 0, -1), Rgb(10.f)});
    shaded.finish();
    PathOptions direct;
    direct.max_depth = 1;
    EXPECT_EQ(estimate(shaded, direct, 16, bundle).value, 0.0);
}

TEST(Path, BackdropIsSeenAndTheEnvironmentLights) {
    World world;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse_material(0.5f));
    world.scene.sky = Sky::uniform(Rgb(2.f));
    world.finish();
    PathOptions options;
    options.visible_background = Rgb(7.f);
    EXPECT_NEAR(
        estimate(world, options, 16, [](V2f) { return ray_to(V3f(0, 0, 4), V3f(9, 9, 4)); }).value,
        7.0, 1e-5);
    expect_agrees(estimate(world, options, 1024, bundle), 0.5 * 2, "lit by the environment");
}

TEST(Path, UnlitShowsItsColour) {
    World world;
    Material m = diffuse_material(0.4f);
    m.unlit = true;
    place(world.scene, quad(V3f(-2, -2, 0), V3f(4, 0, 0), V3f(0, 4, 0)), m);
    world.finish();
    EXPECT_NEAR(estimate(world, PathOptions(), 16, bundle).value, 0.4, 1e-6);
}

// A mirror shows a lamp above it, or the sun of a sky; under an even sky there is nothing to find.
TEST(Path, CountsLampsThatMirrorsShow) {
    enum class Shown { Nothing, Lamp, Sun };
    for (const Shown shown : {Shown::Nothing, Shown::Lamp, Shown::Sun}) {
        World world;
        Material mirror;
        mirror.metallic = 1;
        mirror.roughness = 0;
        place(world.scene, quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0)), mirror);
        if (shown == Shown::Lamp)
            place(world.scene, quad(V3f(-3, -3, 5), V3f(6, 0, 0), V3f(0, 6, 0)),
                  emitter_material(1.f));
        world.scene.sky = Sky::uniform(Rgb(1.f));
        if (shown == Shown::Sun) {  // a texel of 32 x 16 on the horizon, at +z
            std::vector<float> rgb(size_t{3} * 32 * 16, 0.1f);
            for (size_t c = 0; c < 3; ++c) rgb[3 * (8 * 32 + 24) + c] = 1e4f;
            world.scene.sky = Sky::picture(rgb, 32, 16, 0, 1);
        }
        world.finish();
        const PathTracer tracer(world.scene, *world.bvh, *world.lights, PathOptions());
        PathStats stats;
        for (uint32_t i = 0; i < 1000; ++i) {
            const Sampler sampler(SamplerKind::Owen, 0, {0, 0, i});
            FilmSample out;
            std::ignore = tracer.radiance({bundle(sampler.get2(Dim::Film))}, Bands::rgb(), sampler,
                                          out, stats);
        }
        EXPECT_EQ(stats.mirrored.bounces, 1000u);
        if (shown == Shown::Nothing)
            EXPECT_EQ(stats.mirrored.lamps, 0u);
        else
            EXPECT_GT(stats.mirrored.lamps, 500u);
    }
}

/// Mean light of rays by a sampler, which go on by chance from where light is scattered far and
/// wide.
template <class F>
test::Mean light_that_goes_on(const test::World& world, float chance, uint32_t count,
                              const F& ray_of) {
    const PathTracer tracer(world.scene, *world.bvh, *world.lights, PathOptions());
    PathStats stats;
    test::Moments sum;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Independent, 3, {1, 1, i});
        FilmSample out;
        const Ray ray = ray_of(sampler.get2(Dim::Film));
        sum.add(double(tracer.radiance({ray, m4{-1, -1, -1, -1}, true, chance}, Bands::rgb(),
                                       sampler, out, stats)[0]));
    }
    return sum;
}

// Paths that go on by chance from where light is scattered far and wide count as much more.
TEST(Path, WhatGoesOnByChanceCountsMore) {
    test::World world;
    test::place(world.scene, test::sphere(V3f(0.f), 1.f, 16, false), test::diffuse_material(0.8f));
    test::place(world.scene, test::box(V3f(-5), V3f(5)), test::emitter_material(1.f, 0.5f));
    world.finish();
    const auto mean = [&](float rest) {
        return light_that_goes_on(world, rest, 20000, [](V2f u) { return test::bundle(u); });
    };
    const test::Mean all = mean(1), some = mean(0.3f);
    EXPECT_TRUE(test::agrees(all - some, 0)) << all << " and " << some;
    EXPECT_LT(some.error, 0.02 * all.value);
}

// Rays to targets are mirrored by solid glass more often, and count less: what it mirrors and what
// it lets through keep their light, and what it mirrors is known better.
TEST(Path, RaysToTargetsAreMirroredMoreOften) {
    for (const bool in_front : {true, false}) {
        test::World world;
        // Nothing comes back from within where the lamp is in front.
        test::place(world.scene, test::sphere(V3f(0.f), 1.f, 64, true),
                    test::glass_material(1.5f, in_front ? 1e-9f : 1.f));
        const V3f low(-9, -9, in_front ? 6.f : -6.f);
        test::place(world.scene, test::quad(low, V3f(18, 0, 0), V3f(0, 18, 0)),
                    test::emitter_material(1.f, 0.f));
        world.scene.materials.back().double_sided = true;
        world.finish();
        const auto mean = [&](float rest) {
            return light_that_goes_on(world, rest, 60000, [](V2f u) {
                return Ray{V3f(u.x - 0.5f, u.y - 0.5f, 4), V3f(0, 0, -1)};
            });
        };
        const test::Mean ordinary = mean(1), to_target = mean(0.5f);
        EXPECT_GT(ordinary.value, in_front ? 0.03 : 0.8);
        EXPECT_TRUE(test::agrees(ordinary - to_target, 0)) << ordinary << " and " << to_target;
        if (in_front) {
            EXPECT_LT(to_target.error, 0.7 * ordinary.error);
        }
    }
}

}  // namespace
}  // namespace petzval::integrator
