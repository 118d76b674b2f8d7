// SPDX-License-Identifier: Apache-2.0
// Faces back to back: which of the two a ray meets, wherever and in whatever order they lie.
#include "integrator/path/front_at_back.h"

#include <gtest/gtest.h>

#include "tests/support/lamp.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval::integrator {
namespace {

using test::diffuse_material;
using test::placed;
using test::Random;
using Triangles = std::vector<std::array<uint32_t, 3>>;

const Mesh kSheet = test::quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0));  // faces +z

Material one_sided(float albedo = 0.5f) {
    Material m = diffuse_material(albedo);
    m.double_sided = false;
    return m;
}
Mesh reversed(Mesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}
M44f turned_about(float angle_rad, const V3f& axis) {
    M44f m;
    m.setAxisAngle(axis, angle_rad);
    return m;
}

// Whether rays that come anyhow to points of the sheet, grazing ones too, meet the side that faces
// them, and whether what leaves there meets nothing.
void expect_faces_rays(Scene scene, const M44f& to_world = {}) {
    test::World world;
    world.scene = std::move(scene);
    world.finish();
    Random random(3);
    for (int i = 0; i < 4000; ++i) {
        const V3f target = V3f(1.9f * random.next() - 0.95f, 1.9f * random.next() - 0.95f, 0);
        const V3f from(4 * random.next() - 2, 4 * random.next() - 2,
                       (i % 2 ? 1.f : -1.f) * (0.01f + 2 * random.next()));
        Ray ray;
        ray.origin = from * to_world;
        ray.direction = unit(target * to_world - ray.origin);
        const auto hit = world.bvh->intersect(ray);
        ASSERT_TRUE(hit) << from << target;
        Surface s = make_surface(world.scene, ray.direction, *hit);
        if (!s.front) {
            const auto front = front_at_back(world.scene, *world.bvh, ray, s);
            ASSERT_TRUE(front) << from << target;
            s = *front;
        }
        ASSERT_TRUE(s.front) << from << target;
        Ray back;
        back.direction = -ray.direction;
        back.origin = leave_surface(s, back.direction, false);
        ASSERT_FALSE(world.bvh->occluded(back)) << from << target;
    }
}

// Five orders in which a surface and its reversed copy may come.
class Order : public testing::TestWithParam<int> {
  protected:
    static Scene sheet(const M44f& to_world = {}) {
        Scene scene;
        const Triangles there = kSheet.triangles, back = reversed(kSheet).triangles;
        Mesh mesh = kSheet;
        switch (GetParam()) {
            case 0:
                mesh.triangles = {there[0], there[1], back[0], back[1]};
                break;
            case 1:
                mesh.triangles = {back[0], back[1], there[0], there[1]};
                break;
            case 2:
                mesh.triangles = {back[1], there[0], there[1], back[0]};
                break;
            default:
                mesh = reversed(kSheet);
        }
        for (V3f& p : mesh.positions) p = p * to_world;
        test::place(scene, mesh, one_sided());
        if (GetParam() < 3) return scene;
        test::place(scene, kSheet, one_sided());
        if (GetParam() == 4) scene.instances[1] = placed(1, to_world);
        if (GetParam() == 3)
            for (V3f& p : scene.meshes[1].positions) p = p * to_world;
        return scene;
    }
};

TEST_P(Order, ARayMeetsTheSideThatFacesIt) {
    expect_faces_rays(sheet());
}

TEST_P(Order, AnywhereInTheWorld) {
    for (int i = 0; i < 8; ++i) {
        M44f m = turned_about(0.7f + float(i), unit(V3f(1, -2, 0.5f)));
        const float far = std::pow(10.f, float(i - 4));
        for (int j = 0; j < 3; ++j) m[3][j] = far * float(j + 1);
        SCOPED_TRACE(i);
        expect_faces_rays(sheet(m), m);
    }
}

INSTANTIATE_TEST_SUITE_P(FrontAtBack, Order, testing::Range(0, 5));

