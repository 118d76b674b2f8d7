// SPDX-License-Identifier: Apache-2.0
// Pixels of a pilot: they stand for the frame without a bias, and what they say of the rest
// holds.
#include "apps/plan/pilot_pixels.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

constexpr V2i kSize{160, 90};
const FilmMap kCorner{{4, 3}, {8, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}};

std::vector<camera::FilmRegion> regions() {
    const auto of = [](std::vector<Rect> rects) { return camera::FilmRegion{std::move(rects)}; };
    return {of({{20, 10, 40, 20}}), of({{30, 15, 50, 30}, {100, 50, 102, 51}}),
            of({{5, 80, 8, 83}})};
}

double share_of(const PilotPixels& chosen, const Rect& r) {
    double sum = 0;
    for (const PilotPixel& pixel : chosen.pixels)
        if (pixel.pixel[0] >= r.x0 && pixel.pixel[0] < r.x1 && pixel.pixel[1] >= r.y0 &&
            pixel.pixel[1] < r.y1)
            sum += pixel.weight;
    return sum;
}

// The share of a part of the frame, as a mean over seeds: five parts, one of them within two
// regions, one within a region that is sampled wholly, one in the corner that is emphasized.
TEST(PilotPixels, StandForTheFrameWithoutABias) {
    for (const Rect part : {Rect{32, 16, 36, 19}, Rect{5, 80, 8, 83}, Rect{0, 0, 30, 20},
                            Rect{90, 40, 140, 80}, Rect{0, 0, 160, 90}}) {
        test::Moments share;
        for (uint32_t seed = 0; seed < 200; ++seed)
            share.add(share_of(choose_pilot_pixels(kSize, 400, regions(), kCorner, seed), part));
        const double truth = double(part.width()) * part.height() / (160. * 90);
        EXPECT_TRUE(test::agrees(share, truth, 1e-9))
            << part.x0 << ' ' << part.y0 << ": " << share.mean() << ' ' << truth;
    }
}

TEST(PilotPixels, RegionsAndEmphasisGetTheirOwn) {
    const PilotPixels chosen = choose_pilot_pixels(kSize, 400, regions(), kCorner, 0);
    const auto count = [&](const Rect& r) {
        int n = 0;
        for (const PilotPixel& pixel : chosen.pixels)
            n += pixel.pixel[0] >= r.x0 && pixel.pixel[0] < r.x1 && pixel.pixel[1] >= r.y0 &&
                 pixel.pixel[1] < r.y1;
        return n;
    };
    EXPECT_GE(count({20, 10, 40, 20}), 25) << "33 of its own, less those drawn twice";
    EXPECT_EQ(count({5, 80, 8, 83}), 9) << "all of a small region";
    EXPECT_GT(count({0, 0, 40, 30}), 2 * count({120, 60, 160, 90}));
    std::set<std::array<int, 2>> pixels;
    for (const PilotPixel& pixel : chosen.pixels) pixels.insert(pixel.pixel);
    EXPECT_EQ(pixels.size(), chosen.pixels.size()) << "none twice";
}

// Dim pictures have small values.
TEST(PilotPixels, OfAnEmphasisOnlyRatiosCount) {
    FilmMap dim = kCorner;
    for (double& value : dim.values) value *= 0x1p-40;
    const PilotPixels chosen = choose_pilot_pixels(kSize, 400, regions(), kCorner, 0),
                      of_dim = choose_pilot_pixels(kSize, 400, regions(), dim, 0);
    ASSERT_EQ(of_dim.pixels.size(), chosen.pixels.size());
    for (size_t i = 0; i < chosen.pixels.size(); ++i) {
        EXPECT_EQ(of_dim.pixels[i].pixel, chosen.pixels[i].pixel);
        EXPECT_EQ(of_dim.pixels[i].weight, chosen.pixels[i].weight);
    }
    EXPECT_EQ(of_dim.density.values, chosen.density.values);
}

