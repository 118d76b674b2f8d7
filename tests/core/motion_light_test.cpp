// SPDX-License-Identifier: Apache-2.0
// Lights that move while the shutter is open: their places, the density of their samples, and the
// chance with which they are picked.
#include <gtest/gtest.h>

#include "core/light/light_choice.h"
#include "core/light/light_sampling.h"
#include "core/light/small_features.h"
#include "core/scene/lamp.h"
#include "core/scene/motion.h"
#include "core/shading/surface.h"
#include "core/traversal/bvh.h"
#include "tests/support/chi_square.h"
#include "tests/support/lamp.h"
#include "tests/support/moving.h"
#include "tests/support/scenes.h"

namespace petzval {
namespace {

using namespace test;

const Bands kMovingRgb = Bands::rgb();

/// The lamp of one triangle, turning and flying away; it may grow as well.
Scene moving_lamp(size_t steps, bool deforms, bool two_sided = false) {
    Scene lamp = lamp_scene(Rgb(5.f, 3.f, 1.f), two_sided), scene;
    Mesh mesh = lamp.meshes[0];
    if (deforms) deform(mesh, steps, [](const V3f& p, float time) { return p * (0.5f + time); });
    place_moving(scene, mesh, lamp.materials[0], at_steps(steps, [](float time) {
                     return turned(V3f(0.5f * time, time, 0), V3f(time, 0.3f * time, -time));
                 }));
    finish_scene(scene);
    return scene;
}

/// Distance along w from p to a triangle; nothing where it is passed by.
std::optional<double> meet(const std::array<V3d, 3>& c, const V3d& p, const V3d& w) {
    const V3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double t = (c[0] - p).dot(n) / w.dot(n);
    const V3d at = p + w * t;
    for (size_t i = 0; i < 3; ++i)
        if ((c[(i + 1) % 3] - c[i]).cross(at - c[i]).dot(n) < 0) return std::nullopt;
    return t > 0 ? std::optional(t) : std::nullopt;
}

TEST(MovingLight, SamplesFollowTheDensityAtTheirTime) {
    const Scene scene = moving_lamp(5, true, true);
    const TriangleLight light{0, 0};
    uint32_t seed = 1;
    for (const float time : {0.3f, 0.95f}) {
        const auto c = corners_at(scene, 0, 0, double(time));
        const V3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
        const V3d middle = (c[0] + c[1] + c[2]) / 3;
        for (const double away : {0.3, 2.}) {  // by solid angle, and by area
            const V3f p(middle - normal * away);
            const auto pdf = [&](const V3f& w) -> double {
                const auto t = meet(c, V3d(p), V3d(w));
                if (!t) return 0;
                return triangle_light_pdf(scene, light, p, static_cast<float>(*t * *t),
                                          static_cast<float>(normal.dot(V3d(w))), time);
            };
            const auto draw = [&](Random& random) -> std::optional<V3f> {
                const auto s = sample_light(scene, light, p, random.next2(), kMovingRgb, time);
                if (!s) return std::nullopt;
                const double said = pdf(s->direction);
                EXPECT_NEAR(double(s->pdf), said > 0 ? said : double(s->pdf), 2e-3 * said);
                return s->direction;
            };
            EXPECT_TRUE(test::chi_square_sphere(draw, pdf, seed++, 50000, 3))
                << time << ' ' << away;
        }
    }
}

/// Irradiance from a triangle of a radiance of 1: Lambert 1760; Baum et al. 1989, equation 2.
double lambert(const std::array<V3d, 3>& c, const V3d& p, const V3d& n) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) {
        const V3d a = (c[i] - p).normalized(), b = (c[(i + 1) % 3] - p).normalized();
        sum += std::acos(a.dot(b)) * a.cross(b).normalized().dot(n);
    }
    return std::fabs(sum) / 2;
}

