// SPDX-License-Identifier: Apache-2.0
// BLEND surfaces against closed forms: seen, lit, as lamps, in shadow rays, in stacks.
#include <numbers>

#include "tests/integrator/path_estimate.h"
#include "tests/support/moving.h"

namespace petzval::integrator {
namespace {

using test::diffuse_material;
using test::emitter_material;
using test::estimate;
using test::expect_agrees;
using test::Mean;
using test::place;
using test::quad;
using test::ray_to;
using test::World;

Material blended(Material m, float alpha) {
    m.alpha_mode = AlphaMode::Blend;
    m.alpha = alpha;
    m.double_sided = true;
    return m;
}

Material plain(float value, float alpha) {  // shows its value, and no light
    Material m = diffuse_material(value);
    m.unlit = true;
    return blended(m, alpha);
}

Mesh sheet(float z) {
    return quad(V3f(-50, -50, z), V3f(100, 0, 0), V3f(0, 100, 0));
}

// Downwards, off the diagonals of the sheets.
Ray from_above(V2f = {}) {
    return ray_to(V3f(0.7f, 0.1f, 9), V3f(0.3f, 0, 0));
}

Mean seen(World& world, uint32_t samples, int max_depth = 1, float* alpha = nullptr,
          bool transparent = false) {
    PathOptions options;
    options.max_depth = max_depth;
    options.transparent = transparent;
    return estimate(world, options, samples, from_above, alpha);
}

// `count` sheets from a height of 1 on, each a millimetre above the last.
struct Stack : World {
    Stack(int count, const Material& material, float apart_m = 0.001f) {
        for (int i = 0; i < count; ++i)
            place(scene, sheet(1 + apart_m * static_cast<float>(i)), material);
    }
};

TEST(Blend, AStackShowsEachSheetByWhatTheOthersLeave) {
    for (const int count : {1, 2, 10, 1000})
        for (const float alpha : {0.004f, 0.03f, 0.25f, 0.7f}) {
            Stack world(count, plain(2, alpha));
            world.scene.sky = Sky::uniform(Rgb(1.f));
            world.finish();
            const double left = std::pow(1 - double{alpha}, count);
            const Mean e = seen(world, 256);
            EXPECT_TRUE(test::agrees(e, 2 * (1 - left) + left, 1e-5))
                << count << " of " << alpha << ": " << e;
        }
}

// The sun shines through the sheets that the camera looks through.
TEST(Blend, AStackIsLitThroughItself) {
    for (const int count : {1, 2, 10})
        for (const float alpha : {0.1f, 0.25f, 0.6f}) {
            Stack world(count, blended(diffuse_material(0.5f), alpha));
            place(world.scene, sheet(0), diffuse_material(0.8f));
            world.scene.lights.push_back(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
            world.finish();
            const double lit = 10 * 0.8 / std::numbers::pi, left = 1 - double{alpha};
            double expected = 0.8 * lit * std::pow(left, 2 * count);
            for (int i = 0; i < count; ++i)
                expected += 0.5 * lit * double{alpha} * std::pow(left, 2 * i);
            const Mean e = seen(world, 1024);
            EXPECT_TRUE(test::agrees(e, expected, 1e-5))
                << count << " of " << alpha << ": " << e << ", not " << expected;
        }
}

TEST(Blend, SheetsInOnePlaceAllCount) {
    for (const float alpha : {0.1f, 0.5f}) {
        Stack world(3, plain(2, alpha), 0.f);
        place(world.scene, sheet(0), diffuse_material(0.8f));
        world.scene.lights.push_back(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
        world.finish();
        const double left = std::pow(1 - double{alpha}, 3);
        const Mean e = seen(world, 1024);
        // The floor, by the sun through the sheets and by what they show.
        const double floor = 0.8 * (10 * 0.8 / std::numbers::pi * left + 2 * (1 - left));
        EXPECT_TRUE(test::agrees(e, 2 * (1 - left) + left * floor, 1e-5)) << alpha << ": " << e;
    }
}

// What a ray sees of a stack does not hang on its tosses where nothing is seldom met.
TEST(Blend, DarkSheetsMakeNoNoise) {
    Stack world(4, blended(diffuse_material(0.f), 0.3f));
    place(world.scene, sheet(0), emitter_material(1.f));
    world.finish();
    const Mean e = seen(world, 16);
    EXPECT_TRUE(test::agrees(e, std::pow(0.7, 4), 1e-5)) << e;
    EXPECT_LT(e.error, 1e-6);
}

TEST(Blend, AlphaAndLayersAreOfTheFirstThatStops) {
    for (const int count : {1, 2, 10}) {
        const double alpha = 0.3;
        Stack world(count, blended(diffuse_material(0.5f), float(alpha)), 0.5f);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        float covered = 0;
        seen(world, 256, 4, &covered, true);
        EXPECT_NEAR(covered, 1 - std::pow(1 - alpha, count), 0.01) << count;

        // Heights of what stops, from the top: of all samples, those that passed k sheets.
        PathOptions options;
        const PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
        PathStats stats;
        std::vector<double> at(size_t(count) + 1);
        constexpr uint32_t samples = 8192;
        for (uint32_t i = 0; i < samples; ++i) {
            FilmSample out;
            const Sampler sampler(SamplerKind::Owen, 7, {1, 2, i});
            (void)tracer.radiance({.ray = from_above(), .fills_layers = true}, Bands::rgb(),
                                  sampler, out, stats);
            const float z = out.aov[static_cast<size_t>(Aov::Position)].z;
            at[out.hit ? size_t(std::lround((z - 1) / 0.5f)) : size_t(count)] += 1. / samples;
        }
        for (int i = 0; i < count; ++i) {
            const double share = alpha * std::pow(1 - alpha, count - 1 - i);
            EXPECT_NEAR(at[size_t(i)], share, 5 * std::sqrt(share / samples)) << count << ' ' << i;
        }
    }
}

// Light of a lamp and of the sky that comes through a sheet: each technique finds all of it.
TEST(Blend, LampsAndSkiesShineThrough) {
    for (const int count : {0, 1, 3}) {
        Stack world(count, blended(diffuse_material(0.f), 0.3f));
        place(world.scene, sheet(0), diffuse_material(0.5f));
        place(world.scene, quad(V3f(-1, -1, 3), V3f(0, 2, 0), V3f(2, 0, 0)), emitter_material(3.f));
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        PathOptions options;
        options.max_depth = 1;
        const Mean e = test::expect_techniques_agree(
            world, options, 4096, [](V2f) { return ray_to(V3f(.7f, 0, .9f), V3f(0.f)); }, 0.01);
        static double open = 0;
        if (count == 0) open = e.value;
        EXPECT_TRUE(test::agrees(e, open * std::pow(0.7, count), 0.004 * e.value)) << count;
    }
}

TEST(Blend, ALampGivesItsShare) {
    const auto lit = [](float alpha, Technique technique) {
        World world;
        place(world.scene, sheet(0), diffuse_material(0.5f));
        Material lamp = emitter_material(3.f);
        if (alpha < 1) lamp = blended(lamp, alpha);
        lamp.double_sided = true;
        place(world.scene, quad(V3f(-1, -1, 2), V3f(0, 2, 0), V3f(2, 0, 0)), lamp);
        world.finish();
        PathOptions options;
        options.max_depth = 1;
        options.technique = technique;
        return estimate(world, options, 4096,
                        [](V2f) { return ray_to(V3f(.7f, 0, .9f), V3f(0.f)); });
    };
    const Mean whole = lit(1, Technique::Mis);
    for (const float alpha : {0.05f, 0.4f})
        for (const auto by : {Technique::Mis, Technique::LightOnly, Technique::BsdfOnly}) {
            const Mean e = lit(alpha, by);
            EXPECT_TRUE(test::agrees(e - Mean(alpha * whole.value, alpha * whole.error), 0))
                << alpha << ": " << e;
        }
}

// A pane and two sheets between a light and the floor, in every order.
TEST(Blend, CountsBesidePanes) {
    Material pane = blended(diffuse_material(1.f), 1.f);
    pane.alpha_mode = AlphaMode::Opaque;
    pane.specular = 1;
    pane.roughness = 0;
    pane.transmission = 1;
    for (const int at : {0, 1, 2}) {
        World world;
        place(world.scene, sheet(0), diffuse_material(0.5f));
        for (int i = 0; i < 3; ++i)
            place(world.scene, sheet(1 + 0.1f * float(i)),
                  i == at ? pane : blended(diffuse_material(0.f), 0.3f));
        world.scene.lights.push_back(PointLight{V3f(1e-3f, 0, 2), Rgb(4.f)});
        world.finish();
        PathOptions options;
        options.max_depth = 1;
        const Mean e =
            estimate(world, options, 64, [](V2f) { return ray_to(V3f(.7f, 0, .9f), V3f(0.f)); });
        expect_agrees(e, 0.5 / std::numbers::pi * 0.96 * 0.49, "pane");
    }
}

// A sheet in a volume that absorbs: each part of the way counts once.
TEST(Blend, LiesInAVolume) {
    World world;
    Material glass = diffuse_material(1.f);
    glass.roughness = 0;
    glass.specular = 1;
    glass.ior = 1;  // reflects nothing
    glass.transmission = 1;
    glass.has_volume = true;
    glass.attenuation_color = Rgb(0.5f);
    glass.attenuation_distance_m = 1;
    place(world.scene, test::box(V3f(-50, -50, 1), V3f(50, 50, 3)), glass);
    place(world.scene, sheet(2), plain(3, 0.4f));
    place(world.scene, sheet(0), emitter_material(5.f));
    world.finish();
    PathOptions options;
    const Mean e = estimate(world, options, 256,
                            [](V2f) { return ray_to(V3f(.3f, .1f, 9), V3f(.3f, .1f, 0)); });
    expect_agrees(e, 0.4 * 3 * 0.5 + 0.6 * 5 * 0.25, "volume");
}

// The nearer faces of two boxes, one in the other; of single-sided ones glTF culls the backs.
TEST(Blend, ClosedBoxesShowTheirFaces) {
    for (const bool double_sided : {false, true}) {
        World world;
        for (const float half : {1.f, 2.f}) {
            Material m = plain(2, 0.5f);
            m.double_sided = double_sided;
            place(world.scene, test::box(V3f(-half), V3f(half)), m);
        }
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const double left = std::pow(0.5, double_sided ? 4 : 2);
        const Mean e = seen(world, 256);
        EXPECT_TRUE(test::agrees(e, 2 * (1 - left) + left, 1e-5)) << double_sided << ": " << e;
    }
}

TEST(Blend, IsNotSeenInAWhiteFurnace) {
    World world;
    place(world.scene, test::box(V3f(-1), V3f(1)), blended(diffuse_material(1.f), 0.5f));
    place(world.scene, test::box(V3f(-.5f), V3f(.5f)), blended(diffuse_material(1.f), 0.1f));
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const Mean e = seen(world, 256, 1000);
    EXPECT_TRUE(test::agrees(e, 1, 0.001)) << e;
}

TEST(Blend, GreySheetsScatterTheSky) {
    for (const float alpha : {0.1f, 0.4f}) {
        Stack world(1, blended(diffuse_material(0.5f), alpha));
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const Mean e = seen(world, 256, 4);
        EXPECT_TRUE(test::agrees(e, 1 - 0.5 * double{alpha}, 1e-5)) << alpha << ": " << e;
    }
}

TEST(Blend, MovesWithTheShutter) {
    World world;
    const auto at = [](float z) {
        M44f m;
        m[3][0] = z;
        return m;
    };
    // Before the ray from the middle of the exposure on.
    test::place_moving(world.scene, quad(V3f(0, -5, 1), V3f(5, 0, 0), V3f(0, 10, 0)),
                       plain(3, 0.4f), {at(0.5f), at(-0.5f)});
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const Mean e = estimate(world, {}, 1024, [](V2f u) {
        Ray ray = ray_to(V3f(0, 0.1f, 9), V3f(0, 0.1f, 0));
        ray.time = u.x;
        return ray;
    });
    EXPECT_TRUE(test::agrees(e, 0.5 + 0.5 * (0.4 * 3 + 0.6), 0.002)) << e;
}

// All below the camera: a tenth of a thousandth each, of which 37 % of the light is left.
TEST(Blend, LinesOfAHundredThousandEnd) {
    constexpr int kCount = 100'000;
    Stack world(kCount, plain(2, 1e-5f), 7e-5f);
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    const double left = std::pow(1 - double{1e-5f}, kCount);
    const Mean e = seen(world, 4);
    EXPECT_TRUE(test::agrees(e, 2 * (1 - left) + left, 1e-5)) << e;

    // A floor, by the sun through them and by what they show.
    world.scene.sky = {};
    place(world.scene, sheet(0), diffuse_material(0.8f));
    world.scene.lights.push_back(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
    world.finish();
    const Mean lit =
        estimate(world, {}, 2, [](V2f) { return ray_to(V3f(.7f, .1f, .9f), V3f(.3f, 0, 0)); });
    const double due = 0.8 * (10 * 0.8 / std::numbers::pi * left + 2 * (1 - left));
    EXPECT_TRUE(test::agrees(lit, due, 1e-5)) << lit << ", not " << due;
}

// White; the left half covers, the right one does not.
Image half_covered() {
    Image out;
    out.width = out.height = 16;
    std::vector<uint8_t> texels;
    for (int i = 0; i < 256; ++i)
        texels.insert(texels.end(), {255, 255, 255, uint8_t(i % 16 < 8 ? 255 : 0)});
    out.texels = std::move(texels);
    return out;
}

// Holes, but for the last card.
TEST(Mask, LinesOfAHundredThousandEnd) {
    constexpr int kCount = 100'000;
    World world;
    Material card = plain(2, 1);
    card.alpha_mode = AlphaMode::Mask;
    card.base_color_texture.image = 0;
    world.scene.images.push_back(half_covered());
    for (int i = 0; i < kCount; ++i) {
        Mesh mesh = sheet(1 + 7e-5f * float(i));
        const float u = i == 0 ? 0.25f : 0.75f;  // covered, or not
        mesh.uv[0] = {V2f(u, 0), V2f(u + 0.1f, 0), V2f(u + 0.1f, 1), V2f(u, 1)};
        place(world.scene, mesh, card);
    }
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    EXPECT_EQ(seen(world, 1).value, 2);
    EXPECT_EQ(world.bvh->passage(from_above()).left, 0.f);
    Ray until_the_last = from_above();
    until_the_last.t_max = 7.99f;
    EXPECT_EQ(world.bvh->passage(until_the_last).left, 1.f);
}

// Colours of vertices of alpha 1: the factor is the cutoff to the last bit, everywhere.
TEST(Mask, IsWholeAtItsCutoff) {
    World world;
    Material card = plain(2, 0.3f);
    card.alpha_mode = AlphaMode::Mask;
    card.alpha_cutoff = 0.3f;
    Mesh mesh = sheet(1);
    mesh.colours.assign(4, V4f(1, 1, 1, 1));
    place(world.scene, mesh, card);
    world.finish();
    for (uint32_t i = 0; i < 1000; ++i) {
        const V3f to(to_unit_float(hash32(i, 1)), to_unit_float(hash32(i, 2)), 1);
        ASSERT_EQ(world.bvh->passage(ray_to(V3f(0.7f, 0.1f, 9), to)).left, 0.f) << i;
    }
}

// Of a sheet whose back is a reversed copy, the camera sees each side once: backs are culled. Where
// both are double-sided, both are seen.
TEST(Blend, ReversedCopiesShowEachSideOnce) {
    for (const bool double_sided : {false, true})
        for (const bool one_mesh : {false, true})
            for (const bool below : {false, true}) {
                World world;
                Material m = plain(2, 0.4f);
                m.double_sided = double_sided;
                Mesh there = sheet(1), back = there;
                for (auto& t : back.triangles) std::swap(t[1], t[2]);
                if (one_mesh) test::append(there, back);
                place(world.scene, there, m);
                if (!one_mesh) place(world.scene, back, m);
                world.scene.sky = Sky::uniform(Rgb(1.f));
                world.finish();
                const Mean e = estimate(world, {}, 16, [&](V2f) {
                    return ray_to(V3f(0.7f, 0.1f, below ? -9 : 9), V3f(0.3f, 0, 1));
                });
                const double left = double_sided ? 0.36 : 0.6;
                EXPECT_TRUE(test::agrees(e, 2 * (1 - left) + left, 1e-5))
                    << double_sided << one_mesh << below << ": " << e;
            }
}

// Whatever a surface is made of, it counts by its coverage before a sky that is seen beside it.
TEST(Blend, LayersCountByTheCoverage) {
    const auto lit = [](Material m, float alpha) {
        World world;
        place(world.scene, sheet(1), alpha < 1 ? blended(m, alpha) : m);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.scene.lights.push_back(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)});
        world.finish();
        return seen(world, 1024, 4);
    };
    const auto with = [](auto change) {
        Material m = diffuse_material(0.5f);
        change(m);
        return m;
    };
    const auto film = [](Material& m) {
        m.iridescence = 1, m.film_ior = 1.8f, m.specular = 1, m.roughness = 0.4f;
    };
    const auto coat = [](Material& m) { m.coat = 1, m.coat_roughness = 0.3f; };
    for (const Material& m :
         {with(film), with(coat), with([&](Material& m) { film(m), coat(m); }),
          with([](Material& m) { m.metallic = 1, m.roughness = 0.2f; }),
          with([](Material& m) { m.sheen_color = Rgb(0.8f), m.sheen_roughness = 0.5f; })}) {
        const Mean whole = lit(m, 1);
        for (const float alpha : {0.1f, 0.6f}) {
            const Mean e = lit(m, alpha), due(alpha * whole.value, alpha * whole.error);
            EXPECT_TRUE(test::agrees(e - due, 1 - double{alpha}, 1e-5)) << alpha << ": " << e;
            EXPECT_LT(e.error, 0.01 * e.value);
        }
    }
}

TEST(Blend, OddAlphaIsClamped) {
    for (const auto& [alpha, covered] :
         {std::pair{1.5f, 1.}, std::pair{-1.f, 0.}, std::pair{std::nanf(""), 0.}}) {
        Stack world(2, plain(2, alpha));
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const Mean e = seen(world, 16);
        EXPECT_TRUE(test::agrees(e, 1 + covered, 1e-5)) << alpha << ": " << e;
    }
}

}  // namespace
}  // namespace petzval::integrator
