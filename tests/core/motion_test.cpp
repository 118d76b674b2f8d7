// SPDX-License-Identifier: Apache-2.0
// What rays meet of things that move, against triangles whose corners are moved by hand in double.
#include "core/scene/motion.h"

#include <gtest/gtest.h>

#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "tests/support/moving.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using namespace test;

/// A body that turns once and a quarter while it flies.
M44f spin(float time) {
    return turned(V3f(0.4f, 7.9f * time, 0.2f), V3f(3 * time - 1.5f, time * time, 0.3f),
                  V3f(1, 0.6f, 1.3f));
}
V3f bend(const V3f& p, float time) {
    return {p.x + 0.5f * time * p.y * p.y, p.y * (1 + time), p.z + std::sin(3 * time) * p.x};
}

struct Moving {
    const char* name;
    Scene scene;
};

/// A moving instance beside still ones, a mesh that deforms, both together, and many steps.
std::vector<Moving> moving_scenes() {
    std::vector<Moving> out;
    for (const size_t steps : {2, 5, 129}) {
        Scene instance, deforming, both;
        place(instance, quad(V3f(-9, -3, -9), V3f(0, 0, 18), V3f(18, 0, 0)), diffuse_material(1));
        place_moving(instance, sphere(V3f(0.f), 1, 8, true), diffuse_material(1),
                     at_steps(steps, spin));
        instance.instances.push_back(instance.instances.back());  // one that stands still
        instance.instances.back().moves = false;
        place_moving(instance, 1, at_steps(std::min<size_t>(steps + 1, 129), [](float time) {
                         return turned(V3f(time), V3f(0, 2 + time, 0), V3f(-1, 1, 1));
                     }));
        Mesh soft = sphere(V3f(0.5f, 0, 0), 1, 8, true);
        deform(soft, steps, bend,
               [](const V3f& n, float time) { return unit(n + V3f(0.3f * time, 0, 0)); });
        place(deforming, soft, diffuse_material(1));
        place_moving(both, soft, diffuse_material(1),
                     at_steps(std::min<size_t>(2 * steps, 128), spin));
        out.push_back({"a moving instance", std::move(instance)});
        out.push_back({"a deforming mesh", std::move(deforming)});
        out.push_back({"both", std::move(both)});
    }
    for (Moving& moving : out) finish_scene(moving.scene);
    return out;
}

struct Met {
    uint32_t instance, triangle;
    double distance;
    double edge;  ///< least of the three weights
    V3d weights;
};

/// All triangles that a ray meets at its time, the nearest first.
std::vector<Met> all_met(const Scene& scene, const Ray& ray) {
    std::vector<Met> out;
    const V3d origin(ray.origin), d(ray.direction);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = corners_at(scene, i, t, double(ray.time));
            const V3d e1 = b - a, e2 = c - a, s = origin - a, p = d.cross(e2), q = s.cross(e1);
            const double determinant = e1.dot(p);
            if (determinant == 0) continue;
            const double u = s.dot(p) / determinant, v = d.dot(q) / determinant;
            const double along = e2.dot(q) / determinant, edge = std::min({u, v, 1 - u - v});
            if (edge > -1e-4 && along > 0) out.push_back({i, t, along, edge, V3d(1 - u - v, u, v)});
        }
    }
    std::sort(out.begin(), out.end(),
              [](const Met& a, const Met& b) { return a.distance < b.distance; });
    return out;
}

Ray ray_through(Random& random) {
    Ray ray;
    ray.origin = random.direction() * 6.f;
    ray.direction = unit(random.direction() * (2 * random.next()) - ray.origin);
    ray.time = random.next();
    return ray;
}