TEST(MovingLight, BringsTheIrradianceOfItsTime) {
    const Scene scene = moving_lamp(9, true, true);
    uint32_t seed = 30;
    for (const float time : {0.f, 0.2f, 0.77f, 1.f}) {
        const auto c = corners_at(scene, 0, 0, double(time));
        const V3f p((c[0] + c[1] + c[2]) / 3 + V3d(0.2, -2, 0.1));
        const V3f n(0, 1, 0);
        Random random(seed++);
        Moments moments;
        for (int i = 0; i < 30000; ++i) {
            const auto s =
                sample_light(scene, scene.lights[0], p, random.next2(), kMovingRgb, time);
            moments.add(s ? double(s->radiance[1] * s->direction.dot(n) / s->pdf) : 0);
        }
        EXPECT_TRUE(agrees(moments, 3 * lambert(c, V3d(p), V3d(n)), 1e-5)) << Mean(moments);
    }
}

/// One-sided lamps that turn over, are mirrored half the time, or turned inside out by their
/// shape.
std::vector<Scene> turning_lamps() {
    const Scene lamp = lamp_scene();
    std::vector<Scene> out(4);
    const auto move = [&](Scene& scene, size_t steps, auto matrix) {
        place_moving(scene, lamp.meshes[0], lamp.materials[0], at_steps(steps, matrix));
    };
    move(out[0], 17, [](float time) { return turned(V3f(6 * time, 0, 0), V3f(0.f)); });
    move(out[1], 2,
         [](float time) { return turned(V3f(0.f), V3f(0.f), V3f(1.f - 1.7f * time, 1, 1)); });
    move(out[2], 4, [](float time) { return turned(V3f(time), V3f(0.f), V3f(1, 0.4f - time, 1)); });
    Mesh soft = lamp.meshes[0];
    deform(soft, 3, [](const V3f& p, float time) { return V3f(p.x, p.y, p.z * (0.3f - time)); });
    place(out[3], soft, lamp.materials[0]);
    for (Scene& scene : out) finish_scene(scene);
    return out;
}

// What a shadow ray is told and what a ray finds that is sent there.
TEST(MovingLight, ShinesOnTheSideThatRaysFindShining) {
    size_t number = 0;
    for (const Scene& scene : turning_lamps()) {
        const Bvh bvh(scene, Traversal::Robust);
        Random random(5);
        int bright = 0, dark = 0;
        for (int i = 0; i < 4000; ++i) {
            const float time = random.next();
            const auto c = corners_at(scene, 0, 0, double(time));
            const V3f target((c[0] + c[1] + c[2]) / 3);
            Ray ray;
            ray.direction = random.direction();
            ray.origin = target - ray.direction * 3.f;
            ray.time = time;
            const auto hit = bvh.intersect(ray);
            if (!hit) continue;
            const Surface s = make_surface(scene, ray.direction, *hit);
            if (std::fabs(s.ng.dot(ray.direction)) < 0.02f) continue;
            const auto drawn =
                sample_light(scene, scene.lights[0], ray.origin, V2f(0.4f), kMovingRgb, time);
            ASSERT_EQ(drawn.has_value(), s.front) << number << " at " << time;
            ++(s.front ? bright : dark);
        }
        EXPECT_GT(std::min(bright, dark), 500) << number;
        ++number;
    }
}

