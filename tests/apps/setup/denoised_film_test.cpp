// SPDX-License-Identifier: Apache-2.0
// What is said of a denoised picture's error, where the truth is known.
#include "apps/setup/denoised_film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

constexpr V2i kFrame{96, 96};
constexpr float kTruth_nits = 2;

/// Even light. A sample is the truth times a number whose mean is 1; `chance`: that it is not 0.
std::shared_ptr<const DenoisedFilm> denoised_even_light(uint32_t seed, float chance_left,
                                                        float chance_right,
                                                        const V2i& frame = kFrame) {
    Film film(frame, {0, 0, frame.x, frame.y}, {}, {}, {.halves = true});
    test::Random random(seed);
    for (int y = 0; y < frame.y; ++y)
        for (int x = 0; x < frame.x; ++x) {
            const float chance = x < frame.x / 2 ? chance_left : chance_right;
            for (uint32_t i = 0; i < 16; ++i) {
                const float u = random.next(), v = random.next();
                FilmSample sample;
                sample.colour = Rgb(u < chance ? kTruth_nits * 2 * v / chance : 0.f);
                film.add(x, y, i, sample);
            }
        }
    integrator::TbbExecutor executor(1);
    return denoised_film(film, executor, false);
}

/// Mean squared error of columns by the measure that DenoisedError states. The light is even, so
/// that its mean over any square is the truth but for a few per cent.
double true_squared(const DenoisedFilm& film, int x0, int x1) {
    double squares = 0;
    const int height = film.picture.crop.height();
    for (int y = 0; y < height; ++y)
        for (int x = x0; x < x1; ++x)
            for (int c = 0; c < 3; ++c) {
                const V3f& colour = film.picture.colour[film.picture.offset(x, y)];
                squares += std::pow(double(colour[c]) - double(kTruth_nits), 2);
            }
    const double scale = double(kTruth_nits) * double(kTruth_nits);
    return squares / (3. * (x1 - x0) * height * (scale + film.floor_nits * film.floor_nits));
}

TEST(DenoisedFilm, ItsBoundsHoldTheTruth) {
    constexpr int kPictures = 40;
    for (const float chance : {1.f, 0.2f}) {
        int outside = 0;
        for (uint32_t seed = 0; seed < kPictures; ++seed) {
            const auto film = denoised_even_light(seed + 1, chance, chance);
            const double truth = std::sqrt(true_squared(*film, 0, kFrame.x));
            outside += truth < film->error.least() || truth > film->error.most();
        }
        // Chance of so many, where each is outside with 5 %.
        const double p = test::incomplete_beta(outside, kPictures - outside + 1, 0.05);
        EXPECT_TRUE(outside == 0 || p > test::sidak()) << chance << ": " << outside;
    }
}

TEST(DenoisedFilm, BoundsOfRegionsHoldTheTruth) {
    constexpr int kPictures = 40;
    for (const int width_px : {24, 48}) {
        int outside = 0, regions = 0;
        for (uint32_t seed = 0; seed < kPictures; ++seed) {
            const auto film = denoised_even_light(seed + 1, 0.2f, 0.2f);
            // Every second one: neighbours share windows of the denoiser.
            for (int x = 0; x < kFrame.x; x += 2 * width_px, ++regions) {
                const double truth = std::sqrt(true_squared(*film, x, x + width_px));
                const DenoisedError error =
                    film->blocks.over({x / kErrorBlock_px, 0, (x + width_px) / kErrorBlock_px,
                                       kFrame.y / kErrorBlock_px});
                outside += truth < error.least() || truth > error.most();
            }
        }
        const double p = test::incomplete_beta(outside, regions - outside + 1, 0.05);
        EXPECT_TRUE(outside == 0 || p > test::sidak()) << width_px << ": " << outside;
    }
}

// A noisy half beside a quiet one: each is told its own error, not that of the whole.
TEST(DenoisedFilm, PartsAreToldTheirOwnError) {
    constexpr int kPictures = 8, kMargin = 16;
    // Each half holds squares that know its error.
    constexpr V2i kWide{2 * kFrame.x, kFrame.y};
    double left = 0, right = 0, told_left = 0, told_right = 0;
    for (uint32_t seed = 0; seed < kPictures; ++seed) {
        const auto film = denoised_even_light(seed + 100, 0.05f, 1, kWide);
        left += true_squared(*film, 0, kWide.x / 2 - kMargin) / kPictures;
        right += true_squared(*film, kWide.x / 2 + kMargin, kWide.x) / kPictures;
        const int width = kWide.x / 2 - kMargin;
        for (int y = 0; y < kWide.y; ++y)
            for (int x = 0; x < width; ++x) {
                const auto told = [&](int column) {
                    const float error = film->error_about[film->picture.offset(column, y)];
                    return double(error) * double(error) / (kPictures * width * kWide.y);
                };
                told_left += told(x);
                told_right += told(kWide.x - 1 - x);
            }
    }
    EXPECT_GT(left, 16 * right);
    EXPECT_NEAR(std::sqrt(told_left / left), 1, 0.3);
    // Less than its own noise: an upper bound, and still nothing of the left half.
    EXPECT_GT(told_right, right);
    EXPECT_LT(told_right, left / 90);
}

// What is in doubt widens the bounds where all blocks have it in common. Where it is as likely more
// as less, it is in what the blocks part by.
TEST(DenoisedError, IsWiderByWhatIsInDoubt) {
    const auto blocks = [](double doubt, bool alike) {
        ErrorBlocks out(64, 64);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const bool even = (x / kErrorBlock_px + y / kErrorBlock_px) % 2 == 0;
                out.add(x, y, 1, 0.01, alike || even ? doubt : -doubt);
            }
        return out.over({0, 0, 8, 8});
    };
    const double sure = blocks(0, true).deviation;
    EXPECT_EQ(blocks(0.5, false).deviation, sure);
    // 64 blocks of 32 each: their sum, without what 64 that are independent would have.
    const double common = 32 * std::sqrt(64. * 63) / (kDeviations * 64 * 64);
    EXPECT_NEAR(blocks(0.5, true).deviation, std::hypot(sure, common), 1e-9);
}

TEST(DenoisedError, SaysAtMostWhereItIsBelowItsOwnNoise) {
    const DenoisedError known{0.01, 0.001}, unknown{0.001, 0.001}, negative{-0.01, 0.001};
    EXPECT_FALSE(known.is_at_most());
    EXPECT_DOUBLE_EQ(known.value(), 0.1);
    EXPECT_DOUBLE_EQ(known.least(), std::sqrt(0.01 - 0.00196));
    EXPECT_DOUBLE_EQ(known.most(), std::sqrt(0.01 + 0.00196));
    EXPECT_TRUE(unknown.is_at_most());
    EXPECT_DOUBLE_EQ(unknown.value(), unknown.most());
    EXPECT_EQ(unknown.least(), 0);
    EXPECT_EQ(negative.most(), 0);
}

}  // namespace
}  // namespace petzval::apps