TEST(Motion, RaysMeetWhatIsThereAtTheirTime) {
    for (const auto& [name, scene] : moving_scenes()) {
        const Bvh bvh(scene, Traversal::Robust);
        Random random(1);
        int hits = 0, misses = 0;
        for (int i = 0; i < 1500; ++i) {
            const Ray ray = ray_through(random);
            const std::vector<Met> met = all_met(scene, ray);
            const auto hit = bvh.intersect(ray);
            if (met.empty()) {
                ASSERT_FALSE(hit) << name;
                ASSERT_FALSE(bvh.occluded(ray)) << name;
                ++misses;
                continue;
            }
            // Where the ray meets an edge, or two triangles nearly together, both are right.
            if (met[0].edge < 1e-4 || (met.size() > 1 && met[1].distance < 1e-4 + met[0].distance))
                continue;
            ASSERT_TRUE(hit) << name;
            ASSERT_TRUE(bvh.occluded(ray)) << name;
            ASSERT_EQ(hit->instance, met[0].instance) << name;
            ASSERT_EQ(hit->triangle, met[0].triangle) << name;
            ASSERT_EQ(hit->time, ray.time);
            ASSERT_NEAR(double(hit->barycentric.x), met[0].weights[1], 2e-5) << name;
            ASSERT_NEAR(double(hit->barycentric.y), met[0].weights[2], 2e-5) << name;
            ++hits;
            Ray before = ray, behind = ray;
            before.t_max = static_cast<float>(met[0].distance) - 1e-3f;
            behind.t_max = static_cast<float>(met[0].distance) + 1e-3f;
            ASSERT_FALSE(bvh.occluded(before)) << name;
            ASSERT_TRUE(bvh.occluded(behind)) << name;
        }
        EXPECT_GT(hits, 200) << name;
        EXPECT_GT(misses, 100) << name;
    }
}

V3d unit_of(const V3d& v) {
    return v / v.length();
}

/// Shading normal of the file at a point of a triangle, brought to the world by the inverse
/// transpose.
V3d smooth_normal(const Scene& scene, const Hit& hit) {
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    V3d sum(0.);
    const double w[3] = {1 - double(hit.barycentric.x) - double(hit.barycentric.y),
                         double(hit.barycentric.x), double(hit.barycentric.y)};
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t corner = mesh.triangles[hit.triangle][k];
        V3d n(mesh.normals[corner]);
        if (!mesh.steps.empty()) {
            const auto [before, share] = place_of_time(double(hit.time), mesh.steps.size());
            n = V3d(mesh.steps[before].normals[corner]) * (1 - share) +
                V3d(mesh.steps[before + 1].normals[corner]) * share;
        }
        sum += n * w[k];
    }
    V3d out;
    matrix_at(scene, hit.instance, double(hit.time)).inverse().transposed().multDirMatrix(sum, out);
    return unit_of(out);
}

TEST(Motion, SurfacesHaveTheGeometryOfTheirTime) {
    for (const auto& [name, scene] : moving_scenes()) {
        const Bvh bvh(scene, Traversal::Robust);
        Random random(2);
        for (int i = 0; i < 1500; ++i) {
            const Ray ray = ray_through(random);
            const auto hit = bvh.intersect(ray);
            if (!hit) continue;
            const Surface s = make_surface(scene, ray.direction, *hit);
            const auto [a, b, c] =
                corners_at(scene, hit->instance, hit->triangle, double(ray.time));
            const double u = double(hit->barycentric.x), v = double(hit->barycentric.y);
            const V3d p = a * (1 - u - v) + b * u + c * v;
            for (int k = 0; k < 3; ++k)
                ASSERT_LE(std::fabs(double(s.p[k]) - p[k]), double(s.p_error[k])) << name;
            ASSERT_LT(s.p_error.length(), 1e-4f) << name;
            const bool mirrored = scene.instances[hit->instance].flips;
            const V3d n = unit_of((b - a).cross(c - a)) * (mirrored ? -1. : 1.);
            ASSERT_LT((V3d(s.ng) - n).length(), 1e-4) << name;
            ASSERT_EQ(s.front, ray.direction.dot(s.ng) < 0) << name;
            if (!s.mesh->normals.empty()) {
                V3d smooth = smooth_normal(scene, *hit);
                if (smooth.dot(n) < 0) smooth = -smooth;
                ASSERT_LT((V3d(s.ns) - smooth).length(), 1e-4) << name;
            }
            const auto corners = triangle_corners(scene, hit->instance, hit->triangle, ray.time);
            for (size_t k = 0; k < 3; ++k)
                ASSERT_LT((V3d(corners[k]) - std::array{a, b, c}[k]).length(), 1e-5) << name;
        }
    }
}

