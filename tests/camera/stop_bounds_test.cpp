// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/stop_bounds.h"

#include <gtest/gtest.h>

#include "camera/models/lens_camera.h"
#include "camera/models/stop_draw.h"
#include "core/sampling/warp.h"
#include "tests/support/chi_square.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

using test::Random;

constexpr float kFilmReach_mm = 20, kStopReach_mm = 7;

/// A cat's eye: a rim of 8 mm whose image moves across the stop by 0.6 mm for each mm of height.
bool cats_eye(float height_mm, V2f p) {
    return (p - V2f(0, 0.6f * height_mm)).length() <= 8;
}
StopBoundsByHeight cats_eyes(double area_mm2 = 49 * std::numbers::pi) {
    const auto passes = [](float height_mm, f8 x, f8 y) {
        m8 out;
        for (int i = 0; i < 8; ++i) out[i] = cats_eye(height_mm, {x[i], y[i]}) ? -1 : 0;
        return out;
    };
    return {passes, kFilmReach_mm, kStopReach_mm, area_mm2};
}
V2f anywhere(Random& random) {
    return uniform_disk(random.next2()) * kStopReach_mm;
}

TEST(StopBounds, HoldAllThatPasses) {
    const StopBoundsByHeight bounds = cats_eyes();
    Random random(1);
    int tested = 0, beside = 0;
    for (int i = 0; i < 200000; ++i) {
        const float height = kFilmReach_mm * random.next();
        const StopBounds* found = bounds.at(height);
        const V2f p = anywhere(random);
        if (!found || !cats_eye(height, p)) continue;
        ++tested;
        beside += !found->contain(p);
    }
    EXPECT_GT(tested, 50000);
    EXPECT_EQ(beside, 0);
}

TEST(StopBounds, AreLittleWiderThanWhatPasses) {
    const StopBoundsByHeight bounds = cats_eyes();
    for (const float height : {6.f, 12.f, 18.f}) {
        Random random(2);
        int open = 0, drawn = 0;
        ASSERT_NE(bounds.at(height), nullptr);
        for (; drawn < 20000; ++drawn)
            open += cats_eye(height, bounds.at(height)->sample(random.next2()));
        EXPECT_GT(open, 0.8 * drawn) << height;
    }
}

TEST(StopBounds, AreLeftOutWhereTheyDoNotHelp) {
    EXPECT_EQ(cats_eyes().at(0.5f), nullptr);     // nothing is cut on the axis
    EXPECT_EQ(cats_eyes(10.).at(19.f), nullptr);  // an iris smaller than what passes
    EXPECT_NE(cats_eyes().at(19.f), nullptr);
    EXPECT_NE(cats_eyes().at(25.f), nullptr);  // a filter reaches beyond the film
    EXPECT_EQ(StopBoundsByHeight().at(19.f), nullptr);
    const auto nothing = [](float, f8, f8) { return m8{}; };
    EXPECT_EQ(StopBoundsByHeight(nothing, 20, 7, 100).at(10), nullptr);
}

// Of a grid over u, each cell has the same area.
TEST(StopBounds, PointsAreUniform) {
    std::array<float, StopBounds::kRows> half_width{};
    for (size_t j = 3; j < 29; ++j) half_width[j] = 0.5f + 0.1f * float(j % 7);
    const StopBounds bounds(4, half_width);
    constexpr int kCells = 16, kDraws = 400000;
    std::array<double, kCells * kCells> found{};
    Random random(3);
    double area = 0;
    for (int i = 0; i < kDraws; ++i) {
        const V2f p = V2f(2 * random.next() - 1, 2 * random.next() - 1) * 4.f;
        area += bounds.contain(p) * 64. / kDraws;
        const V2f drawn = bounds.sample(random.next2());
        ASSERT_TRUE(bounds.contain(drawn * V2f(0.9999f, 1))) << drawn;
        found[size_t((drawn.x / 1.2f + 1) * 8) * kCells + size_t((drawn.y / 4 + 1) * 8)] += 1;
    }
    EXPECT_NEAR(area, double(bounds.area_mm2()), 0.02 * area);
    double squares = 0;
    int cells = 0;
    for (int x = 0; x < kCells; ++x)
        for (int y = 0; y < kCells; ++y) {
            double inside = 0;  // of the cell, by a fine grid
            for (int k = 0; k < 4096; ++k)
                inside += bounds.contain(V2f((float(x) + (float(k % 64) + 0.5f) / 64) / 8 - 1,
                                             (float(y) + (float(k / 64) + 0.5f) / 64) / 8 - 1) *
                                         V2f(1.2f, 4));
            const double expected =
                kDraws * inside / 4096 * 1.2 * 4 / 64 / double(bounds.area_mm2());
            if (expected < 20) continue;
            ++cells;
            squares += sqr(found[size_t(x * kCells + y)] - expected) / expected;
        }
    EXPECT_LT(squares, cells * 2.) << cells;
}