/// All kinds of lights that have a position, some of which reach a receiver at a few times only.
Scene lights_of_all_kinds(uint32_t seed, size_t steps) {
    Scene scene;
    Random random(seed);
    scene.profiles.emplace_back(ProfilePole::Forward, std::vector<float>{0, 20, 40},
                                std::vector<float>{0, 360}, std::vector<float>(6, 50.f));
    for (int i = 0; i < 12; ++i) {
        const V3f from = random.direction() * 3.f, to = random.direction() * 3.f;
        const V3f axis = random.direction(), end = random.direction();
        const float turn = 1.5f * random.next(), outer = 0.05f + 0.5f * random.next();
        const auto place_at = [&](float time) { return from * (1 - time) + to * time; };
        const auto facing = [&](float time) {
            return unit(axis * std::cos(2 * turn * time) +
                        axis.cross(end) * std::sin(2 * turn * time));
        };
        const auto light_at_time = [&](float time) -> Light {
            if (i % 3 == 0) return PointLight{place_at(time), Rgb(3.f)};
            if (i % 3 == 1)
                return SpotLight{place_at(time), facing(time), Rgb(3.f), std::cos(outer / 2),
                                 std::cos(outer)};
            const Frame frame = Frame::about(facing(time));
            return ProfileLight{place_at(time), frame.x, frame.y, frame.z, Rgb(1.f), 0};
        };
        scene.lights.push_back(light_at_time(0.5f));
        scene.light_motion_of.push_back(static_cast<int32_t>(scene.light_motions.size()));
        scene.light_motions.push_back(at_steps(steps, light_at_time));
    }
    for (int i = 0; i < 12; ++i) {
        const V3f from = random.direction() * 3.f, to = random.direction() * 3.f;
        const V3f angles = random.direction() * (3 * random.next());
        Mesh mesh = one_triangle(random.direction() * 0.5f, random.direction() * 0.5f,
                                 random.direction() * 0.5f);
        if (i % 3 > 0)  // of its own shape at each step, without an area in the middle
            deform(mesh, steps, [&](const V3f& p, float time) {
                return time == 0.5f ? V3f(0.f) : p + random.direction();
            });
        place_moving(scene, mesh, glowing(Rgb(2.f), i % 4 == 3),
                     i % 3 > 1 ? std::vector<M44f>(steps, turned(angles, from))
                               : at_steps(steps, [&](float time) {
                                     return turned(angles * time, from * (1 - time) + to * time);
                                 }));
    }
    finish_scene(scene);
    return scene;
}

TEST(MovingLight, KeepsAChanceWheneverItReachesTheReceiver) {
    for (const size_t steps : {2, 3, 9, 33})
        for (const auto kind :
             {LightChoiceKind::Tree, LightChoiceKind::Power, LightChoiceKind::Uniform}) {
            const Scene scene = lights_of_all_kinds(static_cast<uint32_t>(steps), steps);
            const LightChoice choice(scene, kind);
            Random random(7);
            int reached = 0;
            for (int i = 0; i < 1500; ++i) {
                const LightReceiver receiver{random.direction() * (4 * random.next()),
                                             random.direction(), false};
                const float time = random.next();
                for (uint32_t k = 0; k < scene.lights.size(); ++k) {
                    std::optional<Light> moved;
                    const auto drawn = sample_light(scene, light_at(scene, k, time, moved),
                                                    receiver.p, random.next2(), kMovingRgb, time);
                    if (!drawn || !(drawn->direction.dot(receiver.normal) > 1e-3f)) continue;
                    ++reached;
                    ASSERT_GT(choice.probability(k, receiver), 0.f)
                        << "light " << k << " at " << time << " of " << steps << " steps";
                }
            }
            EXPECT_GT(reached, 1000);
        }
}

TEST(MovingLight, IsPickedAsOftenAsItsChanceSays) {
    const Scene scene = lights_of_all_kinds(3, 5);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    const LightReceiver receiver{V3f(0.3f, -0.5f, 0.2f), unit(V3f(1, 2, -1)), false};
    constexpr int kPicks = 20000;
    std::vector<double> observed(scene.lights.size() + 1), expected;
    double rest = kPicks;
    for (uint32_t k = 0; k < scene.lights.size(); ++k) {
        expected.push_back(kPicks * double(choice.probability(k, receiver)));
        rest -= expected.back();
    }
    expected.push_back(std::max(rest, 0.));  // clusters that turned out to reach nothing
    Random random(8);
    for (int i = 0; i < kPicks; ++i) {
        const auto pick = choice.pick(random.next(), receiver);
        ++observed[pick ? pick->light : scene.lights.size()];
    }
    EXPECT_TRUE(test::chi_square(observed, expected));
}

