// SPDX-License-Identifier: Apache-2.0
// Light through thin panes, and chains of clear glass.
#include <numbers>

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

Material pane_material(float colour = 1) {
    Material m;
    m.base_color = Rgb(colour);
    m.metallic = 0;
    m.roughness = 0;
    m.transmission = 1;
    m.double_sided = true;
    return m;
}

// What glTF's thin glass of index 1.5 lets through: all that its coat does not reflect (Schlick).
double let_through(double cosine, double colour = 1) {
    return colour * (1 - 0.04 - 0.96 * std::pow(1 - cosine, 5));
}

// The same of n panes, ways between them included: Stokes 1862, for panes that absorb nothing.
double let_through_with_echoes(double cosine, int n) {
    const double r = 1 - let_through(cosine);
    return (1 - r) / (1 + (n - 1) * r);
}

// A floor of albedo 0.5, with panes over it from a height of 1 on, above the camera's ray.
struct UnderPanes : World {
    UnderPanes(int count, const Material& pane) {
        place(scene, quad(V3f(-50, -50, 0), V3f(100, 0, 0), V3f(0, 100, 0)),
              diffuse_material(0.5f));
        for (int i = 0; i < count; ++i)
            place(scene, quad(V3f(-50, -50, 1 + 0.02f * float(i)), V3f(100, 0, 0), V3f(0, 100, 0)),
                  pane);
    }
    [[nodiscard]] Mean at_origin(uint32_t samples, Technique technique = Technique::Mis) const {
        PathOptions options;
        options.max_depth = 1;  // light that comes to the floor once
        options.technique = technique;
        return estimate(*this, options, samples,
                        [](V2f) { return ray_to(V3f(0.7f, 0, 0.9f), V3f(0.f)); });
    }
};

TEST(Panes, PunctualLightsComeThrough) {
    const double albedo_over_pi = 0.5 / std::numbers::pi;
    for (const int count : {1, 2, 10})
        for (const float colour : {1.f, 0.8f}) {
            const auto lit = [&](const Light& light) {
                UnderPanes world(count, pane_material(colour));
                world.scene.lights.push_back(light);
                world.finish();
                return world.at_origin(16);
            };
            const auto through = [&](double cosine) {
                return albedo_over_pi * std::pow(let_through(cosine, double(colour)), count);
            };
            expect_agrees(lit(PointLight{V3f(0, 3, 4), Rgb(100.f)}), through(0.8) * 100 / 25 * 0.8,
                          "point");
            expect_agrees(lit(SunLight{unit(V3f(0, -3, -4)), Rgb(10.f)}), through(0.8) * 10 * 0.8,
                          "sun");
            expect_agrees(lit(SpotLight{V3f(0, 0, 2), V3f(0, 0, -1), Rgb(8.f), 0.9f, 0.8f}),
                          through(1) * 8 / 4, "spot");
        }
}

// A light before the panes gets nothing from them, and one between two of them passes one.
TEST(Panes, OnlyPanesBeforeTheLightCount) {
    for (const auto& [height, passed] : {std::pair{0.95f, 0}, std::pair{1.5f, 1}}) {
        UnderPanes world(1, pane_material(0.5f));
        place(world.scene, quad(V3f(-50, -50, 3), V3f(100, 0, 0), V3f(0, 100, 0)),
              pane_material(0.5f));
        world.scene.lights.push_back(PointLight{V3f(0, 0, height), Rgb(1.f)});
        world.finish();
        expect_agrees(world.at_origin(16),
                      0.5 / std::numbers::pi * std::pow(let_through(1, 0.5), passed) /
                          double(height * height),
                      "point");
    }
}

TEST(Panes, SurfacesBehindAPaneCastTheirShadows) {
    UnderPanes world(2, pane_material());
    place(world.scene, quad(V3f(-9, -9, 1.01f), V3f(18, 0, 0), V3f(0, 18, 0)),
          diffuse_material(0.5f));
    world.scene.lights.push_back(PointLight{V3f(0, 0, 3), Rgb(100.f)});
    world.finish();
    EXPECT_EQ(world.at_origin(16).value, 0);
}

TEST(Panes, WhatIsNotTransmittedIsAShadow) {
    Material half = pane_material(), covered = pane_material(), blend = pane_material();
    half.transmission = 0.5f;
    covered.alpha_mode = AlphaMode::Mask;
    covered.alpha = 0.2f;  // below the cutoff: a hole
    blend.alpha_mode = AlphaMode::Blend;
    blend.alpha = 0.25f;
    Material unlit = pane_material(), metal = pane_material();
    unlit.unlit = true;
    unlit.base_color = Rgb(0.f);
    metal.metallic = 1;
    const double once = let_through(1);
    for (const auto& [pane, share] :
         {std::pair{half, 0.5 * once}, std::pair{covered, 1.}, std::pair{blend, 0.75 + 0.25 * once},
          std::pair{unlit, 0.}, std::pair{metal, 0.}}) {
        UnderPanes world(1, pane);
        // Not over the diagonal, where both triangles of a quad are asked for their coverage.
        world.scene.lights.push_back(PointLight{V3f(1e-3f, 0, 2), Rgb(4.f)});
        world.finish();
        const Mean e = world.at_origin(256);
        EXPECT_TRUE(test::agrees(e, share * 0.5 / std::numbers::pi, 1e-5)) << share << ": " << e;
    }
}

