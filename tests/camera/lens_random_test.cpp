// SPDX-License-Identifier: Apache-2.0
// Lenses that nobody would build, and rays that no light takes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "camera/lens/trace.h"
#include "tests/support/random_lens.h"

namespace petzval::camera {
namespace {

using test::at_lane;
using test::dot;
using test::fault_of;
using test::length;
using test::Line;
using test::plus;
using test::Random;
using test::random_line;
using test::rays_of;
using test::Three;
using test::whole;

/// The point lies on the surface, and n times the direction changes along its normal only: from the
/// definition of the sag and its derivative.
void expect_snell(const LensSurface& s, Three point, Three before, Three after, double n_before,
                  double n_after, double sign) {
    const double x = s.profile == Profile::CylinderX ? 0 : point[0];
    const double y = s.profile == Profile::CylinderY ? 0 : point[1];
    const double r = std::hypot(x, y), c = s.curvature_1_mm;
    const double root = std::sqrt(1 - (1 + s.conic) * c * c * r * r);
    double sag = c * r * r / (1 + root), slope = c * r / root, sum = std::fabs(sag);
    for (const auto& [power, coefficient] : s.asphere) {
        sag += coefficient * std::pow(r, power);
        sum += std::fabs(coefficient * std::pow(r, power));
        slope += coefficient * power * std::pow(r, power - 1);
    }
    const double rounding = 1e-14 * (1 + sum + length(point)) / (root * root);
    const double steep = std::hypot(1, slope);
    if (rounding * steep > 1e-6) return;
    ASSERT_NEAR(point[2], sag, 100 * rounding * steep);
    const double by_r = r > 0 ? 1 / r : 0;
    const Three normal = test::unit({-slope * x * by_r * sign, -slope * y * by_r * sign, sign});
    ASSERT_GE(dot(normal, before), -1e-6);
    ASSERT_GE(dot(normal, after), -1e-6);
    const Three change = plus(plus({}, after, n_after), before, -n_before);
    ASSERT_LT(length(plus(change, normal, -dot(change, normal))), 1e-8 + 100 * rounding * steep);
}

TEST(RandomLens, EveryRayHasADefinedEnd) {
    Random random(20);
    int losses[4] = {};
    for (int trial = 0; trial < 10000; ++trial) {
        const Lens lens(test::random_prescription(random));
        const auto towards = trial % 2 ? Towards::Film : Towards::Scene;
        const auto clip = trial % 4 < 2 ? Clip::Yes : Clip::No;
        std::array<Line, 4> lines;
        for (auto& line : lines) line = random_line(random, towards == Towards::Film);
        auto doubles = rays_of<d4>(lines);
        auto floats = rays_of<f4>(lines);
        auto dual = test::with_derivatives(floats);
        SCOPED_TRACE(trial);
        const auto indices = lens.exact_indices(splat(550));
        (void)trace_lens({lens, towards, whole(lens), clip}, lens.exact_indices(d4{} + 550),
                         doubles);
        (void)trace_lens({lens, towards, whole(lens), clip}, indices, floats);
        (void)trace_lens({lens, towards, whole(lens), clip}, indices, dual);
        // Grazing incidence on a sphere loses half the digits.
        ASSERT_EQ(fault_of(doubles, lens, towards, 1e-9), "");
        ASSERT_EQ(fault_of(floats, lens, towards, 0.05), "");
        ASSERT_EQ(fault_of(dual, lens, towards, 0.05), "");
        // One float does to the last bit what a lane does, so lanes do not look at each other;
        // derivatives do not change values.
        LensIndices<float> one_index;
        for (size_t i = 0; i < lens.media().size(); ++i)
            one_index.of_medium[i] = indices.of_medium[i][0];
        for (int i = 0; i < 4; ++i) {
            ++losses[doubles.status_code[i]];
            LensRay<float> one;
            const auto& [origin, direction] = lines[size_t(i)];
            one.origin = {float(origin[0]), float(origin[1]), float(origin[2])};
            one.direction = {float(direction[0]), float(direction[1]), float(direction[2])};
            (void)trace_lens({lens, towards, whole(lens), clip}, one_index, one);
            ASSERT_EQ(one.status(0), floats.status(i));
            ASSERT_EQ(one.end_surface, floats.end_surface[i]);
            ASSERT_EQ(at_lane(one.origin, 0), at_lane(floats.origin, i));
            ASSERT_EQ(at_lane(one.direction, 0), at_lane(floats.direction, i));
            ASSERT_EQ(dual.status(i), floats.status(i));
        }
    }
    for (const int count : losses) EXPECT_GT(count, 500);
}

TEST(RandomLens, PointsAreOnTheSurfacesAndSnellsLawHolds) {
    Random random(21);
    int checked = 0, aspheres = 0;
    for (int trial = 0; trial < 10000; ++trial) {
        const Lens lens(test::random_prescription(random));
        const bool to_film = trial % 2;
        std::array<Line, 4> lines;
        for (auto& line : lines) line = random_line(random, to_film);
        auto ray = rays_of<d4>(lines);
        const auto indices = lens.exact_indices(d4{} + 550);
        for (int k = 0; k < lens.size(); ++k) {
            const int i = to_film ? k : lens.last() - k;
            const LensSurface& surface = lens.prescription().surfaces[size_t(i)];
            const auto& facts = lens.surfaces<double>()[size_t(i)];
            const auto before = ray;
            (void)trace_lens({lens, to_film ? Towards::Film : Towards::Scene, {i, i}, Clip::Yes},
                             indices, ray);
            double n[] = {indices.of_medium[facts.medium_before][0],
                          indices.of_medium[facts.medium_after][0]};
            if (!to_film) std::swap(n[0], n[1]);
            for (int j = 0; j < 4; ++j) {
                if (ray.status(j) != RayStatus::Passed) continue;
                SCOPED_TRACE(::testing::Message() << trial << ", surface " << i);
                expect_snell(surface, at_lane(ray.origin, j), at_lane(before.direction, j),
                             at_lane(ray.direction, j), n[0], n[1], to_film ? 1 : -1);
                if (HasFatalFailure()) return;
                ++checked;
                aspheres += !surface.asphere.empty();
            }
        }
    }
    EXPECT_GT(checked, 20000);
    EXPECT_GT(aspheres, 3000);
}

TEST(RandomLens, NumbersThatAreNoneMiss) {
    const Lens lens = test::lens_of({test::surface_of(0.02, 5, 1.5), test::surface_of(0, 5, 1),
                                     test::surface_of(-0.02, 5, 1.7)});
    const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
    for (const double bad : {inf, -inf, nan})
        for (int place = 0; place < 6; ++place)
            for (const auto towards : {Towards::Film, Towards::Scene}) {
                auto ray =
                    test::ray_of<f4>({0, 0, -5}, {0, 0, towards == Towards::Film ? 1. : -1.});
                f4* const number[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z,
                                      &ray.direction.x, &ray.direction.y, &ray.direction.z};
                (*number[place])[2] = float(bad);
                const auto alive = trace_lens({lens, towards, whole(lens), Clip::No},
                                              lens.exact_indices(splat(550)), ray);
                EXPECT_EQ(fault_of(ray, lens, towards, 1e-5), "");
                EXPECT_EQ(ray.status(2), RayStatus::Missed) << place << ' ' << bad;
                for (const int i : {0, 1, 3}) EXPECT_TRUE(alive[i]);
            }
}

TEST(RandomLens, SlopesWhoseSquaresAreInfiniteMiss) {
    auto surface = test::surface_of(0, 10, 2);
    surface.asphere = {{11, 5e212}};
    const Lens lens = test::lens_of({test::surface_of(0, -0.7, 1), surface});
    Random random(22);
    for (int trial = 0; trial < 1000; ++trial) {
        std::array<Line, 4> lines;
        for (auto& line : lines) line = random_line(random, true);
        auto ray = rays_of<d4>(lines);
        (void)trace_lens({lens, Towards::Film, whole(lens), Clip::No},
                         lens.exact_indices(d4{} + 550), ray);
        ASSERT_EQ(fault_of(ray, lens, Towards::Film, 1e-9), "") << trial;
    }
}

}  // namespace
}  // namespace petzval::camera
