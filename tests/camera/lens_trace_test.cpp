// SPDX-License-Identifier: Apache-2.0
// What must hold of rays through a lens whatever its figures: geometry that can be worked by hand,
// and ways there and back.
#include "camera/lens/trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/lens_json.h"
#include "tests/support/lens_rays.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using test::at_lane;
using test::kLensKinds;
using test::lens_of;
using test::ray_of;
using test::surface_of;
using test::Three;
using test::usual_ray;
using test::whole;

constexpr double kDegree_rad = 3.14159265358979323846 / 180;
const d4 kD_nm = d4{} + kLineD_nm;

struct Outcome {
    Three point, direction;
    RayStatus status;
};

/// In doubles, at line d, from a point that counts from the first vertex.
Outcome traced(const Lens& lens, Three origin, Three direction, Towards towards = Towards::Film,
               Clip clip = Clip::No) {
    auto ray = ray_of<d4>(origin, direction);
    (void)trace_lens({lens, towards, whole(lens), clip}, lens.exact_indices(kD_nm), ray);
    Three point = at_lane(ray.origin, 0);
    point[2] += lens.vertex_mm(ray.counted_from);
    return {point, at_lane(ray.direction, 0), ray.status(0)};
}

void expect_near(Three a, Three b, double tolerance) {
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "coordinate " << i;
}

TEST(LensTrace, APlateMovesARayAside) {
    const Lens plate = lens_of({surface_of(0, 10, 1.5), surface_of(0, 10, 1)});
    for (const double degrees : {0., 30., 60., 89.}) {
        const double sine = std::sin(degrees * kDegree_rad), in_glass = std::asin(sine / 1.5);
        const Three direction{0.6 * sine, 0.8 * sine, std::cos(degrees * kDegree_rad)};
        const auto out = traced(plate, {0, 0, 0}, direction);
        EXPECT_EQ(out.status, RayStatus::Passed);
        expect_near(out.direction, direction, 1e-13);
        const double aside = 10 * std::tan(in_glass);
        expect_near(out.point, {0.6 * aside, 0.8 * aside, 10}, 1e-12);
    }
}

TEST(LensTrace, NearlyFlatIsLikeFlatFromEverywhere) {
    test::Random random(1);
    const auto plate = [](double c, double k) {
        std::vector<LensSurface> surfaces{surface_of(c, 3, 1.6), surface_of(-c, 3, 1)};
        for (auto& surface : surfaces) surface.conic = k;
        return lens_of(surfaces);
    };
    for (const double conic : {0., 2., -3.})
        for (const double c : {1e-9, -1e-12, 1e-30, 1e-300})
            for (int i = 0; i < 20; ++i) {
                const V3f to = random.direction();
                const Three origin{random.next() * 10., random.next() * 10., -random.next() * 1e3};
                const Three direction{to.x, to.y, std::fabs(to.z) + 0.1};
                const auto flat = traced(plate(0, 0), origin, direction);
                const auto bent = traced(plate(c, conic), origin, direction);
                EXPECT_EQ(bent.status, RayStatus::Passed);
                const double sag = std::fabs(c) * test::dot(flat.point, flat.point);
                expect_near(bent.point, flat.point, 20 * sag + 1e-10);
                const auto away =
                    traced(plate(c, conic), origin, {to.x, to.y, -0.1}, Towards::Film, Clip::Yes);
                EXPECT_NE(away.status, RayStatus::Passed) << "light that runs the other way";
            }
}