// A lamp that faces the receiver only at the very end, and a spot that turns to it only then.
TEST(MovingLight, KeepsAChanceWhereItTurnsToTheReceiverLate) {
    Scene scene;
    const auto turn = [](float time) { return 3.f * time * time; };
    for (int i = 0; i < 2; ++i) {
        scene.lights.push_back(SpotLight{V3f(0.f), V3f(0, 1, 0), Rgb(1.f), 0.999f, 0.99f});
        scene.light_motion_of.push_back(i);
        scene.light_motions.push_back(at_steps(129, [&](float time) -> Light {
            return SpotLight{V3f(0.f), V3f(std::sin(turn(time)), std::cos(turn(time)), 0), Rgb(1.f),
                             0.999f, 0.99f};
        }));
    }
    Mesh mesh = one_triangle(V3f(-0.5f, 0, 0.5f), V3f(0.5f, 0, 0.5f), V3f(0, 0, -0.5f));
    place_moving(scene, mesh, glowing(Rgb(1.f)), at_steps(65, [&](float time) {
                     return turned(V3f(0, 0, -turn(time)), V3f(0.f));
                 }));
    finish_scene(scene);
    const LightChoice choice(scene, LightChoiceKind::Tree);
    const LightReceiver late{V3f(std::sin(3.f), std::cos(3.f), 0) * 2.f,
                             -V3f(std::sin(3.f), std::cos(3.f), 0), false};
    const LightReceiver never{V3f(-2, 0.2f, 0), V3f(1, 0, 0), false};
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        std::optional<Light> moved;
        EXPECT_TRUE(
            sample_light(scene, light_at(scene, i, 1, moved), late.p, V2f(0.4f), kMovingRgb, 1));
        EXPECT_FALSE(sample_light(scene, light_at(scene, i, 0.5f, moved), late.p, V2f(0.4f),
                                  kMovingRgb, 0.5f));
        EXPECT_GT(choice.probability(i, late), 0.f);
    }
    EXPECT_EQ(choice.probability(0, never), 0.f);
}

TEST(MovingLight, OfEachKindRunsStraightBetweenSteps) {
    Scene scene;
    const float s = std::sqrt(0.5f);
    scene.light_motions = {
        {PointLight{V3f(0.f), Rgb(1.f)}, PointLight{V3f(2, 0, 0), Rgb(1.f)},
         PointLight{V3f(2, 8, 0), Rgb(1.f)}},
        {SpotLight{V3f(0.f), V3f(1, 0, 0), Rgb(1.f), 0.9f, 0.8f},
         SpotLight{V3f(0, 4, 0), V3f(0, 1, 0), Rgb(1.f), 0.9f, 0.8f}},
        {SunLight{V3f(1, 0, 0), Rgb(1.f)}, SunLight{V3f(0, 0, 1), Rgb(1.f)}},
        {ProfileLight{V3f(0.f), V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1), Rgb(1.f), 0},
         ProfileLight{V3f(0, 0, 2), V3f(0, 1, 0), V3f(-1, 0, 0), V3f(0, 0, 1), Rgb(1.f), 0}}};
    for (int i = 0; i < 4; ++i) {
        scene.lights.push_back(scene.light_motions[size_t(i)][0]);
        scene.light_motion_of.push_back(i);
    }
    scene.lights.push_back(PointLight{V3f(9.f), Rgb(1.f)});  // beyond the list: still
    const auto at = [&](uint32_t light, float time) {
        std::optional<Light> moved;
        return light_at(scene, light, time, moved);
    };
    EXPECT_EQ(std::get<PointLight>(at(0, 0.f)).position, V3f(0.f));
    EXPECT_EQ(std::get<PointLight>(at(0, 0.125f)).position, V3f(0.5f, 0, 0));
    EXPECT_EQ(std::get<PointLight>(at(0, 0.5f)).position, V3f(2, 0, 0));
    EXPECT_EQ(std::get<PointLight>(at(0, 0.875f)).position, V3f(2, 6, 0));
    EXPECT_EQ(std::get<PointLight>(at(0, 1.f)).position, V3f(2, 8, 0));
    const auto spot = std::get<SpotLight>(at(1, 0.5f));
    EXPECT_EQ(spot.position, V3f(0, 2, 0));
    EXPECT_LT((spot.direction - V3f(s, s, 0)).length(), 1e-6f);
    EXPECT_EQ(spot.cos_outer, 0.8f);
    EXPECT_LT((std::get<SunLight>(at(2, 0.5f)).direction - V3f(s, 0, s)).length(), 1e-6f);
    const auto profile = std::get<ProfileLight>(at(3, 0.5f));
    EXPECT_EQ(profile.position, V3f(0, 0, 1));
    EXPECT_LT((profile.x - V3f(s, s, 0)).length(), 1e-6f);
    EXPECT_LT((profile.y - V3f(-s, s, 0)).length(), 1e-6f);
    EXPECT_LT((profile.f - V3f(0, 0, 1)).length(), 1e-6f);
    EXPECT_EQ(std::get<PointLight>(at(4, 0.f)).position, V3f(9.f));
}

