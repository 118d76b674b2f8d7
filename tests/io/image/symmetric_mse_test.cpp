// SPDX-License-Identifier: Apache-2.0
#include "io/image/symmetric_mse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

namespace petzval::io {
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

double floor_of(std::initializer_list<std::pair<double, double>> luminances_and_weights) {
    SymmetricFloor floor;
    for (const auto& [luminance, weight] : luminances_and_weights) floor.add(luminance, weight);
    return floor.floor();
}

TEST(SymmetricMse, FloorIsAQuarterOfMidGrey) {
    EXPECT_NEAR(floor_of({{0.3, 1}}), 0.075, 1e-12);
    EXPECT_NEAR(floor_of({{0.3, 1}, {0.3, 50}}), 0.075, 1e-12);
    // Lightness 1 and 2: the brighter one counts twice.
    EXPECT_NEAR(floor_of({{1, 1}, {8, 1}}), 0.25 * std::pow(8, 2 / 3.), 1e-12);
    EXPECT_NEAR(floor_of({{1, 2}, {8, 1}}), 0.25 * std::pow(8, 0.5), 1e-12);
}

TEST(SymmetricMse, BlackAndWhatIsNoNumberDoNotCount) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(floor_of({}), 0);
    EXPECT_EQ(floor_of({{0, 5}, {-1, 5}}), 0);
    EXPECT_NEAR(floor_of({{0.3, 1}, {0, 1000}, {-2, 3}, {nan, 1}}), 0.075, 1e-12);
    // Traces of light, which more samples find in black pixels, hardly do.
    EXPECT_NEAR(floor_of({{0.3, 1}, {1e-9, 10}}), 0.075, 0.075 * 0.3);
}

TEST(SymmetricMse, FloorFollowsTheScaleOfThePicture) {
    EXPECT_NEAR(floor_of({{100, 3}, {2000, 1}}), 1000 * floor_of({{0.1, 3}, {2, 1}}), 1e-9);
}

}  // namespace
}  // namespace petzval::io
