// SPDX-License-Identifier: Apache-2.0
#include "io/image/reduce.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/support/pictures.h"

namespace petzval::io {
namespace {

using test::noise;
using test::picture;

// IEC 61966-2-1, here in doubles and in both directions.
double linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
double encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

constexpr Colour8 kBlack{0, 0, 0};

TEST(Reduced, KeepsEveryLevelOfAPictureOfTheSameSize) {
    Picture p = picture(256, 1, {"R", "G", "B"});
    for (size_t i = 0; i < 768; ++i) p.pixels[i] = float((i * 85) % 256) / 255.f;
    const Picture8 same = reduced(p, 256, 1, kBlack);
    for (size_t i = 0; i < 768; ++i) EXPECT_EQ(same.rgb[i], (i * 85) % 256);
}

TEST(Reduced, KeepsTheLightOfACheckerboard) {
    Picture p = picture(64, 64, {"R", "G", "B"});
    for (size_t i = 0; i < 64 * 64; ++i)
        for (size_t c = 0; c < 3; ++c) p.pixels[3 * i + c] = float((i / 64 + i) % 2);
    // Half of the light of white, which sRGB encodes as 187.5 of 255; the mean of codes is 127.5.
    for (const uint8_t value : reduced(p, 16, 16, kBlack).rgb) EXPECT_EQ(value, 188);
}

TEST(Reduced, IsTheMeanOverTheAreaOfEachPixel) {
    constexpr int w0 = 10, h0 = 7, w1 = 4, h1 = 3;
    const Picture p = noise(w0, h0, {"R", "G", "B"});
    const Picture8 small = reduced(p, w1, h1, kBlack);
    ASSERT_EQ(small.rgb.size(), size_t{w1} * h1 * 3);
    // On a grid so fine that each of its points lies in one pixel of both.
    constexpr int fine_w = std::lcm(w0, w1), fine_h = std::lcm(h0, h1);
    std::vector<double> sum(small.rgb.size());
    for (int y = 0; y < fine_h; ++y)
        for (int x = 0; x < fine_w; ++x)
            for (int c = 0; c < 3; ++c) {
                const int from = (y * h0 / fine_h * w0 + x * w0 / fine_w) * 3 + c;
                const int to = (y * h1 / fine_h * w1 + x * w1 / fine_w) * 3 + c;
                sum[size_t(to)] += linear(double(p.pixels[size_t(from)]));
            }
    for (size_t i = 0; i < sum.size(); ++i)
        EXPECT_NEAR(double(small.rgb[i]), 255 * encoded(sum[i] * w1 * h1 / (fine_w * fine_h)),
                    0.501);
}

TEST(Reduced, MixesWhatIsTransparentWithTheGround) {
    // Opaque, half transparent, and a colour that nobody sees.
    const Picture p = picture(3, 1, {"R", "G", "B", "A"}, {1, 1, 1, 1, 1, 1, 1, 0.5f, 1, 0, 0, 0});
    const Picture8 over = reduced(p, 3, 1, {38, 38, 200});
    const auto mixed = [](int ground) {
        return int(std::lround(255 * encoded((1 + linear(ground / 255.)) / 2)));
    };
    const std::vector<uint8_t> expected{
        255, 255, 255, uint8_t(mixed(38)), uint8_t(mixed(38)), uint8_t(mixed(200)), 38, 38, 200};
    EXPECT_EQ(over.rgb, expected);
}

TEST(Reduced, TakesChannelsByNameAndClamps) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Picture p = picture(2, 1, {"depth.Z", "B", "G", "R"}, {9, 0.2f, 0.4f, 7, 9, nan, -1, 1});
    EXPECT_EQ(reduced(p, 2, 1, kBlack).rgb, (std::vector<uint8_t>{255, 102, 51, 255, 0, 0}));
}

TEST(Reduced, AsksForEachRowOnceAndInTurn) {
    PictureLayout layout;
    layout.width = 5;
    layout.height = 9;
    layout.channels = {"R", "G", "B"};
    int next = 0;
    const PictureRows rows(layout, [&](int y, float* row) {
        EXPECT_EQ(y, next++);
        std::fill_n(row, 15, 1.f);
    });
    EXPECT_EQ(reduced(rows, 2, 4, kBlack).rgb, std::vector<uint8_t>(24, 255));
    EXPECT_EQ(next, 9);
}

TEST(Reduced, RefusesToEnlarge) {
    const Picture p = picture(4, 4, {"R", "G", "B"});
    EXPECT_THROW((void)reduced(p, 5, 4, kBlack), std::invalid_argument);
    EXPECT_THROW((void)reduced(p, 4, 0, kBlack), std::invalid_argument);
    EXPECT_THROW((void)reduced(picture(4, 4, {"Y"}), 4, 4, kBlack), std::invalid_argument);
}

}  // namespace
}  // namespace petzval::io