// Techniques share the light of a lamp and of a sky between them: each alone finds all of it.
TEST(Panes, ALampComesThrough) {
    for (const int count : {1, 2, 10}) {
        UnderPanes world(count, pane_material(0.8f));
        place(world.scene, quad(V3f(-1, -1, 2), V3f(0, 2, 0), V3f(2, 0, 0)), emitter_material(3.f));
        world.finish();
        // Over the square, of radiance x transmittance x the two cosines / distance^2.
        double sum = 0;
        constexpr int n = 400;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double x = (i + 0.5) / n * 2 - 1, y = (j + 0.5) / n * 2 - 1;
                const double square = x * x + y * y + 4, cosine = 2 / std::sqrt(square);
                sum += 4. / (n * n) * std::pow(let_through(cosine, double(0.8f)), count) * cosine *
                       cosine / square;
            }
        const double straight = 0.5 / std::numbers::pi * 3 * sum;
        const Mean mis = world.at_origin(1024);
        // Between panes light goes to and fro: at most (n R)^2 / 2 of it for n panes.
        if (count == 1)
            expect_agrees(mis, straight, "lamp");
        else
            EXPECT_NEAR(mis.value / straight, 1 + count * (count - 1) / 2 * 0.8 * 0.8 * 0.04 * 0.04,
                        0.01 * count);
        for (const Technique technique : {Technique::LightOnly, Technique::BsdfOnly}) {
            const Mean one = world.at_origin(1024, technique);
            EXPECT_TRUE(test::agrees(mis - one, 0)) << count << ": " << mis << " and " << one;
            EXPECT_LT(one.error, 0.1 * one.value) << count;
        }
    }
}

TEST(Panes, AWhiteSkyComesThrough) {
    for (const int count : {1, 2, 10}) {
        UnderPanes world(count, pane_material());
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        double sum = 0;  // over the squared cosine
        constexpr int n = 10000;
        for (int i = 0; i < n; ++i)
            sum += let_through_with_echoes(std::sqrt((i + 0.5) / n), count) / n;
        const Mean e = world.at_origin(4096);
        EXPECT_TRUE(test::agrees(e, 0.5 * sum, 1e-4))
            << count << ": " << e << ", not " << 0.5 * sum;
        EXPECT_LT(e.error, 0.005 * e.value);
    }
}

// The glazed room: sun, sky and lamps stand outside, and the room inside is
// coloured.
World room_with_pane(bool glazed, const Material& pane) {
    World world;
    const auto wall = [&](V3f corner, V3f a, V3f b, float albedo) {
        place(world.scene, quad(corner, a, b), diffuse_material(albedo));
    };
    wall(V3f(-2, -1, -2), V3f(4, 0, 0), V3f(0, 0, 4), 0.6f);    // floor
    wall(V3f(-2, 2, -2), V3f(4, 0, 0), V3f(0, 0, 4), 0.7f);     // ceiling
    wall(V3f(-2, -1, -2), V3f(4, 0, 0), V3f(0, 3, 0), 0.5f);    // back
    wall(V3f(-2, -1, -2), V3f(0, 0, 4), V3f(0, 3, 0), 0.5f);    // left
    wall(V3f(2, -1, -2), V3f(0, 0, 4), V3f(0, 0.8f, 0), 0.5f);  // right: below the window
    wall(V3f(2, 1, -2), V3f(0, 0, 4), V3f(0, 1, 0), 0.5f);      // and above it
    wall(V3f(-2, -1, 2.f), V3f(4, 0, 0), V3f(0, 3, 0), 0.5f);   // behind the camera
    if (glazed) place(world.scene, quad(V3f(2, -0.2f, -2), V3f(0, 0, 4), V3f(0, 1.2f, 0)), pane);
    place(world.scene, quad(V3f(5, 1, -1), V3f(0, 0, 2), V3f(0, 1, 0)), emitter_material(20.f));
    std::vector<float> texels(size_t(32 * 16 * 3), 0.5f);
    for (size_t k = 0; k < 3; ++k) texels[(5 * 32 + 16) * 3 + k] = 300.f;
    world.scene.sky = Sky::picture(texels, 32, 16, 0.f, 1.f);
    world.finish();
    return world;
}

Ray into_room(V2f u) {
    return ray_to(V3f(-1, 0.5f, 1.5f), V3f(3 * u.x - 1.5f, -0.9f, 2 * u.y - 1.5f));
}

