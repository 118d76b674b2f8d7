// SPDX-License-Identifier: Apache-2.0
#include "io/image/symmetric_mse.h"

#include <gtest/gtest.h>

#include <limits>

namespace petzval {
namespace {

TEST(SymmetricMse, MatchesTheFormula) {
    EXPECT_DOUBLE_EQ(symmetric_square(3, 1, 0), 4. / 5);
    EXPECT_DOUBLE_EQ(symmetric_square(3, 1, 2), 4. / (5 + 4));
    EXPECT_DOUBLE_EQ(symmetric_square(0, 1, 1), 1 / 1.5);
    EXPECT_EQ(symmetric_square(0, 0, 0), 0) << "black is not divided by zero";
    EXPECT_EQ(symmetric_square(7, 7, 0), 0);
}

TEST(SymmetricMse, TakesLostAndAddedLightAlikeAndIsBounded) {
    for (const double a : {0., 1e-9, 0.3, 1., 40., 1e30})
        for (const double b : {0., 1e-9, 0.3, 1., 40., 1e30})
            for (const double floor : {0., 0.1, 1e3}) {
                const double square = symmetric_square(a, b, floor);
                EXPECT_DOUBLE_EQ(square, symmetric_square(b, a, floor)) << a << " " << b;
                EXPECT_LE(square, kMostSymmetricMse);
                EXPECT_NEAR(symmetric_square(1000 * a, 1000 * b, 1000 * floor), square, 1e-12);
            }
    EXPECT_DOUBLE_EQ(symmetric_square(0, 1, 0), kMostSymmetricMse);
}

TEST(SymmetricMse, ToneOfEvenGreyIsTheGrey) {
    const Tone tone = tone_of(std::vector<double>(100, 0.3));
    EXPECT_NEAR(tone.log_average, 0.3, 1e-12);
    EXPECT_NEAR(tone.mid_grey, 0.3, 1e-12);
    EXPECT_NEAR(floor_of_symmetric_mse(tone), 0.075, 1e-12);
}

TEST(SymmetricMse, ToneIsTheLogAverageOfWhatShows) {
    // Black and what is no number do not count.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NEAR(tone_of({0.1, 0.4, 0, -1, nan}).mid_grey, 0.2, 1e-12);
    EXPECT_EQ(tone_of({0, 0}).mid_grey, 0);
    EXPECT_EQ(tone_of({}).mid_grey, 0);
}

TEST(SymmetricMse, NoMoreThanATenthIsBrighterThanWhite) {
    // A fifth of the pixels is a thousand times brighter: 0.18 of them is the mid-grey.
    std::vector<double> luminances(80, 1.);
    luminances.resize(100, 1000.);
    EXPECT_NEAR(tone_of(luminances).mid_grey, 180, 1e-9);
    // A twentieth may clip.
    std::vector<double> few(95, 1.);
    few.resize(100, 1000.);
    EXPECT_LT(tone_of(few).mid_grey, 2);
}

}  // namespace
}  // namespace petzval