TEST(Motion, BoundsHoldAllCornersAtAllTimes) {
    for (const auto& [name, scene] : moving_scenes()) {
        Box3f all, bounds = scene.bounds;
        bounds.min -= V3f(1e-6f);  // between steps, corners are rounded
        bounds.max += V3f(1e-6f);
        for (int k = 0; k <= 400; ++k)
            for (uint32_t i = 0; i < scene.instances.size(); ++i) {
                const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
                for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
                    for (const V3f& corner : triangle_corners(scene, i, t, float(k) / 400)) {
                        ASSERT_TRUE(bounds.intersects(corner)) << name;
                        all.extendBy(corner);
                    }
            }
        EXPECT_LT((scene.bounds.size() - all.size()).length(), all.size().length()) << name;
    }
}

/// Things of a size of 1 that fly so far while the shutter is open, through the origin in its
/// middle.
std::vector<Moving> fast_scenes(float reach) {
    std::vector<Moving> out;
    const auto fly = [&](float time) { return V3f(2, -1, 0.5f) * (reach * (time - 0.5f)); };
    for (const size_t steps : {2, 4, 5}) {
        Scene instance, deforming, both;
        const Mesh ball = sphere(V3f(0.f), 1, 8, false);
        place_moving(instance, ball, diffuse_material(1), at_steps(steps, [&](float time) {
                         return turned(V3f(0, time, 0), fly(time), V3f(1, 0.7f, 1));
                     }));
        Mesh soft = ball;
        deform(soft, steps, [&](const V3f& p, float time) { return p + fly(time); });
        place(deforming, soft, diffuse_material(1));
        place_moving(both, soft, diffuse_material(1), at_steps(steps, [&](float time) {
                         return turned(V3f(0, time, 0), fly(time) * -1.f);
                     }));
        out.push_back({"a fast instance", std::move(instance)});
        out.push_back({"a fast deforming mesh", std::move(deforming)});
        out.push_back({"fast both ways", std::move(both)});
    }
    for (Moving& moving : out) finish_scene(moving.scene);
    return out;
}

struct Leaving {
    int hits = 0, own = 0, beyond = 0;
};

// Points on the surface, found by rays from afar and from within; rays leave to both sides.
Leaving leave(const Scene& scene, const Bvh& bvh, float spread, uint32_t seed) {
    Leaving count;
    Random random(seed);
    for (int i = 0; i < 20000; ++i) {
        const float time =
            i % 2 ? random.next() : std::clamp(0.5f + spread * (random.next() - 0.5f), 0.f, 1.f);
        const auto [a, b, c] = corners_at(scene, 0, static_cast<uint32_t>(i) % 112, double(time));
        const V2f w = random.next2();
        const V3f middle(a + (b - a) * double(w.x / 2) + (c - a) * double(w.y / 2));
        Ray ray;
        ray.direction = random.direction();
        ray.origin = middle - ray.direction * (i % 3 ? 3.f : 0.5f);
        ray.time = time;
        const auto hit = bvh.intersect(ray);
        if (!hit) continue;
        ++count.hits;
        const Surface s = make_surface(scene, ray.direction, *hit);
        const auto corner = corners_at(scene, hit->instance, hit->triangle, double(time));
        const double u = double(hit->barycentric.x), v = double(hit->barycentric.y);
        const V3d p = corner[0] * (1 - u - v) + corner[1] * u + corner[2] * v;
        for (int k = 0; k < 3; ++k)
            count.beyond += std::fabs(double(s.p[k]) - p[k]) > double(s.p_error[k]);
        const V3f away = random.direction();
        const bool transmitted = away.dot(s.facing()) < 0;
        Ray out;
        out.origin = leave_surface(s, away, transmitted);
        out.direction = away;
        out.time = time;
        const auto again = bvh.intersect(out);
        count.own += again && again->instance == hit->instance && again->triangle == hit->triangle;
    }
    return count;
}

