// SPDX-License-Identifier: Apache-2.0
#include "io/image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/spectrum/colour.h"
#include "tests/support/statistics.h"

namespace petzval::io {
namespace {

Picture filled(int width, int height, const V3f& colour) {
    Picture p;
    p.width = p.full_width = width;
    p.height = p.full_height = height;
    p.channels = {"R", "G", "B"};
    for (int i = 0; i < width * height; ++i)
        p.pixels.insert(p.pixels.end(), {colour.x, colour.y, colour.z});
    return p;
}
Picture noise(int width, int height, uint32_t seed) {
    Picture p = filled(width, height, V3f(0));
    test::Random random(seed);
    for (float& v : p.pixels) v = random.next();
    return p;
}
V3f grey(float encoded) {
    return V3f(srgb_to_linear(encoded));
}
double flip(const Picture& a, const Picture& b) {
    return Flip(a).mean(b);
}

TEST(Flip, OfAPictureWithItselfIsNothing) {
    for (const uint32_t seed : {1u, 2u}) {
        const Picture p = noise(37, 23, seed);
        for (const float error : Flip(p).map(p)) EXPECT_EQ(error, 0.f);
    }
}

TEST(Flip, LiesBetween0And1AndDoesNotAskWhichIsTheReference) {
    const Picture a = noise(37, 23, 1), b = noise(37, 23, 2);
    const auto there = Flip(a).map(b), back = Flip(b).map(a);
    for (size_t i = 0; i < there.size(); ++i) {
        EXPECT_GT(there[i], 0.f);
        EXPECT_LE(there[i], 1.f);
        EXPECT_FLOAT_EQ(there[i], back[i]);
    }
}

// Of even patches the filters change nothing. With L* = 116 cbrt(Y) - 16: black and white are 100
// apart; the largest distance, of green (87.73, -75.61, 72.98 after Hunt) and blue (32.30, 25.58,
// -34.84), is 55.44 + sqrt(101.19^2 + 107.81^2) = 203.3, to the power of 0.7 41.28, the knee at
// 0.4 of it 16.51. 100^0.7 = 25.12: 0.95 + 0.05 (25.12 - 16.51) / (41.28 - 16.51) = 0.9674.
// Greys of sRGB 0.5 and 0.6 have Y 0.2140 and 0.3185, L* 53.39 and 63.22: 9.833^0.7 = 4.953, and
// 4.953 * 0.95 / 16.51 = 0.2850.
TEST(Flip, OfEvenPatchesIsWhatAHandComputes) {
    EXPECT_NEAR(flip(filled(40, 30, V3f(0)), filled(40, 30, V3f(1))), 0.9674, 2e-4);
    EXPECT_NEAR(flip(filled(40, 30, grey(0.5f)), filled(40, 30, grey(0.6f))), 0.2850, 5e-4);
    EXPECT_NEAR(flip(filled(9, 9, V3f(0, 1, 0)), filled(9, 9, V3f(0, 0, 1))), 1., 1e-4);
    EXPECT_NEAR(flip(filled(1, 1, V3f(0)), filled(1, 1, V3f(1))), 0.9674, 2e-4);
}

TEST(Flip, GrowsWithTheDifference) {
    double last = 0;
    for (const float encoded : {0.51f, 0.55f, 0.6f, 0.8f, 1.f}) {
        const double error = flip(filled(8, 8, grey(0.5f)), filled(8, 8, grey(encoded)));
        EXPECT_GT(error, last);
        last = error;
    }
}

// A checkerboard of single pixels is finer than the eye resolves at 67 pixels per degree, and one
// of large squares is not: with the same colours it differs more from their mean.
TEST(Flip, SeesCoarsePatternsBetterThanFineOnes) {
    const auto board = [](int side) {
        Picture p = filled(64, 64, V3f(0));
        for (int i = 0; i < 64 * 64; ++i)
            for (int c = 0; c < 3; ++c)
                p.pixels[size_t(3 * i + c)] = (i % 64 / side + i / 64 / side) % 2 ? 0.6f : 0.4f;
        return p;
    };
    const Picture mean = filled(64, 64, V3f(0.5f));
    const double fine = flip(mean, board(1)), coarse = flip(mean, board(16));
    EXPECT_LT(fine, 0.5 * coarse);
}

// One bright pixel, computed by hand: the eye's contrast leaves w of its luminance, which alone
// would be an error c; the detector of points, whose weights there are p across and s down, makes
// it c^(1 - sqrt(0.8 p s)). The detector of edges is 0 there.
TEST(Flip, CountsPointsForMore) {
    Picture point = filled(61, 61, V3f(0.2f));
    for (size_t c = 0; c < 3; ++c) point.pixels[3 * (30 * 61 + 30) + c] = 1.f;
    const double sigma = 0.5 * 0.082 * 67;
    double contrast = 0, smooth = 0, negative = 0;
    for (int x = -10; x <= 10; ++x)
        contrast += std::exp(-std::numbers::pi * std::numbers::pi * x * x / (67. * 67 * 0.0047));
    for (int x = -9; x <= 9; ++x) {
        const double g = std::exp(-x * x / (2 * sigma * sigma));
        smooth += g;
        negative += std::fmax(0, (1 - x * x / (sigma * sigma)) * g);
    }
    const auto even = static_cast<float>(0.2 + 0.8 / (contrast * contrast));
    const double alone = flip(filled(8, 8, V3f(0.2f)), filled(8, 8, V3f(even)));
    const double expected = std::pow(alone, 1 - std::sqrt(0.8 / (negative * smooth)));
    ASSERT_GT(expected, 1.2 * alone);
    const auto map = Flip(filled(61, 61, V3f(0.2f))).map(point);
    EXPECT_NEAR(map[30 * 61 + 30], expected, 1e-4);
    EXPECT_NEAR(map[0], 0.f, 1e-3f);
}

TEST(Flip, ShowsPicturesAsADisplayDoes) {
    const Picture bright = filled(8, 8, V3f(1)), brighter = filled(8, 8, V3f(7));
    EXPECT_EQ(flip(bright, brighter), 0.) << "both are white";
    EXPECT_GT(Flip(bright, -3).mean(brighter), 0.3);
    EXPECT_EQ(flip(filled(8, 8, V3f(0)), filled(8, 8, V3f(-1))), 0.);
    EXPECT_EQ(flip(filled(8, 8, V3f(0)), filled(8, 8, V3f(NAN))), 0.);
}

TEST(Flip, RefusesWhatCannotBeCompared) {
    const Flip of(filled(8, 8, V3f(0)));
    EXPECT_THROW(static_cast<void>(of.map(filled(8, 9, V3f(0)))), std::invalid_argument);
    Picture depth = filled(8, 8, V3f(0));
    depth.channels = {"X", "Y", "Z"};
    EXPECT_THROW(static_cast<void>(of.map(depth)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(Flip(Picture(), 0)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(Flip(filled(8, 8, V3f(0)), 0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace petzval::io
