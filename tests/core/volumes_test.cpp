// SPDX-License-Identifier: Apache-2.0
// Which volumes are closed, their ranks, and the set that a point lies in.
#include "core/scene/volumes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/volume_ranks.h"
#include "tests/support/scenes.h"

namespace petzval {
namespace {

using test::append;
using test::box;
using test::diffuse_material;
using test::glass_material;
using test::place;
using test::quad;
using test::sphere;

Material named(const char* name, Material m = glass_material(1.5f)) {
    m.name = name;
    return m;
}

uint32_t priority(const Scene& scene, const char* name) {
    for (const Material& m : scene.materials)
        if (m.name == name) return m.priority;
    throw std::runtime_error("no such material");
}

Mesh turned_inside_out(Mesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TEST(Volumes, TheHighestPriorityFillsSpace) {
    Material low = glass_material(1.3f), high = glass_material(1.5f), open = glass_material(1.1f);
    low.priority = 1;
    high.priority = 2;
    Volumes v;
    EXPECT_EQ(v.filling(), nullptr);
    v.cross(open, true);
    EXPECT_EQ(v.filling(), &open);
    v.cross(high, true);
    EXPECT_EQ(v.filling(), &high);
    v.cross(low, true);
    EXPECT_EQ(v.filling(), &high);
    v.cross(high, false);
    EXPECT_EQ(v.filling(), &low);
    v.cross(low, false);
    EXPECT_EQ(v.filling(), &open);
    v.cross(open, false);
    EXPECT_EQ(v, Volumes());
}

TEST(Volumes, TheOrderOfCrossingsDoesNotMatter) {
    std::array<Material, 5> m;
    for (uint32_t i = 0; i < 5; ++i) m[i].priority = i + 1;
    std::array<size_t, 5> order{0, 1, 2, 3, 4};
    Volumes due;
    for (const size_t i : order) due.cross(m[i], true);
    do {
        Volumes v;
        for (const size_t i : order) v.cross(m[i], true);
        EXPECT_EQ(v, due);
        EXPECT_EQ(v.filling(), &m[4]);
        for (const size_t i : order) v.cross(m[i], false);
        EXPECT_EQ(v, Volumes());
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Volumes, WhatIsEnteredTwiceIsLeftTwice) {
    Material m;
    m.priority = 1;
    m.overlaps_itself = true;
    Volumes v;
    for (int i = 0; i < 2; ++i) {
        v.correct(m, true);
        v.cross(m, true);
    }
    v.cross(m, false);
    EXPECT_EQ(v.filling(), &m);
    v.cross(m, false);
    EXPECT_EQ(v.filling(), nullptr);
    v.cross(m, false);  // never below 0
    v.cross(m, true);
    EXPECT_EQ(v.filling(), &m);
}

TEST(Volumes, TheSideOfArrivalCorrects) {
    Material m, twice;
    m.priority = 1;
    twice.priority = 2;
    twice.overlaps_itself = true;
    Volumes v;
    v.correct(m, false);
    EXPECT_EQ(v.filling(), &m);
    v.correct(m, true);  // it cannot be inside of what it meets from outside
    EXPECT_EQ(v.filling(), nullptr);
    v.correct(twice, false);
    v.correct(twice, true);  // it can: another body of the same material
    EXPECT_EQ(v.filling(), &twice);
}

TEST(Volumes, OfMoreThanEightTheLowestIsForgotten) {
    std::array<Material, 10> m;
    for (uint32_t i = 0; i < 10; ++i) m[i].priority = i + 1;
    for (const bool rising : {false, true}) {
        Volumes v;
        for (size_t i = 0; i < 10; ++i) v.cross(m[rising ? i : 9 - i], true);
        for (size_t i = 9; i >= 2; --i) {
            EXPECT_EQ(v.filling(), &m[i]);
            v.cross(m[i], false);
        }
        EXPECT_EQ(v.filling(), nullptr);
    }
}

TEST(VolumeRanks, TheSmallerVolumeHasTheHigherPriority) {
    for (const bool reversed : {false, true}) {
        Scene scene;
        std::vector<std::pair<const char*, Mesh>> things;
        things.emplace_back("ice", box(V3f(-1), V3f(1)));
        things.emplace_back("whisky", sphere(V3f(0), 2, 12, false));
        things.emplace_back("sea", box(V3f(-9), V3f(9)));
        if (reversed) std::reverse(things.begin(), things.end());
        for (const auto& [name, mesh] : things) place(scene, mesh, named(name));
        place(scene, box(V3f(-20), V3f(20)), named("wall", diffuse_material(0.5f)));
        finish_scene(scene);
        EXPECT_EQ(priority(scene, "sea"), 1u);
        EXPECT_EQ(priority(scene, "whisky"), 2u);
        EXPECT_EQ(priority(scene, "ice"), 3u);
        EXPECT_EQ(priority(scene, "wall"), 0u);
        EXPECT_TRUE(scene.volumes_meet);
        for (const Material& m : scene.materials) {
            EXPECT_FALSE(m.overlaps_itself) << m.name;
            EXPECT_EQ(m.volume_fault, VolumeFault::None) << m.name;
        }
    }
}

// Of equal volumes the place decides, in whatever order they come.
TEST(VolumeRanks, EqualVolumesAreRankedAlikeInAnyOrder) {
    for (const bool reversed : {false, true}) {
        Scene scene;
        const auto left = [&] { place(scene, box(V3f(-1), V3f(1)), named("left")); };
        const auto right = [&] { place(scene, box(V3f(0, -1, -1), V3f(2, 1, 1)), named("right")); };
        if (reversed)
            right(), left();
        else
            left(), right();
        finish_scene(scene);
        EXPECT_GT(priority(scene, "right"), priority(scene, "left"));
    }
}

// A thousand cubes of ice hold more than the glass, and yet each is the smaller body.
TEST(VolumeRanks, TheLargestBodyCountsNotTheirSum) {
    Scene scene;
    Mesh cubes;
    for (int i = 0; i < 40; ++i) append(cubes, box(V3f(3 * i), V3f(3 * i + 1)));
    place(scene, cubes, named("ice"));
    place(scene, box(V3f(-1), V3f(2)), named("water"));
    finish_scene(scene);
    EXPECT_GT(priority(scene, "ice"), priority(scene, "water"));
}

TEST(VolumeRanks, NothingNestsWhereNoBodiesMeet) {
    Scene scene;
    place(scene, box(V3f(-1), V3f(1)), named("a"));
    place(scene, box(V3f(1.5f, -1, -1), V3f(3, 1, 1)), named("b"));
    finish_scene(scene);
    EXPECT_FALSE(scene.volumes_meet);
    EXPECT_EQ(priority(scene, "b"), 2u);  // closed all the same

    Scene touching;
    place(touching, box(V3f(-1), V3f(1)), named("a"));
    place(touching, box(V3f(1, -1, -1), V3f(3, 1, 1)), named("b"));
    place(touching, box(V3f(50), V3f(51)), named("far"));
    finish_scene(touching);
    EXPECT_TRUE(touching.volumes_meet);
}

TEST(VolumeRanks, BodiesOfOneMaterialThatMeetMayOverlap) {
    Scene scene;
    Mesh two = box(V3f(-1), V3f(1));
    append(two, box(V3f(0), V3f(2)));
    place(scene, two, named("ice"));
    finish_scene(scene);
    EXPECT_TRUE(scene.volumes_meet);
    EXPECT_TRUE(scene.materials[0].overlaps_itself);
}

// Halves of a ball in two meshes of one material, under matrices, one of them mirrored.
TEST(VolumeRanks, PartsOfOneMaterialCloseEachOther) {
    Scene scene;
    Mesh half = sphere(V3f(0), 1, 12, false);
    std::erase_if(half.triangles, [&](const auto& t) {
        return half.positions[t[0]].y + half.positions[t[1]].y + half.positions[t[2]].y < 0;
    });
    place(scene, half, named("glass"));
    EXPECT_TRUE(scene.materials.size() == 1);
    finish_scene(scene);
    EXPECT_EQ(scene.materials[0].priority, 0u);
    EXPECT_EQ(scene.materials[0].volume_fault, VolumeFault::Open);

    Instance lower;
    lower.identity = false;
    lower.flips = true;
    lower.to_world = M44f(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    lower.to_local = linear_part(lower.to_world);
    scene.instances.push_back(lower);
    rank_volumes(scene);
    EXPECT_EQ(scene.materials[0].priority, 1u);
    EXPECT_EQ(scene.materials[0].volume_fault, VolumeFault::None);
}

TEST(VolumeRanks, InstancesAreAsLargeAsTheyArePlaced) {
    Scene scene;
    place(scene, box(V3f(-1), V3f(1)), named("large"));
    place(scene, box(V3f(-2), V3f(2)), named("small"));
    Instance& scaled = scene.instances[1];
    scaled.identity = false;
    scaled.to_world = M44f(0.1f, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 1);
    scaled.to_local = linear_part(scaled.to_world.inverse());
    finish_scene(scene);
    EXPECT_GT(priority(scene, "small"), priority(scene, "large"));
}

// The two ends of a seam, rounded apart: sin(2 pi) is not 0 in floats.
TEST(VolumeRanks, SeamsThatAreRoundedApartAreClosed) {
    Mesh ball;
    const int rows = 16, columns = 32;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
            const float theta = kPi * float(i) / rows, phi = 2 * kPi * float(j) / columns;
            ball.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                        -std::sin(theta) * std::sin(phi));
        }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (columns + 1) + j); };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            ball.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            ball.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    ASSERT_NE(ball.positions[at(5, 0)], ball.positions[at(5, columns)]);
    Scene scene;
    place(scene, ball, named("ball"));
    finish_scene(scene);
    EXPECT_EQ(scene.materials[0].priority, 1u);
}

TEST(VolumeRanks, FaultsAreNamed) {
    const auto fault = [](const Mesh& mesh, Material m = named("m")) {
        Scene scene;
        place(scene, mesh, m);
        finish_scene(scene);
        const VolumeFault found = scene.materials[0].volume_fault;
        EXPECT_EQ(scene.materials[0].priority == 0, found != VolumeFault::None);
        return found;
    };
    Mesh holed = box(V3f(-1), V3f(1));
    EXPECT_EQ(fault(holed), VolumeFault::None);
    holed.triangles.pop_back();
    EXPECT_EQ(fault(holed), VolumeFault::Open);
    EXPECT_EQ(fault(quad(V3f(0), V3f(1, 0, 0), V3f(0, 1, 0))), VolumeFault::Open);
    EXPECT_EQ(fault(turned_inside_out(box(V3f(-1), V3f(1)))), VolumeFault::InsideOut);
    // One of two bodies, though both together hold a positive volume.
    Mesh two = box(V3f(-1), V3f(1));
    append(two, turned_inside_out(box(V3f(3), V3f(4))));
    EXPECT_EQ(fault(two), VolumeFault::InsideOut);
    // A cavity faces into itself.
    Mesh hollow = box(V3f(-1), V3f(1));
    append(hollow, turned_inside_out(box(V3f(-0.5f), V3f(0.5f))));
    EXPECT_EQ(fault(hollow), VolumeFault::None);
    // No thickness: two faces back to back.
    Mesh pane = quad(V3f(0), V3f(1, 0, 0), V3f(0, 1, 0));
    append(pane, turned_inside_out(pane));
    EXPECT_EQ(fault(pane), VolumeFault::Flat);
    Material cutout = named("cutout");
    for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
        cutout.alpha_mode = mode;
        cutout.alpha = 1;
        EXPECT_EQ(fault(box(V3f(-1), V3f(1)), cutout), VolumeFault::None);
        cutout.alpha = 0.4f;
        EXPECT_EQ(fault(box(V3f(-1), V3f(1)), cutout), VolumeFault::Holes);
    }
}