TEST(LensTrace, SurfacesAboutThePointAimedAtBendNothing) {
    // A shell about (0, 0, 20); rays to its centre from up to 89 degrees beside the axis.
    const Lens shell = lens_of({surface_of(1. / 20, 8, 1.8), surface_of(1. / 12, 20, 1)});
    for (const double degrees : {0., 45., 80., 89.}) {
        const double sine = std::sin(degrees * kDegree_rad),
                     cosine = std::cos(degrees * kDegree_rad);
        const Three direction{sine, 0, cosine};
        for (const double from : {50., 20., 5., -30.}) {
            SCOPED_TRACE(::testing::Message() << degrees << " degrees from " << from << " mm");
            const auto out = traced(shell, {-from * sine, 0, 20 - from * cosine}, direction);
            EXPECT_EQ(out.status, RayStatus::Passed);
            expect_near(out.direction, direction, 1e-12);
            expect_near(out.point, {-12 * sine, 0, 20 - 12 * cosine}, 1e-12);
        }
    }
    // Extrapolate 90 degrees it is the far half of the sphere.
    EXPECT_EQ(traced(shell, {-50, 0, 21}, {50, 0, -1}).status, RayStatus::Missed);
}

// Light that runs away from the film at more than 90 degrees to the axis still enters the front.
TEST(LensTrace, TakesTheRootOnTheVertexSheet) {
    const Lens ball = lens_of({surface_of(1. / 10, 5, 1.5)});
    const Three direction = test::unit({0, 1, -0.05});
    const auto out = traced(ball, test::plus({0, -5, 6}, direction, -100), direction);
    EXPECT_EQ(out.status, RayStatus::Passed);
    EXPECT_NEAR(test::length(test::plus(out.point, {0, 0, -10})), 10, 1e-12);
    EXPECT_LT(out.point[1], 0);
    EXPECT_LT(out.point[2], 10);
    EXPECT_EQ(traced(ball, {0, 0, 5}, {0, 0, -1}).status, RayStatus::Missed);
    EXPECT_EQ(traced(ball, {0, 10.001, -5}, {0, 0, 1}).status, RayStatus::Missed);
    EXPECT_EQ(traced(ball, {0, 9.999, -5}, {0, 0, 1}).status, RayStatus::Passed);
}

TEST(LensTrace, ReflectsTotallyBeyondTheCriticalAngle) {
    const Lens window = lens_of({surface_of(0, 5, 1.5)});
    const double critical = std::asin(1 / 1.5);
    for (const double beyond : {-0.1, -1e-6, 1e-6, 0.1, 0.8}) {
        const double angle = critical + beyond;
        const auto out =
            traced(window, {0, 0, 3}, {std::sin(angle), 0, -std::cos(angle)}, Towards::Scene);
        EXPECT_EQ(out.status, beyond < 0 ? RayStatus::Passed : RayStatus::TotallyReflected)
            << beyond;
        if (beyond < 0) {
            EXPECT_NEAR(out.direction[0], 1.5 * std::sin(angle), 1e-14);
        }
    }
}

// Descartes: an ellipsoid of k = -1 / n^2 brings parallel light to one point in glass, at
// n / (n - 1) radii; a hyperboloid of k = -n^2 does so behind glass, at 1 / (n - 1).
TEST(LensTrace, ConicsOfDescartesHaveOneFocus) {
    const double n = 1.7, radius = 20;
    auto ellipsoid = surface_of(1 / radius, 5, n);
    ellipsoid.conic = -1 / (n * n);
    auto hyperboloid = surface_of(-1 / radius, 5, 1);
    hyperboloid.conic = -n * n;
    const auto crossing_mm = [](const Outcome& out) {
        return out.point[2] - out.point[1] * out.direction[2] / out.direction[1];
    };
    for (const auto profile : {Profile::Rotational, Profile::CylinderX})
        for (const bool as_asphere : {false, true}) {
            for (LensSurface* surface : {&ellipsoid, &hyperboloid}) {
                surface->profile = profile;
                surface->asphere.clear();
                if (as_asphere) surface->asphere = {{4, 0}, {5, 0}};
            }
            const Lens into_glass = lens_of({ellipsoid});
            const Lens out_of_glass = lens_of({surface_of(0, 0, n), hyperboloid});
            const double x = profile == Profile::Rotational ? 0 : 7;
            for (const double y : {1e-3, 1., 10., 19., -15.}) {
                SCOPED_TRACE(y);
                EXPECT_NEAR(crossing_mm(traced(into_glass, {x, y, -9}, {0, 0, 1})),
                            n / (n - 1) * radius, 1e-10);
                EXPECT_NEAR(crossing_mm(traced(out_of_glass, {x, y, -9}, {0, 0, 1})),
                            1 / (n - 1) * radius, 1e-10);
            }
        }
}

