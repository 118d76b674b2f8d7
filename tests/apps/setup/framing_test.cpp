// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/framing.h"

#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "core/sampling/warp.h"
#include "tests/support/lamp.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

using test::diffuse_material;
using test::place;
using test::quad;

/// The twelve sides of a box.
Scene scene_with_box(V3f low, V3f high) {
    Scene scene;
    const V3f s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
    for (const auto& [corner, a, b] :
         {std::array{low, x, y}, std::array{low, x, z}, std::array{low, y, z},
          std::array{high, -x, -y}, std::array{high, -x, -z}, std::array{high, -y, -z}})
        place(scene, quad(corner, a, b), diffuse_material(0.5f));
    finish_scene(scene);
    return scene;
}

struct Covered {
    float left = 2, right = -2, bottom = 2, top = -2;  ///< -1 and 1: the picture's sides

    [[nodiscard]] float most() const { return std::max({-left, right, -bottom, top}); }
};

/// Part of the picture that a scene covers, through a pinhole at the frame's place.
Covered covered(const Scene& scene, const std::array<V3f, 2>& aim, float yfov_rad, float aspect) {
    const M44f to_camera = camera::look_at(aim[0], aim[1]).inverse();
    const float slope = std::tan(yfov_rad / 2);
    Covered out;
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
        for (uint32_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); ++t)
            for (const V3f& corner : triangle_corners(scene, i, t)) {
                const V3f p = corner * to_camera;
                EXPECT_LT(p.z, 0) << "behind the camera";
                const float x = p.x / (-p.z * slope * aspect), y = p.y / (-p.z * slope);
                out.left = std::min(out.left, x);
                out.right = std::max(out.right, x);
                out.bottom = std::min(out.bottom, y);
                out.top = std::max(out.top, y);
            }
    return out;
}

// Instances inside others are not looked at triangle by triangle: it must make no difference.
TEST(Framing, InstancesAreFramedLikeTheirCopiesInTheWorld) {
    test::Random random(5);
    for (int round = 0; round < 20; ++round) {
        Scene many, copies;
        const Mesh ball = test::sphere(V3f(0.2f, 0, 0), 1.f, 5, false);
        place(many, ball, diffuse_material(0.5f));
        many.instances.clear();
        for (int i = 0; i < 200; ++i) {
            M44f m;
            m.setScale(V3f(random.next(), random.next(), random.next() + 0.1f));
            for (int j = 0; j < 3; ++j)
                m[3][j] = (random.next() - 0.5f) * (j == round % 3 ? 1.f : 30.f);
            many.instances.push_back(test::placed(0, m));
            Mesh copy = ball;
            for (V3f& p : copy.positions) p = p * m;
            place(copies, copy, diffuse_material(0.5f));
        }
        finish_scene(many);
        finish_scene(copies);
        const auto one = frame_scene(many, 0.7f, 1.5f, 0),
                   other = frame_scene(copies, 0.7f, 1.5f, 0);
        ASSERT_TRUE(one && other);
        EXPECT_EQ((*one)[0], (*other)[0]) << round;
        EXPECT_EQ((*one)[1], (*other)[1]) << round;
    }
}

struct Case {
    V3f low, high;
    float fov_deg, aspect;
};