TEST(VolumeRanks, ClosedBodiesOfThinGlassAreMarked) {
    const auto marked = [](const Mesh& mesh, Material m) {
        m.has_volume = false;
        Scene scene;
        place(scene, mesh, m);
        place(scene, box(V3f(5), V3f(6)), named("solid"));
        finish_scene(scene);
        EXPECT_EQ(scene.materials[0].volume_fault, VolumeFault::None);
        EXPECT_EQ(scene.materials[0].priority, 0u);
        EXPECT_FALSE(scene.materials[1].thin_body);
        return scene.materials[0].thin_body;
    };
    const Mesh closed = box(V3f(-1), V3f(1));
    EXPECT_TRUE(marked(closed, named("m")));
    EXPECT_TRUE(marked(turned_inside_out(closed), named("m")));
    Mesh open = closed;
    open.triangles.pop_back();
    EXPECT_FALSE(marked(open, named("m")));
    // A body beside a pane in one mesh, on either side of it.
    const Mesh pane = quad(V3f(3, 0, 0), V3f(4, 0, 0), V3f(3, 1, 0));
    for (const bool first : {false, true}) {
        Mesh both = first ? pane : closed;
        append(both, first ? closed : pane);
        EXPECT_TRUE(marked(both, named("m")));
    }
    // A pane of two faces back to back holds nothing.
    Mesh two_faces = pane;
    append(two_faces, turned_inside_out(pane));
    EXPECT_FALSE(marked(two_faces, named("m")));

    Material m = named("m");
    m.roughness = 0.3f;
    EXPECT_TRUE(marked(closed, m)) << "frosted";
    m.meant_thin = true;
    EXPECT_FALSE(marked(closed, m));
    m = named("m");
    m.transmission = 0;
    EXPECT_FALSE(marked(closed, m)) << "opaque";
    m.transmission = 1;
    m.metallic = 1;
    EXPECT_FALSE(marked(closed, m)) << "metal";
    m.metallic = 0;
    m.alpha_mode = AlphaMode::Mask;
    m.alpha = 0.4f;
    EXPECT_FALSE(marked(closed, m)) << "nothing of it is there";
}