TEST(LensTrace, AsphereThatIsAParabola) {
    // r^2 / 40 written as a conic, as an even asphere and, at r = 8 mm, as an odd one.
    auto conic = surface_of(1. / 20, 5, 1.6), even = surface_of(0, 5, 1.6);
    conic.conic = -1;
    even.asphere = {{2, 1. / 40}};
    for (const auto& [y, slope] : {std::pair{8., 0.3}, {-8., 0.1}, {8., -0.9}, {0., 0.}}) {
        const auto a = traced(lens_of({conic}), {1, y, -1}, {0.1, slope, 1});
        const auto b = traced(lens_of({even}), {1, y, -1}, {0.1, slope, 1});
        expect_near(a.point, b.point, 1e-12);
        expect_near(a.direction, b.direction, 1e-12);
    }
    auto odd = surface_of(0, 5, 1.6);
    odd.asphere = {{3, 1. / 320}};
    const auto out = traced(lens_of({odd}), {0, 8, -1}, {0, 0, 1});
    EXPECT_NEAR(out.point[2], 1.6, 1e-13);
    // Slope 3 r^2 / 320 = 0.6.
    const double incidence = std::atan(0.6), refraction = std::asin(std::sin(incidence) / 1.6);
    EXPECT_NEAR(out.direction[1], -std::sin(incidence - refraction), 1e-13);
    EXPECT_EQ(traced(lens_of({odd}), {0, 0, -1}, {0, 0, 1}).status, RayStatus::Passed)
        << "its pole";
}

TEST(LensTrace, ALensOfAirDoesNothing) {
    Prescription lens = test::read_lens("double-gauss-100mm-f2");
    for (const double n : {1., 1 + 1e-13, 1 + 1e-9}) {
        for (auto& surface : lens.surfaces)
            if (surface.glass) surface.glass = test::constant_glass(n);
        for (const auto towards : {Towards::Film, Towards::Scene}) {
            const Three direction = test::unit({0.1, 0.05, towards == Towards::Film ? 1. : -1.});
            const auto out = traced(Lens(lens), {1, 2, 60}, direction, towards);
            EXPECT_EQ(out.status, RayStatus::Passed);
            expect_near(out.direction, direction, 50 * (n - 1) + 1e-14);
            const Three way = test::plus(out.point, {1, 2, 60}, -1);
            EXPECT_NEAR(test::length(test::plus(way, direction, -test::dot(way, direction))), 0,
                        1e4 * (n - 1) + 1e-12);
        }
    }
}

TEST(LensTrace, FisheyesRimIsAnEndWithoutAGap) {
    const Lens lens(test::read_lens("minolta-fisheye-16mm-f2.8"));
    // Light in the plane of the front's rim, 60 to 120 degrees off the axis, aimed at the first
    // vertex and beside it.
    int passed = 0, blocked = 0;
    for (double degrees = 60; degrees <= 120; degrees += 0.5)
        for (double aim = -30; aim <= 0; aim += 0.25) {
            const Three direction{0, std::sin(degrees * kDegree_rad),
                                  std::cos(degrees * kDegree_rad)};
            for (const Clip clip : {Clip::Yes, Clip::No}) {
                const auto origin = test::plus({0, aim, 4}, direction, -50);
                const auto out = traced(lens, origin, direction, Towards::Film, clip);
                EXPECT_TRUE(std::isfinite(out.point[0] + out.point[1] + out.point[2]));
                EXPECT_NEAR(test::length(out.direction), 1, 1e-10);
                ++(out.status == RayStatus::Passed ? passed : blocked);
                EXPECT_TRUE(out.status != RayStatus::Passed || out.direction[2] > 0);
            }
        }
    EXPECT_GT(passed, 100);
    EXPECT_GT(blocked, 100);
}

