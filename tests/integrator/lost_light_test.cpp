// SPDX-License-Identifier: Apache-2.0
// Lights that no path finds are named, and no others.
#include "integrator/prepass/lost_light.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace petzval::integrator {
namespace {

using test::append;
using test::box;
using test::diffuse_material;
using test::emitter_material;
using test::glass_material;
using test::place;
using test::quad;
using test::sphere;
using test::World;

enum class Shell { Solid, Thin, Rough, None };

// A white room of 4 m, in its middle a globe of 0.1 m about whatever lights it.
World room(Shell shell) {
    World world;
    place(world.scene, box(V3f(-2), V3f(2)), diffuse_material(0.8f));
    Material glass = glass_material(1.5f);
    if (shell == Shell::Thin) glass.has_volume = false;
    if (shell == Shell::Rough) glass.roughness = 0.4f;
    if (shell == Shell::None) return world;
    // Outside and cavity: a shell of 5 mm.
    Mesh shell_mesh = sphere(V3f(0), 0.1f, 16, false), cavity = sphere(V3f(0), 0.095f, 16, false);
    for (auto& triangle : cavity.triangles) std::swap(triangle[1], triangle[2]);
    append(shell_mesh, cavity);
    place(world.scene, shell_mesh, glass);
    return world;
}

std::vector<LostLight> lost(World& world) {
    world.finish();
    return lost_light(world.scene, *world.bvh);
}

TEST(LostLight, APointInAGlobeIsNamed) {
    World world = room(Shell::Solid);
    world.scene.lights.push_back(PointLight{V3f(0), Rgb(1.f)});
    const auto found = lost(world);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, LostLight::Kind::Point);
    EXPECT_EQ(found[0].light, 0u);
    EXPECT_EQ(found[0].glass, 1u);
    EXPECT_NEAR(found[0].share, 1, 1e-6);
}

TEST(LostLight, WhatPathsFindIsNotNamed) {
    for (const Shell shell : {Shell::Thin, Shell::Rough, Shell::None}) {
        World world = room(shell);
        place(world.scene, sphere(V3f(9), 1, 8, false), glass_material(1.5f));  // in the dark
        world.scene.lights.push_back(PointLight{V3f(0), Rgb(1.f)});
        EXPECT_TRUE(lost(world).empty()) << int(shell);
    }
}

// Of a light beside the globe, what casts the globe's shadow is lost.
TEST(LostLight, BesideTheGlassItIsWhatGoesThrough) {
    World world = room(Shell::Solid);
    world.scene.lights.push_back(PointLight{V3f(0, 0, 0.4f), Rgb(1.f)});
    const auto found = lost(world);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_GT(found[0].share, 0.9);

    World away = room(Shell::Solid);
    SpotLight spot{V3f(0, 0, 0.4f), V3f(0, 0, 1), Rgb(1.f), 0.9f, 0.8f};
    away.scene.lights.push_back(spot);
    EXPECT_TRUE(lost(away).empty());
    World towards = room(Shell::Solid);
    spot.direction = V3f(0, 0, -1);
    spot.cos_outer = 0.99f;
    towards.scene.lights.push_back(spot);
    const auto named = lost(towards);
    ASSERT_EQ(named.size(), 1u);
    EXPECT_EQ(named[0].kind, LostLight::Kind::Spot);
    EXPECT_NEAR(named[0].share, 1, 0.01);
}

// Small windows of a large house, far apart; a spot that is narrower than the pane; glass whose
// roughness comes from a texture that has none.
TEST(LostLight, SmallShareAndNarrowConesAreFound) {
    World house;
    place(house.scene, quad(V3f(-50, 0, -50), V3f(0, 0, 100), V3f(100, 0, 0)),
          diffuse_material(0.5f));
    for (const float x : {-30.f, 30.f})
        place(house.scene, box(V3f(x, 2, 0), V3f(x + 0.5f, 2.01f, 0.5f)), glass_material(1.5f));
    house.scene.lights.push_back(SunLight{V3f(0, -1, 0), Rgb(1e5f)});
    EXPECT_EQ(lost(house).size(), 1u);

    World pane;
    place(pane.scene, quad(V3f(-5, 0, -5), V3f(0, 0, 10), V3f(10, 0, 0)), diffuse_material(0.5f));
    place(pane.scene, box(V3f(-4, 1, -4), V3f(4, 1.01f, 4)), glass_material(1.5f));
    pane.scene.lights.push_back(
        SpotLight{V3f(0, 3, 0), V3f(0, -1, 0), Rgb(1.f), 0.99999f, 0.9999f});
    EXPECT_EQ(lost(pane).size(), 1u);
}

