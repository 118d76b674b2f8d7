// SPDX-License-Identifier: Apache-2.0
// Glass that moves while the shutter is open: which volumes hold a point at a time, and what may
// meet.
#include <gtest/gtest.h>

#include "integrator/path/boundary.h"
#include "integrator/path/start_volumes.h"
#include "tests/support/moving.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval::integrator {
namespace {

using namespace test;

/// Volumes that a path would begin in.
Volumes begun_in(const World& world, const V3f& p, float time) {
    return world.scene.may_be_in_volume(p) ? volumes_at(world.scene, *world.bvh, p, time)
                                           : Volumes{};
}

M44f at_place(const V3f& place) {
    return turned(V3f(0.f), place);
}

/// A ball of glass that flies along x from -reach to reach.
Mesh ball() {
    return sphere(V3f(0.f), 1, 16, false);
}

/// As a moving instance, as a mesh that deforms, and as half of each.
std::vector<World> flying_balls(float reach) {
    std::vector<World> out(3);
    const auto x = [&](float time) { return V3f(reach * (2 * time - 1), 0, 0); };
    place_moving(out[0].scene, ball(), glass_material(1.5f),
                 at_steps(3, [&](float time) { return at_place(x(time)); }));
    Mesh soft = ball(), half = ball();
    deform(soft, 3, [&](const V3f& p, float time) { return p + x(time); });
    place(out[1].scene, soft, glass_material(1.5f));
    deform(half, 3, [&](const V3f& p, float time) { return p + x(time) * 0.5f; });
    place_moving(out[2].scene, half, glass_material(1.5f),
                 at_steps(3, [&](float time) { return at_place(x(time) * 0.5f); }));
    for (World& world : out) world.finish();
    return out;
}

TEST(MovingVolumes, HoldAPointWhileTheyAreThere) {
    for (const float reach : {1.f, 5.f, 100.f})
        for (const World& world : flying_balls(reach)) {
            Random random(1);
            int inside = 0;
            for (int i = 0; i < 2000; ++i) {
                const float time = random.next();
                const V3f centre(reach * (2 * time - 1), 0, 0);
                const V3f p = centre + random.direction() * (2 * random.next());
                const float away = (p - centre).length();
                if (std::fabs(away - 1) < 0.05f) continue;  // facets
                Volumes due;
                if (away < 1) due.add(world.scene.materials[0], 1);
                ASSERT_TRUE(begun_in(world, p, time) == due) << reach << ' ' << p << ' ' << time;
                inside += away < 1;
            }
            EXPECT_GT(inside, 500);
            EXPECT_FALSE(world.scene.volumes_meet);
            EXPECT_EQ(world.scene.materials[0].volume_fault, VolumeFault::None);
        }
}

TEST(MovingVolumes, AFarFlightDoesNotMakeABodyFlat) {
    for (const World& world : flying_balls(5000)) {
        EXPECT_EQ(world.scene.materials[0].volume_fault, VolumeFault::None);
        EXPECT_GT(world.scene.materials[0].priority, 0);
    }
}

// Apart in the middle of the exposure, one within the other at its end.
TEST(MovingVolumes, MeetWhereTheyDoAtAnyTime) {
    for (const bool same_material : {false, true}) {
        World world;
        place(world.scene, sphere(V3f(6, 0, 0), 2, 16, false), glass_material(1.3f));
        place_moving(world.scene, ball(), glass_material(1.5f),
                     at_steps(2, [](float time) { return at_place(V3f(6 * time, 0, 0)); }));
        if (same_material) world.scene.meshes[1].material = 0;
        world.finish();
        EXPECT_TRUE(world.scene.volumes_meet);
        EXPECT_EQ(world.scene.materials[0].overlaps_itself, same_material);
        for (const auto& [time, holds] : {std::pair(0.f, 1), std::pair(0.99f, 2)}) {
            const V3f p(6 * time + 0.1f, 0.05f, 0.02f);
            Volumes due;
            due.add(world.scene.materials[same_material ? 0 : 1], 1);
            if (holds == 2) due.add(world.scene.materials[0], 1);
            EXPECT_TRUE(begun_in(world, p, time) == due) << time;
        }
    }
}

// Halves of a ball that close each other fly together.
TEST(MovingVolumes, HoldAPointWhereTwoOpenMeshesCloseEachOther) {
    World world;
    const auto flight = at_steps(5, [](float time) { return at_place(V3f(0, 8 * time - 4, 0)); });
    const Mesh whole = box(V3f(-1), V3f(1));
    for (const bool upper : {false, true}) {
        Mesh half = whole;
        half.triangles.assign(whole.triangles.begin() + (upper ? 6 : 0),
                              whole.triangles.begin() + (upper ? 12 : 6));
        place_moving(world.scene, half, glass_material(1.5f), flight);
    }
    world.scene.meshes[1].material = 0;
    world.finish();
    ASSERT_EQ(world.scene.materials[0].volume_fault, VolumeFault::None);
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const float time = random.next();
        const V3f within(1.8f * random.next() - 0.9f, 1.8f * random.next() - 0.9f, 0.3f);
        const V3f centre(0, 8 * time - 4, 0);
        Volumes due;
        EXPECT_TRUE(begun_in(world, centre + V3f(0, 2, 0), time) == due);
        due.add(world.scene.materials[0], 1);
        EXPECT_TRUE(begun_in(world, centre + within, time) == due) << time;
    }
}

// A ray that meets the edge between two triangles of a face crosses one face, wherever it is then.
TEST(MovingVolumes, FacesThatShareAnEdgeAreNeighboursAtAllTimes) {
    World world;
    place_moving(world.scene, box(V3f(-1), V3f(1)), glass_material(1.5f),
                 at_steps(5, [](float time) {
                     return turned(V3f(time, 2 * time, 0), V3f(9 * time, 0, 0));
                 }));
    world.finish();
    for (const float time : {0.f, 0.13f, 0.5f, 0.9f}) {
        // The diagonal leads from the first corner to the third one: of both triangles.
        const Hit one{V2f(0, 0.4f), 0, 0, time}, other{V2f(0.4f, 0), 0, 1, time};
        const V3f along(0.3f, 0.2f, -0.5f);
        const Surface a = make_surface(world.scene, along, one);
        const Surface b = make_surface(world.scene, along, other);
        ASSERT_LT((a.p - b.p).length(), 1e-5f);
        EXPECT_TRUE(boundary_detail::are_neighbours(world.scene, a, b)) << time;
        EXPECT_TRUE(boundary_detail::are_neighbours(world.scene, b, a)) << time;
        const Surface inside = make_surface(world.scene, along, {V2f(0.3f, 0.3f), 0, 1, time});
        EXPECT_FALSE(boundary_detail::are_neighbours(
            world.scene, make_surface(world.scene, along, {V2f(0.3f, 0.3f), 0, 0, time}), inside));
    }
}

}  // namespace
}  // namespace petzval::integrator