TEST(LensTrace, ThereAndBackAndThereAgain) {
    test::Random random(7);
    for (const char* name : kLensKinds) {
        const Lens lens(test::read_lens(name));
        const auto check = [&]<class V>(const LensRay<d4>& start, double tolerance, V nm) {
            const auto indices = lens.exact_indices(nm);
            LensRay<V> ray;
            ray.origin = test::vectors_of<V>([&](int i) { return at_lane(start.origin, i); });
            ray.direction = test::vectors_of<V>([&](int i) { return at_lane(start.direction, i); });
            ASSERT_TRUE(all(trace_lens({lens, Towards::Film, whole(lens), Clip::No}, indices, ray)))
                << name;
            const auto there = ray;
            ray.direction = ray.direction * ScalarOf<V>(-1);
            ASSERT_TRUE(
                all(trace_lens({lens, Towards::Scene, whole(lens), Clip::No}, indices, ray)));
            EXPECT_EQ(ray.counted_from, 0);
            for (int i = 0; i < 4; ++i) {
                const Three back = at_lane(ray.direction, i), at = at_lane(ray.origin, i);
                expect_near(back, test::plus({}, at_lane(start.direction, i), -1), tolerance);
                const double t = (at_lane(start.origin, i)[2] - at[2]) / back[2];
                expect_near(test::plus(at, back, t), at_lane(start.origin, i), tolerance);
            }
            ray.direction = ray.direction * ScalarOf<V>(-1);
            ASSERT_TRUE(
                all(trace_lens({lens, Towards::Film, whole(lens), Clip::No}, indices, ray)));
            EXPECT_EQ(ray.counted_from, lens.last());
            for (int i = 0; i < 4; ++i) {
                expect_near(at_lane(ray.origin, i), at_lane(there.origin, i), tolerance);
                expect_near(at_lane(ray.direction, i), at_lane(there.direction, i), tolerance);
            }
        };
        for (int i = 0; i < 50; ++i) {
            const auto start = usual_ray(lens, random);
            check(start, 1e-9, d4{486.1327, 500, 587.5618, 656.2725});
            check(start, 1e-3, f4{486.1327f, 500, 587.5618f, 656.2725f});
        }
    }
}

TEST(LensTrace, InPartsIsLikeInOneGo) {
    test::Random random(8);
    for (const char* name : kLensKinds) {
        const Lens lens(test::read_lens(name));
        const auto indices = lens.exact_indices(kD_nm);
        for (int i = 0; i < 50; ++i) {
            auto whole_way = usual_ray(lens, random), parts = whole_way;
            const int stop = lens.stop();
            (void)trace_lens({lens, Towards::Film, whole(lens), Clip::Yes}, indices, whole_way);
            (void)trace_lens({lens, Towards::Film, {0, stop - 1}, Clip::Yes}, indices, parts);
            (void)trace_lens({lens, Towards::Film, {stop, stop}, Clip::Yes}, indices, parts);
            (void)trace_lens({lens, Towards::Film, {stop, stop - 1}, Clip::Yes}, indices, parts);
            (void)trace_lens({lens, Towards::Film, {stop + 1, lens.last()}, Clip::Yes}, indices,
                             parts);
            expect_near(at_lane(parts.origin, 0), at_lane(whole_way.origin, 0), 1e-12);
            expect_near(at_lane(parts.direction, 0), at_lane(whole_way.direction, 0), 1e-13);
            EXPECT_EQ(parts.status(0), whole_way.status(0));
        }
    }
}