// A plan must not miss a lamp where it comes to late.
TEST(MovingLight, IsAThingAsLargeAsWhereItComes) {
    const Scene scene = moving_lamp(5, true);
    const std::vector<SmallFeature> features = small_features_of(scene);
    ASSERT_EQ(features.size(), 1u);
    for (int i = 0; i <= 20; ++i)
        for (const V3d& corner : corners_at(scene, 0, 0, i / 20.))
            EXPECT_LE((V3f(corner) - features[0].centre).length(),
                      features[0].reach_m * 1.0001f + 1e-4f);
}

// Its corners are rounded as those of the steps are, between which it is near the receiver.
TEST(MovingLight, IsNotInItsOwnShadowOnAFastFlight) {
    for (const float reach : {1.f, 1e3f, 1e5f}) {
        Scene scene = lamp_scene(Rgb(1.f), true), moving;
        place_moving(moving, scene.meshes[0], scene.materials[0], at_steps(2, [&](float time) {
                         return turned(V3f(time), V3f(2, -1, 0.5f) * (reach * (time - 0.5f)));
                     }));
        finish_scene(moving);
        const Bvh bvh(moving, Traversal::Robust);
        Random random(11);
        int drawn = 0, shadowed = 0;
        for (int i = 0; i < 20000; ++i) {
            const float time = 0.5f + (random.next() - 0.5f) / reach;
            const auto c = corners_at(moving, 0, 0, double(time));
            Ray ray;
            ray.origin = V3f((c[0] + c[1] + c[2]) / 3) + random.direction() * (3 * random.next());
            // Beside the lamp's own plane, rounding decides on which side of it the receiver is.
            const V3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
            if (std::fabs(normal.dot(V3d(ray.origin) - c[0])) < 0.2) continue;
            const auto s = sample_light(moving, moving.lights[0], ray.origin, random.next2(),
                                        kMovingRgb, time);
            if (!s) continue;
            ++drawn;
            ray.direction = s->target - ray.origin;
            ray.t_max = kOneMinus;
            ray.time = time;
            shadowed += bvh.occluded(ray);
        }
        EXPECT_GT(drawn, 10000) << reach;
        EXPECT_EQ(shadowed, 0) << reach;
    }
}

TEST(MovingLight, BallsAreAtEachTimeTheBallThatStandsThere) {
    const auto flight = [](float time) { return V3f(3 * time, 1 - time, 0.5f); };
    Scene moving;
    const std::vector<BallLamp> ball{{flight(0.5f), 0.2f, Rgb(1.f), -1, {}, at_steps(3, flight)}};
    add_lamps(moving, ball);
    finish_scene(moving);
    for (const float time : {0.f, 0.3f, 0.5f, 1.f}) {
        Scene still;
        add_lamps(still, std::vector<BallLamp>{{flight(time), 0.2f, Rgb(1.f)}});
        for (uint32_t t = 0; t < still.meshes[0].triangles.size(); ++t) {
            const auto a = triangle_corners(moving, 0, t, time), b = triangle_corners(still, 0, t);
            for (size_t k = 0; k < 3; ++k) ASSERT_LT((a[k] - b[k]).length(), 1e-6f) << time;
        }
    }
}

}  // namespace
}  // namespace petzval