// A half turn about an axis in the plane of the sheet, as a quaternion of a file makes it: nothing
// is rounded.
M44f half_turn(const V3f& axis) {
    M44f m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] = 2 * axis[i] * axis[j] / axis.dot(axis) - (i == j);
    return m;
}

// The back may be the same mesh, mirrored or turned: its corners are rounded otherwise, and
// its quads may be split along the other diagonal.
TEST(FrontAtBack, TheBackMayBeAnInstanceOfTheSameMesh) {
    M44f mirrored;
    mirrored.setScale(V3f(1, 1, -1));
    for (const M44f& back : {mirrored, half_turn(V3f(1, 1, 0)), half_turn(V3f(-1, 1, 0)),
                             half_turn(V3f(1, 0, 0)), half_turn(V3f(0, 1, 0))})
        for (float angle : {0.f, 0.3f, 2.f})
            for (const bool back_first : {false, true}) {
                M44f m = turned_about(angle, unit(V3f(1, 2, 3)));
                for (int j = 0; j < 3; ++j) m[3][j] = angle * float(j);
                Scene scene;
                test::place(scene, kSheet, one_sided());
                scene.instances = {placed(0, m), placed(0, back * m)};
                if (back_first) std::swap(scene.instances[0], scene.instances[1]);
                expect_faces_rays(scene, m);
            }
}

// Where coordinates have a size, rounding to them leaves room for light that leaves.
TEST(FrontAtBack, CopiesThatAreRoundedOtherwiseAreFound) {
    M44f up;
    up[3][2] = 1;
    for (const float apart : {-1e-6f, -1e-7f, 1e-7f, 1e-6f}) {
        Scene scene;
        Mesh there = kSheet, back = reversed(kSheet);
        for (V3f& p : there.positions) p.z = 1;
        for (V3f& p : back.positions) p.z = 1 + apart;
        test::place(scene, back, one_sided());
        test::place(scene, there, one_sided());
        SCOPED_TRACE(apart);
        expect_faces_rays(scene, up);
    }
}

// What lies a tenth of a millimetre behind a back of a metre is another surface.
TEST(FrontAtBack, NeighboursAreNoCopies) {
    test::World world;
    Mesh back = reversed(kSheet);
    test::place(world.scene, back, one_sided());
    Mesh behind = kSheet;
    for (V3f& p : behind.positions) p.z -= 1e-4f;
    test::place(world.scene, behind, one_sided());
    world.finish();
    const Ray down{V3f(0.2f, 0.3f, 1), V3f(0, 0, -1)};
    const auto hit = world.bvh->intersect(down);
    ASSERT_TRUE(hit);
    const Surface s = make_surface(world.scene, down.direction, *hit);
    ASSERT_TRUE(culled_from_view(s));
    EXPECT_FALSE(front_at_back(world.scene, *world.bvh, down, s));
}

TEST(FrontAtBack, ClosedMeshesHaveNone) {
    test::World world;
    test::place(world.scene, test::sphere(V3f(100, 0, 0), 1, 40, true), one_sided());
    world.finish();
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const Ray out{V3f(100, 0, 0), random.direction()};
        const auto hit = world.bvh->intersect(out);
        ASSERT_TRUE(hit);
        const Surface s = make_surface(world.scene, out.direction, *hit);
        EXPECT_FALSE(front_at_back(world.scene, *world.bvh, out, s));
    }
}

// Where a side is a hole the ray meets nothing: the other side is its own back.
TEST(FrontAtBack, AHoleIsNoFront) {
    test::World world;
    Material hole = one_sided();
    hole.alpha_mode = AlphaMode::Mask;
    hole.alpha = 0;
    test::place(world.scene, reversed(kSheet), one_sided());
    test::place(world.scene, kSheet, hole);
    world.finish();
    const Ray down{V3f(0.2f, 0.3f, 1), V3f(0, 0, -1)};
    const auto hit = world.bvh->intersect(down);
    ASSERT_TRUE(hit);
    const Surface s = make_surface(world.scene, down.direction, *hit);
    EXPECT_TRUE(culled_from_view(s));
    EXPECT_FALSE(front_at_back(world.scene, *world.bvh, down, s));
}

}  // namespace
}  // namespace petzval::integrator