TEST(Panes, TechniquesAgree) {
    Material rough = pane_material(0.7f), mixed = pane_material(0.7f);
    rough.roughness = 0.3f;
    mixed.transmission = 0.6f;
    for (const Material& pane : {pane_material(0.7f), mixed, rough}) {
        const World world = room_with_pane(true, pane);
        PathOptions options;
        options.max_depth = 3;
        const Mean mis = test::expect_techniques_agree(world, options, 2048, into_room, 0.2);
        EXPECT_LT(mis.error, 0.03 * mis.value);
    }
}

TEST(Panes, AGlazedRoomHasTheNoiseOfAnOpenOne) {
    const Mean open = estimate(room_with_pane(false, {}), PathOptions(), 2048, into_room);
    const Mean glazed =
        estimate(room_with_pane(true, pane_material()), PathOptions(), 2048, into_room);
    EXPECT_LT(glazed.error / glazed.value, 1.5 * open.error / open.value);
    EXPECT_GT(glazed.value, 0.85 * open.value);
    EXPECT_LT(glazed.value, open.value);
}

// Each clear surface passes all of a white sky on, one way or the other: what is lost is what ends.
TEST(ClearGlass, TenPanesLoseNothing) {
    for (const bool thin : {true, false}) {
        World world;
        Material glass = pane_material();
        glass.has_volume = !thin;
        for (int i = 0; i < 10; ++i) {
            const float z = -0.1f * float(i);
            place(world.scene, quad(V3f(-9, -9, z), V3f(18, 0, 0), V3f(0, 18, 0)), glass);
            if (!thin)
                place(world.scene, quad(V3f(-9, -9, z - 0.05f), V3f(0, 18, 0), V3f(18, 0, 0)),
                      glass);
        }
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const PathTracer tracer(world.scene, *world.bvh, *world.lights, PathOptions());
        PathStats stats;
        test::Moments light;
        for (uint32_t i = 0; i < 20000; ++i) {
            FilmSample out;
            const Sampler sampler(SamplerKind::Independent, 2, {0, 0, i});
            const Ray ray = ray_to(V3f(0.1f, 0.2f, 1), V3f(0.3f, 0.1f, 0));
            light.add(double(tracer.radiance({ray}, Bands::rgb(), sampler, out, stats)[0]));
        }
        EXPECT_LT(light.variance(), 0.01);
        EXPECT_NEAR(light.mean(), 1, 0.001);
    }
}

// A cube about the origin, faces outward.
Mesh cube_of(float half) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-half, half}) {
            V3f corner(-half), a(0.f), b(0.f);
            corner[axis] = side;
            a[(axis + 1) % 3] = b[(axis + 2) % 3] = 2 * half;
            const Mesh face = side > 0 ? quad(corner, a, b) : quad(corner, b, a);
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.insert(mesh.positions.end(), face.positions.begin(),
                                  face.positions.end());
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
    return mesh;
}

// Paths that nothing lets out end, and are counted.
TEST(ClearGlass, PathsThatCannotLeaveEnd) {
    const auto ends = [](const Mesh& mesh, const Material& material, V3f from, V3f towards,
                         int samples) {
        World world;
        place(world.scene, mesh, material);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        const PathTracer tracer(world.scene, *world.bvh, *world.lights, PathOptions());
        PathStats stats;
        for (int i = 0; i < samples; ++i) {
            FilmSample out;
            const Sampler sampler(SamplerKind::Owen, 2, {0, 0, uint32_t(i)});
            const f4 seen =
                tracer.radiance({ray_to(from, towards)}, Bands::rgb(), sampler, out, stats);
            EXPECT_TRUE(std::isfinite(seen[0]));
        }
        EXPECT_LE(stats.camera_rays + stats.bounce_rays, uint64_t(samples) * 258);
        return stats.specular_ends;
    };
    Material glass = pane_material(), mirror;
    glass.has_volume = true;
    mirror.roughness = 0;
    mirror.double_sided = true;
    const Mesh ball = sphere(V3f(0.f), 1.f, 64, false), cube = cube_of(1.f);
    // Past the critical angle at each of the faces, again and again.
    EXPECT_EQ(ends(cube, glass, V3f(0.2f, 0.1f, 0), V3f(1.2f, 1, 1.1f), 64), 64u);
    ends(cube, glass, V3f(0.2f, 0.1f, 0), V3f(0, 0, 1), 64);
    ends(ball, glass, V3f(0.9f, 0, 0), V3f(0.9f, 0.1f, 0.05f), 64);
    EXPECT_EQ(ends(cube, mirror, V3f(0.2f, 0.1f, 0), V3f(1.2f, 1, 1.1f), 64), 0u);
    EXPECT_EQ(ends(ball, mirror, V3f(0.2f, 0.1f, 0), V3f(0, 0, 1), 64), 0u);
    EXPECT_EQ(ends(ball, pane_material(), V3f(0.2f, 0.1f, 0), V3f(0, 0, 1), 64), 0u);
}

}  // namespace
}  // namespace petzval::integrator