TEST(LensTrace, ABlockedLaneStaysBlocked) {
    std::vector<LensSurface> surfaces{surface_of(0.02, 5, 1.5, 10), surface_of(-0.02, 5, 1, 10),
                                      surface_of(0, 5, 1, 2), surface_of(0, 5, 1, 1e3)};
    surfaces[2].stop = true;
    const Lens lens = lens_of(surfaces);
    auto ray = ray_of<f4>({0, 0, -5}, {0, 0, 1});
    ray.origin.y = f4{0, 11, 9, 1};
    std::vector<m4> reached;
    const auto look = [&](const LensHit<f4>& hit) { reached.push_back(hit.reached); };
    const auto indices = lens.indices(splat(550));
    (void)trace_lens({lens, Towards::Film, {0, 2}, Clip::Yes}, indices, ray, look);
    const auto passed = trace_lens({lens, Towards::Film, {3, 3}, Clip::Yes}, indices, ray, look);
    const m4 passed_wanted{-1, 0, 0, -1}, ends{0, 0, 2, 0};
    ASSERT_EQ(reached.size(), 4u);
    const m4 reached_wanted[] = {
        {-1, -1, -1, -1}, {-1, 0, -1, -1}, {-1, 0, -1, -1}, {-1, 0, 0, -1}};
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(passed[i], passed_wanted[i]);
        EXPECT_EQ(ray.status(i), passed_wanted[i] ? RayStatus::Passed : RayStatus::Vignetted);
        EXPECT_EQ(ray.end_surface[i], ends[i]);
        for (size_t k = 0; k < 4; ++k) EXPECT_EQ(reached[k][i], reached_wanted[k][i]);
    }
    // A lane that was blocked from the start keeps what it was given, wherever its ray runs.
    ray = ray_of<f4>({0, 0, -5}, {0, 0, 1});
    ray.status_code[1] = int(RayStatus::TotallyReflected), ray.end_surface[1] = 3;
    ray.origin.x[1] = std::nanf("");
    (void)trace_lens({lens, Towards::Film, whole(lens), Clip::Yes}, indices, ray);
    EXPECT_EQ(ray.status(1), RayStatus::TotallyReflected);
    EXPECT_EQ(ray.end_surface[1], 3);
    EXPECT_EQ(at_lane(ray.origin, 1), (Three{}));
    EXPECT_EQ(ray.status(0), RayStatus::Passed);
    // Once all are blocked, nothing is looked at any more.
    reached.clear();
    ray = ray_of<f4>({0, 11, -5}, {0, 0, 1});
    (void)trace_lens({lens, Towards::Film, whole(lens), Clip::Yes}, indices, ray, look);
    EXPECT_EQ(reached.size(), 1u);
}

TEST(LensTrace, AnObserverSeesPointsIndicesAndDistances) {
    const Lens lens = lens_of({surface_of(0, 5, 1.5), surface_of(0, 2, 1), surface_of(0, 9, 1)});
    for (const bool to_film : {true, false}) {
        auto ray = ray_of<d4>({0, 0, -4}, {0, 0.6, to_film ? 0.8 : -0.8});
        std::vector<LensHit<d4>> hits;
        (void)trace_lens({lens, to_film ? Towards::Film : Towards::Scene, whole(lens), Clip::No},
                         lens.exact_indices(kD_nm), ray,
                         [&](const auto& hit) { hits.push_back(hit); });
        ASSERT_EQ(hits.size(), 3u);
        const double in_air = 1 / 0.8, in_glass = 1 / std::sqrt(1 - 0.16);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(hits[i].surface, to_film ? int(i) : 2 - int(i));
            EXPECT_NEAR(hits[i].point.z[0], 0, 1e-14);
        }
        EXPECT_EQ(hits[1].index[0], to_film ? 1.5 : 1);
        EXPECT_EQ(hits[2].index[0], to_film ? 1 : 1.5);
        EXPECT_NEAR(hits[0].distance_mm[0], to_film ? 4 * in_air : -11 * in_air, 1e-13);
        EXPECT_NEAR(hits[1].distance_mm[0], to_film ? 5 * in_glass : 2 * in_air, 1e-13);
        EXPECT_NEAR(hits[2].distance_mm[0], to_film ? 2 * in_air : 5 * in_glass, 1e-13);
    }
}

}  // namespace
}  // namespace petzval::camera