// Bounds that are wrong cost noise and nothing else.
TEST(StopDraw, WhatBoundsLeaveOutIsStillDrawn) {
    const Iris iris(Disk{}, 3);
    std::array<float, StopBounds::kRows> half_width{};
    for (size_t j = 20; j < 26; ++j) half_width[j] = 2.5f;
    const StopBounds bounds(3, half_width);
    for (const V2f& film : {V2f(0, 5), V2f(-3, 4), V2f(2, -8)}) {
        const StopDraw draw(iris, &bounds, film);
        Random random(4);
        test::Moments area, above;
        for (int i = 0; i < 400000; ++i) {
            const V2f p = draw.sample(random.next2());
            const float open = iris.transmits(p), density = draw.density(p, open);
            ASSERT_TRUE(density > 0 || open == 0);
            area.add(open > 0 ? double(open / density) : 0);
            above.add(open > 0 && p.dot(film) > 0 ? double(open / density) : 0);
        }
        EXPECT_TRUE(test::agrees(area, iris.area_mm2())) << area.mean();
        EXPECT_TRUE(test::agrees(above, iris.area_mm2() / 2)) << above.mean();
    }
}

// Bounds overhang an iris. What is drawn there is dark in one lane, and may be light in others, of
// which it must not count as never drawn.
TEST(StopDraw, SplitLanesHaveTheMeanOfEachAlone) {
    const auto mean = [](bool one_by_one) {
        const LensCamera camera(test::input_of(test::kGauss, DispersionMode::Split, 0.95));
        Bands bands = test::four_wavelengths();
        bands.nm = f4{410, 490, 560, 690};
        d4 sum{};
        constexpr uint32_t kDraws = 1 << 19;
        for (uint32_t i = 0; i < kDraws; ++i) {
            bands.hero = int(i % 4);
            const V2f u = Sampler(SamplerKind::Owen, 1, {bands.hero, 0, i / 4}).get2(Dim::Lens);
            const f4 weight = one_by_one ? 4 * camera.draw({17, 11}, u, test::alone(bands)).weight
                                         : camera.draw({17, 11}, u, bands).weight;
            for (int lane = 0; lane < 4; ++lane) sum[lane] += double(weight[lane]) / kDraws;
        }
        return sum;
    };
    const d4 split = mean(false), single = mean(true);
    for (int lane = 0; lane < 4; ++lane)
        EXPECT_NEAR(split[lane], single[lane], 2e-4 * single[lane]) << lane;
}

// Wide open in the corner. Drawn over the whole iris, 3 in 5 are lost there.
TEST(StopDraw, FewDrawsAreVignettedInTheCorner) {
    const LensCamera camera(test::input_of(test::kTakumar));
    Random random(5);
    int lost = 0;
    constexpr int kDraws = 4000;
    for (int i = 0; i < kDraws; ++i)
        lost += !(camera.draw({17, 11}, random.next2(), Bands::rgb()).weight[0] > 0);
    EXPECT_LT(lost, 0.25 * kDraws);
}

}  // namespace
}  // namespace petzval::camera
