// SPDX-License-Identifier: Apache-2.0
#include "core/scene/studio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace petzval {
namespace {

constexpr int kRows = 96;

V3f towards(int row, int column, int rows) {
    const double polar = std::numbers::pi * (row + 0.5) / rows;
    const double azimuth = std::numbers::pi * (column + 0.5) / rows;
    return {static_cast<float>(std::sin(polar) * std::cos(azimuth)),
            static_cast<float>(std::cos(polar)),
            static_cast<float>(std::sin(polar) * std::sin(azimuth))};
}

/// Luminance of a matt white surface of that normal: its irradiance over pi.
double white_nits(const Sky& sky, const V3f& normal) {
    double sum = 0;
    for (int i = 0; i < kRows; ++i) {
        const double step = std::numbers::pi / kRows;
        const double solid_angle = step * step * std::sin(step * (i + 0.5));
        for (int j = 0; j < 2 * kRows; ++j) {
            const V3f w = towards(i, j, kRows);
            sum += solid_angle * std::max(0.f, w.dot(normal)) * luminance(sky.radiance(w));
        }
    }
    return sum / std::numbers::pi;
}

TEST(StudioSky, ShowsShapesAndClipsNothingMatt) {
    const Sky sky = studio_sky();
    double least = 1e9, most = 0;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 16; ++j) {
            const double nits = white_nits(sky, towards(i, j, 8));
            least = std::min(least, nits);
            most = std::max(most, nits);
        }
    EXPECT_GT(most, 0.95);
    EXPECT_LT(most, 1.02);  // white is hardly clipped
    EXPECT_GT(least, 0.1);  // nothing is black
    EXPECT_LT(least, 0.2);
    // The three sides of a box that a camera in front sees.
    const double front = white_nits(sky, {0, 0, 1}), right = white_nits(sky, {1, 0, 0}),
                 top = white_nits(sky, {0, 1, 0});
    EXPECT_GT(front, 1.2 * right);
    EXPECT_GT(top, 1.1 * front);
}

TEST(StudioSky, IsGreyAndItsBoxesStandOutOfTheUsualView) {
    const Sky sky = studio_sky();
    for (int i = 0; i < 24; ++i)
        for (int j = 0; j < 48; ++j) {
            const Rgb found = sky.radiance(towards(i, j, 24));
            EXPECT_EQ(found[0], found[1]);
            EXPECT_EQ(found[0], found[2]);
        }
    // Behind the scene, from the floor to a little above the horizon.
    for (const float x : {-0.8f, -0.3f, 0.2f})
        for (const float y : {-0.6f, -0.25f, 0.1f}) {
            const float nits = sky.radiance(unit({x, y, -1.f}))[0];
            EXPECT_GT(nits, 0.12f);
            EXPECT_LT(nits, 0.35f) << x << " " << y;
        }
}

TEST(StudioSky, TurnsAndScales) {
    const Sky sky = studio_sky(), turned = studio_sky(90.f, 2.f);
    // Counter-clockwise seen from above: what was in front is on the right.
    const V3f key = unit({-0.7f, 0.6f, 0.8f});
    EXPECT_GT(sky.radiance(key)[0], 3.f);
    EXPECT_NEAR(turned.radiance({key.z, key.y, -key.x})[0], 2 * sky.radiance(key)[0], 0.02f);
    EXPECT_NEAR(turned.average_luminance(), 2 * sky.average_luminance(), 0.01f);
}

}  // namespace
}  // namespace petzval