TEST(Motion, RaysThatLeaveAThingInFlightDoNotMeetTheirOwnTriangle) {
    for (const float reach : {0.f, 1.f, 30.f, 1e3f, 3e4f, 1e5f})
        for (const auto& [name, scene] : fast_scenes(reach)) {
            const Bvh bvh(scene, Traversal::Robust);
            const Leaving count = leave(scene, bvh, 4 / std::max(reach, 4.f), 3);
            EXPECT_GT(count.hits, 5000) << name << ' ' << reach;
            EXPECT_EQ(count.own, 0) << name << ' ' << reach;
            EXPECT_EQ(count.beyond, 0) << name << ' ' << reach;
        }
}

TEST(Motion, RaysThatLeaveTurningAndBendingThingsDoNotMeetTheirOwnTriangle) {
    for (auto& [name, scene] : moving_scenes()) {
        if (scene.instances.size() > 1) continue;
        const Bvh bvh(scene, Traversal::Robust);
        const Leaving count = leave(scene, bvh, 1, 4);
        EXPECT_GT(count.hits, 5000) << name;
        EXPECT_EQ(count.own, 0) << name;
        EXPECT_EQ(count.beyond, 0) << name;
    }
}

TEST(Motion, StepsLieEvenlyFromTheFirstTimeToTheLast) {
    for (const size_t count : {2, 3, 9, 129}) {
        for (size_t i = 0; i < count; ++i) {
            const auto at = step_place(step_time(i, count), count);
            EXPECT_NEAR(double(at.before) + double(at.share), double(i), 1e-4);
        }
        EXPECT_EQ(step_place(0.f, count).before, 0u);
        EXPECT_EQ(step_place(0.f, count).share, 0.f);
        EXPECT_EQ(step_place(1.f, count).before, count - 2);
        EXPECT_EQ(step_place(1.f, count).share, 1.f);
        EXPECT_EQ(step_place(-1.f, count).before, 0u);
        EXPECT_EQ(step_place(2.f, count).share, 1.f);
    }
}

TEST(Motion, OnlyASceneThatMovesHasMotion) {
    for (const auto& [name, scene] : moving_scenes()) EXPECT_TRUE(has_motion(scene)) << name;
    Scene still;
    place(still, sphere(V3f(0.f), 1, 4, true), diffuse_material(1));
    still.lights = {PointLight{V3f(0.f), Rgb(1.f)}};
    EXPECT_FALSE(has_motion(still));
    still.light_motions = {{still.lights[0], still.lights[0]}};
    EXPECT_TRUE(has_motion(still));
}

TEST(Motion, TangentsRunStraightBetweenSteps) {
    Mesh mesh = quad(V3f(0.f), V3f(1, 0, 0), V3f(0, 1, 0));
    mesh.tangents.assign(4, V4f(1, 0, 0, 1));
    EXPECT_EQ(tangent_at(mesh, 0, V2f(0.2f, 0.3f), 0.1f), V4f(1, 0, 0, 1));
    deform(mesh, 3, [](const V3f& p, float) { return p; });
    mesh.steps[1].tangents.assign(4, V4f(0, 1, 0, 1));
    mesh.steps[2].tangents.assign(4, V4f(0, 0, 1, 1));
    const auto near = [&](float time, V4f expected) {
        EXPECT_LT((tangent_at(mesh, 0, V2f(0.2f, 0.3f), time) - expected).length(), 1e-6f) << time;
    };
    near(0, V4f(1, 0, 0, 1));
    near(0.125f, V4f(0.75f, 0.25f, 0, 1));
    near(0.5f, V4f(0, 1, 0, 1));
    near(0.875f, V4f(0, 0.25f, 0.75f, 1));
    near(1, V4f(0, 0, 1, 1));
}

}  // namespace
}  // namespace petzval