TEST(LostLight, ATextureSaysWhereGlassIsRough) {
    for (const uint8_t roughness : {uint8_t{0}, uint8_t{200}}) {
        World world = room(Shell::Solid);
        world.scene.images.push_back(
            Image{"orm", 1, 1, std::vector<uint8_t>{0, roughness, 0, 255}});
        Material& glass = world.scene.materials[1];
        glass.roughness = 1;
        glass.metallic = 1;  // times a texture of 0
        glass.metallic_roughness_texture.image = 0;
        world.scene.lights.push_back(PointLight{V3f(0), Rgb(1.f)});
        EXPECT_EQ(lost(world).size(), roughness == 0 ? 1u : 0u);
    }
}

// Glass that lights nothing behind it loses nothing.
TEST(LostLight, WhatLeavesTheSceneIsNotLost) {
    World world;
    place(world.scene, sphere(V3f(0), 0.1f, 16, false), glass_material(1.5f));
    world.scene.lights.push_back(PointLight{V3f(0, 0, 0.4f), Rgb(1.f)});
    EXPECT_TRUE(lost(world).empty());
}

TEST(LostLight, OfLampsTheSizeDecides) {
    for (const float radius : {0.0005f, 0.05f}) {
        World world = room(Shell::Solid);
        place(world.scene, sphere(V3f(0), radius, 8, false), emitter_material(100.f));
        const auto found = lost(world);
        // Half its surface over pi D^2, at 2 m and more: 1.2e-7 to 4e-7, and 1.2e-3 to 4e-3.
        ASSERT_EQ(found.size(), radius < 0.01f ? 1u : 0u) << radius;
        if (found.empty()) continue;
        EXPECT_EQ(found[0].kind, LostLight::Kind::Lamp);
        EXPECT_GE(found[0].size, 1.99 * double(radius));
        EXPECT_LE(found[0].size, 2 * std::sqrt(3.) * double(radius));
    }
}

// A house of one room: the sun comes in through the window of its lid.
TEST(LostLight, TheSunBehindASolidWindowIsNamed) {
    for (const bool solid : {true, false}) {
        World world;
        const Material wall = diffuse_material(0.5f);
        place(world.scene, quad(V3f(-1, 0, -1), V3f(0, 0, 2), V3f(2, 0, 0)), wall);
        for (const V3f& corner : {V3f(-1, 2, -1), V3f(0.2f, 2, -1)})
            place(world.scene, quad(corner, V3f(0, 0, 2), V3f(0.8f, 0, 0)), wall);
        Material glass = glass_material(1.5f);
        glass.has_volume = solid;
        place(world.scene, box(V3f(-0.2f, 1.99f, -1), V3f(0.2f, 2, 1)), glass);
        world.scene.lights.push_back(SunLight{unit(V3f(0.1f, -1, 0)), Rgb(1e5f)});
        const auto found = lost(world);
        ASSERT_EQ(found.size(), solid ? 1u : 0u);
        if (!solid) continue;
        EXPECT_EQ(found[0].kind, LostLight::Kind::Sun);
        EXPECT_GT(found[0].share, 0.1);
    }
}

TEST(LostLight, ABrightSpotOfTheSkyCountsByItsSize) {
    for (const int width : {16, 2048}) {
        World world;
        place(world.scene, quad(V3f(-1, 0, -1), V3f(0, 0, 2), V3f(2, 0, 0)),
              diffuse_material(0.5f));
        place(world.scene, box(V3f(-1, 1, -1), V3f(1, 1.1f, 1)), glass_material(1.5f));
        std::vector<float> rgb(static_cast<size_t>(3 * width * width / 2), 0.01f);
        const int bright = width / 16 * width + width / 2;  // an eighth of the way from the zenith
        for (int c = 0; c < 3; ++c) rgb[static_cast<size_t>(3 * bright + c)] = 1e4f;
        world.scene.sky = Sky::picture(rgb, width, width / 2, 0, 1);
        const auto found = lost(world);
        if (width == 16) {
            EXPECT_TRUE(found.empty());
            continue;
        }
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].kind, LostLight::Kind::SkySpot);
    }
}

}  // namespace
}  // namespace petzval::integrator