TEST(Framing, TouchesTheMarginsOnOppositeSides) {
    const std::vector<Case> cases = {
        {{-1, -1, -1}, {1, 1, 1}, 40, 16 / 9.f},
        {{-1, -1, -1}, {1, 1, 1}, 40, 9 / 16.f},       // portrait
        {{0, 0, 0}, {0.01f, 3, 0.01f}, 40, 16 / 9.f},  // a rod that stands
        {{0, 0, 0}, {0.01f, 3, 0.01f}, 40, 9 / 16.f},
        {{0, 0, 0}, {5, 0.01f, 0.01f}, 40, 16 / 9.f},  // and one that lies across
        {{0, 0, 0}, {5, 0.01f, 0.01f}, 40, 9 / 16.f},
        {{-3, 0, -2}, {3, 0, 2}, 40, 16 / 9.f},      // a floor
        {{0, -3, -2}, {0, 3, 2}, 40, 16 / 9.f},      // a wall, edge-on from the front
        {{99, 200, -301}, {101, 201, -300}, 20, 1},  // far from the origin
        {{-1e-3f, 0, 0}, {1e-3f, 1e-3f, 2e-3f}, 90, 2},
        {{-1e3f, 0, 0}, {1e3f, 1e3f, 2e3f}, 10, 0.4f}};
    for (const Case& c : cases) {
        const Scene scene = scene_with_box(c.low, c.high);
        const float yfov_rad = c.fov_deg * kPi / 180;
        const auto aim = frame_scene(scene, yfov_rad, c.aspect, 0);
        ASSERT_TRUE(aim);
        const Covered of = covered(scene, *aim, yfov_rad, c.aspect);
        EXPECT_NEAR(of.most(), 0.94f, 1e-3f) << c.high;
        const bool wide = of.right - of.left > of.top - of.bottom;
        EXPECT_NEAR(wide ? of.left + of.right : of.bottom + of.top, 0, 2e-3f) << c.high;
    }
}

TEST(Framing, ShowsTheBroadSideOfWhatIsFlat) {
    const auto area = [](const V3f& low, const V3f& high) {
        const Scene scene = scene_with_box(low, high);
        const Covered of = covered(scene, *frame_scene(scene, 0.7f, 1, 0), 0.7f, 1);
        return (of.right - of.left) * (of.top - of.bottom) / 4;
    };
    EXPECT_GT(area({-1, -1, 0}, {1, 1, 0}), 0.6f);
    EXPECT_GT(area({0, -1, -1}, {0, 1, 1}), 0.6f);
    EXPECT_GT(area({-1, 0, -1}, {1, 0, 1}), 0.4f);
}

// A board that leans any way is seen from where it is broad, though its bounds are those of a cube.
TEST(Framing, ShowsTheBroadSideOfWhatLeans) {
    test::Random random(4);
    for (int i = 0; i < 200; ++i) {
        const V3f normal = uniform_sphere(random.next2());
        const V3f a = normal.cross(V3f(0.6f, 0.8f, 0)).normalized();
        Scene scene;
        place(scene, quad(-a, a * 2, normal.cross(a) * 3), diffuse_material(0.5f));
        place(scene, quad(-a + normal * 0.1f, normal.cross(a), a), diffuse_material(0.5f));
        finish_scene(scene);
        const auto aim = frame_scene(scene, 0.7f, 1, 0);
        ASSERT_TRUE(aim);
        EXPECT_GT(std::fabs(((*aim)[0] - (*aim)[1]).normalized().dot(normal)), 0.4f) << normal;
    }
}

TEST(Framing, WidestViewsAndPoints) {
    const Scene scene = scene_with_box({-1, -1, -1}, {1, 1, 1});
    for (const float fov_deg : {120.f, 179.f}) {
        const float yfov_rad = fov_deg * kPi / 180;
        const Covered of = covered(scene, *frame_scene(scene, yfov_rad, 1, 0), yfov_rad, 1);
        EXPECT_LT(of.most(), 0.94f);
    }
    const auto point = frame_scene(scene_with_box({1, 2, 3}, {1, 2, 3}), 0.7f, 1, 0);
    ASSERT_TRUE(point);
    EXPECT_NE((*point)[0], (*point)[1]);
    EXPECT_TRUE(frame_scene(Scene(), 0.7f, 1, 0));
    EXPECT_FALSE(frame_scene(scene_with_box({0, 0, 0}, {1e17f, 1, 1}), 0.7f, 1, 0));
}

TEST(Framing, StandsBackForALensThatIsFocusedNear) {
    const Scene scene = scene_with_box({-1, -1, -1}, {1, 1, 1});
    const auto near = frame_scene(scene, 0.7f, 1, 0), far = frame_scene(scene, 0.7f, 1, 0.5);
    EXPECT_NEAR(((*far)[0] - (*near)[0]).length(), 0.5f, 1e-5f);
    EXPECT_LT(((*far)[1] - (*near)[1]).length(), 1e-5f);
}

}  // namespace
}  // namespace petzval::apps