// Whatever the cells of the weld are: an edge whose ends are rounded apart, in many positions.
TEST(VolumeRanks, SeamsAreWeldedWhereverTheyLie) {
    for (int turn = 0; turn < 50; ++turn) {
        M44f m;
        m.setAxisAngle(V3f(0.3f, 0.8f, -0.5f), 0.13f * static_cast<float>(turn));
        Mesh ball = sphere(V3f(0), 1, 100, false);
        for (V3f& p : ball.positions) {
            V3f q;
            m.multVecMatrix(p, q);
            p = q;
        }
        // Every triangle with corners of its own, each off by up to 1e-6.
        Mesh soup;
        uint32_t n = 0;
        for (const auto& triangle : ball.triangles) {
            for (const uint32_t corner : triangle) {
                V3f p = ball.positions[corner];
                for (int i = 0; i < 3; ++i)
                    p[i] += 1e-6f * (to_unit_float(hash32(n, static_cast<uint32_t>(i))) - 0.5f);
                soup.positions.push_back(p);
                ++n;
            }
            soup.triangles.push_back({n - 3, n - 2, n - 1});
        }
        Scene scene;
        place(scene, soup, named("ball"));
        finish_scene(scene);
        EXPECT_EQ(scene.materials[0].volume_fault, VolumeFault::None) << turn;
        EXPECT_FALSE(scene.volumes_meet) << turn;
    }
}

}  // namespace
}  // namespace petzval
