// SPDX-License-Identifier: Apache-2.0
// Surfaces of two faces back to back: what is seen of them, and the light that arrives, against
// single sheets.
#include <gtest/gtest.h>

#include "tests/integrator/path_estimate.h"
#include "tests/support/scenes.h"

namespace petzval::integrator {
namespace {

using test::bundle;
using test::estimate;
using test::Mean;
using test::World;

Mesh thick_sheet(bool faces_camera, float z = 0, float size = 2) {
    Mesh mesh = test::quad(V3f(-size / 2, -size / 2, z), V3f(size, 0, 0), V3f(0, size, 0));
    if (!faces_camera)
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

Material one_sided_sheet(float albedo, float nits = 0) {
    Material m = test::emitter_material(nits, albedo);
    m.double_sided = false;
    return m;
}

void add(World& world, bool back_first, const Material& front, const Material& back) {
    if (back_first) test::place(world.scene, thick_sheet(false), back);
    test::place(world.scene, thick_sheet(true), front);
    if (!back_first) test::place(world.scene, thick_sheet(false), back);
}

class Sheets : public testing::TestWithParam<bool> {};

TEST_P(Sheets, EachSideShowsItsMaterial) {
    World world;
    world.scene.sky = Sky::uniform(Rgb(1.f));
    add(world, GetParam(), one_sided_sheet(0.5f), one_sided_sheet(0.2f));
    world.finish();
    PathOptions options;
    options.transparent = true;
    float alpha = 0;
    test::expect_agrees(estimate(world, options, 64, bundle, &alpha), 0.5, "front");
    EXPECT_NEAR(alpha, 1.f, 1e-5f);
    const auto from_behind = [](V2f u) {
        return test::ray_to(V3f(0, 0, -4), V3f(u.x - 0.5f, u.y - 0.5f, 0));
    };
    test::expect_agrees(estimate(world, options, 64, from_behind), 0.2, "back");
}

// A lamp of two sides, each of a brightness of its own, lights a wall before it: as the side alone.
TEST_P(Sheets, LampsShineFromTheSideThatFaces) {
    const auto wall_under = [&](bool paired) {
        World world;
        test::place(world.scene, thick_sheet(true, -1.f, 6), one_sided_sheet(0.5f));
        const Material down = one_sided_sheet(0, 3), up = one_sided_sheet(0, 7);
        if (paired)
            add(world, GetParam(), up, down);
        else
            test::place(world.scene, thick_sheet(false), down);
        world.finish();
        const auto at_wall = [](V2f u) {
            return test::ray_to(V3f(2.5f, 0, 0), V3f(u.x - 0.5f, u.y - 0.5f, -1.f));
        };
        return test::expect_techniques_agree(world, {}, 512, at_wall, 0.02);
    };
    const Mean alone = wall_under(false), pair = wall_under(true);
    EXPECT_TRUE(test::agrees(pair - alone, 0)) << pair << " and " << alone;
    EXPECT_LT(pair.error, 0.01 * pair.value);
}

// Both stop light: behind a sheet there is none.
TEST_P(Sheets, NoLightPassesThem) {
    World world;
    test::place(world.scene, thick_sheet(true, -1.f, 1), one_sided_sheet(0.5f));
    world.scene.lights.push_back(PointLight{V3f(0, 0, 1), Rgb(1.f)});
    add(world, GetParam(), one_sided_sheet(0.5f), one_sided_sheet(0.2f));
    world.finish();
    const auto at_wall = [](V2f u) {
        return test::ray_to(V3f(0, -3.f, -0.5f), V3f(u.x * 0.2f, u.y * 0.2f, -1.f));
    };
    EXPECT_EQ(estimate(world, {}, 64, at_wall).value, 0);
}

// Half of the rays pass a sheet of BLEND 0.5, as those of a sheet without a back.
TEST_P(Sheets, BlendCountsOnce) {
    World world;
    world.scene.sky = Sky::uniform(Rgb(1.f));
    Material half = one_sided_sheet(0.f);
    half.alpha_mode = AlphaMode::Blend;
    half.alpha = 0.5f;
    add(world, GetParam(), half, half);
    world.finish();
    const Mean seen = estimate(world, {}, 2048, bundle);
    EXPECT_TRUE(test::agrees(seen, 0.5, 0.01)) << seen;
}

INSTANTIATE_TEST_SUITE_P(BackFirst, Sheets, testing::Bool());

}  // namespace
}  // namespace petzval::integrator