TEST(PilotPixels, SmallFramesAreLookedAtWholly) {
    const PilotPixels chosen = choose_pilot_pixels({20, 10}, 200, {}, kCorner, 3);
    EXPECT_EQ(chosen.pixels.size(), 200u);
    EXPECT_TRUE(chosen.all_certain);
    EXPECT_NEAR(share_of(chosen, {0, 0, 20, 10}), 1, 1e-12);
    EXPECT_EQ(chosen.unseen({20, 10}, kCorner), 0);
}

// An error that only a part of the frame has, which may be anywhere: as large as it can be while
// the bound does not cover it, in at most 5 % of the cases no pilot pixel falls on it.
TEST(PilotPixels, WhatIsUnseenIsSeldomMoreThanItsBound) {
    const FilmMap even;
    int missed = 0;
    constexpr int kCases = 2000;
    for (int i = 0; i < kCases; ++i) {
        const auto seed = static_cast<uint32_t>(i);
        const PilotPixels chosen = choose_pilot_pixels(kSize, 300, {}, kCorner, seed);
        const double share = chosen.unseen(kSize, even);
        // Scattered pixels: stratified pilot pixels would meet what lies together more surely.
        bool met = false;
        for (const PilotPixel& pixel : chosen.pixels)
            met = met || hash32(hash32(seed, static_cast<uint32_t>(pixel.pixel[0])),
                                static_cast<uint32_t>(pixel.pixel[1])) < share * 0x1p32;
        missed += !met;
    }
    const double allowed = 0.05 * kCases;
    EXPECT_LE(missed, allowed + 2.58 * std::sqrt(allowed)) << "99 %";
    EXPECT_GT(missed, 0) << "the bound is not far away";
}

// Grids whose cells do not nest, against every pixel.
TEST(PilotPixels, UnseenIsTheWorstPixels) {
    const PilotPixels chosen = choose_pilot_pixels(kSize, 400, {}, kCorner, 0);
    FilmMap most{{3, 5}, {}};
    for (uint32_t i = 0; i < 15; ++i) most.values.push_back(to_unit_float(hash32(7, i)));
    double worst = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x)
            worst = std::max(worst, most.at(kSize, x, y) / chosen.density.at(kSize, x, y));
    EXPECT_NEAR(chosen.unseen(kSize, most), 3 * worst / (160. * 90), 1e-12);
}

TEST(PilotPixels, MoreRegionsThanLooksForThemLeaveTheEvenOnes) {
    std::vector<camera::FilmRegion> many;
    for (int i = 0; i < 200; ++i)
        many.push_back({{{i % 40 * 4, i / 40 * 10, i % 40 * 4 + 4, i / 40 * 10 + 5}}});
    test::Moments share;
    for (uint32_t seed = 0; seed < 100; ++seed) {
        const PilotPixels chosen = choose_pilot_pixels(kSize, 256, many, kCorner, seed);
        EXPECT_LE(chosen.pixels.size(), 300u);
        share.add(share_of(chosen, {0, 0, 100, 60}));
    }
    EXPECT_TRUE(test::agrees(share, 100. * 60 / (160. * 90), 1e-9)) << share.mean();
    const PilotPixels chosen = choose_pilot_pixels(kSize, 256, many, kCorner, 0);
    EXPECT_EQ(chosen.regions.size(), 64u);
}

TEST(PilotPixels, UnseenIsLessWhereMoreIsLookedAt) {
    const FilmMap even;
    const double few = choose_pilot_pixels(kSize, 300, {}, even, 0).unseen(kSize, even),
                 many = choose_pilot_pixels(kSize, 3000, {}, even, 0).unseen(kSize, even);
    EXPECT_NEAR(few, 3 / 300., 0.1 * few);
    EXPECT_NEAR(many, 3 / 3000., 0.1 * many);
    // Errors that can only be in the corner, where half of the pilot pixels go by emphasis.
    FilmMap corner{{4, 3}, std::vector<double>(12, 0.)};
    corner.values[0] = 1;
    EXPECT_LT(choose_pilot_pixels(kSize, 300, {}, corner, 0).unseen(kSize, corner), few / 2);
}

}  // namespace
}  // namespace petzval::apps
