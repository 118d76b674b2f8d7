// SPDX-License-Identifier: Apache-2.0
#include "core/scene/texel_block.h"

#include <gtest/gtest.h>

#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Random;

TEST(TexelBlock, KeepsWhatRadiancePicturesHold) {
    // Three mantissas of 8 bits beside one exponent, over 13 stops among the eight texels.
    Random random(1);
    for (int scale = -60; scale <= 60; ++scale) {
        std::array<f4, 8> texels{};
        for (int i = 0; i < 8; ++i)
            for (int c = 0; c < 3; ++c)
                texels[i][c] = std::ldexp(std::floor(256 * random.next()), scale - 2 * (i % 7));
        const TexelBlock block(texels);
        for (int i = 0; i < 8; ++i)
            for (int c = 0; c < 3; ++c) ASSERT_EQ(block.colour(i)[c], texels[i][c]) << scale;
    }
}

TEST(TexelBlock, RoundsOtherNumbersToElevenBits) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        std::array<f4, 8> texels{};
        for (f4& texel : texels)
            for (int c = 0; c < 3; ++c) texel[c] = std::pow(10.f, 8 * random.next() - 4);
        const TexelBlock block(texels);
        for (int k = 0; k < 8; ++k)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(block.colour(k)[c], texels[k][c], 0x1p-11f * texels[k][c]);
    }
    // The largest and the smallest floats.
    const f4 large = splat(std::numeric_limits<float>::max());
    EXPECT_LE(TexelBlock(std::span(&large, 1)).colour(0)[1], large[1]);
    EXPECT_GT(TexelBlock(std::span(&large, 1)).colour(0)[1], 0.999f * large[1]);
    const f4 none{};
    EXPECT_EQ(TexelBlock(std::span(&none, 1)).colour(0)[2], 0.f);
}

// Every unit belongs to one texel; texels get what they weigh, and those without weight nothing.
TEST(TexelBlock, DividesItsShareByWeight) {
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        std::array<float, 8> weights;
        double sum = 0;
        for (float& w : weights) {
            w = random.next() < 0.3f ? 0.f : std::pow(10.f, 12 * random.next() - 6);
            sum += w;
        }
        const auto share = static_cast<uint32_t>(8 + std::pow(2.f, 24 * random.next()));
        TexelBlock block;
        block.divide(weights, share);
        if (sum == 0) continue;
        EXPECT_EQ(block.begin(8, share), share);
        uint32_t begin = 0;
        for (int k = 0; k < 8; ++k) {
            ASSERT_EQ(block.begin(k, share), begin);
            const uint32_t units = block.units(k, share);
            ASSERT_EQ(units > 0, weights[k] > 0) << k << " of " << share;
            ASSERT_NEAR(units, share * weights[k] / sum, 8 + share * 0x1p-11);
            if (units == 0) continue;
            ASSERT_EQ(block.find(begin, share), k);
            ASSERT_EQ(block.find(begin + units - 1, share), k);
            begin += units;
        }
        ASSERT_EQ(begin, share);
    }
}

}  // namespace
}  // namespace petzval
