// SPDX-License-Identifier: Apache-2.0
// Errors of pictures in a chart: which picture is the better one, and the reference's own error.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/chart/chart_report.h"
#include "io/image/difference.h"
#include "tests/support/pictures.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

constexpr int kSide = 64;

bool in_disc(int pixel) {
    const int x = pixel % kSide - kSide / 2, y = pixel / kSide - kSide / 2;
    return x * x + y * y < kSide * kSide / 8;
}

/// A dark frame with a bokeh disc, of light that `disc(pixel)` gives.
template <class F>
io::Picture with_disc(const F& disc) {
    io::Picture p = test::picture(kSide, kSide, {"R", "G", "B"});
    for (int pixel = 0; pixel < kSide * kSide; ++pixel)
        for (size_t c = 0; c < 3; ++c)
            p.pixels[3 * size_t(pixel) + c] = float(0.02 + (in_disc(pixel) ? disc(pixel) : 0));
    return p;
}

/// A grey with normal noise of this deviation.
io::Picture noisy(double grey, double deviation, uint32_t seed) {
    test::Random random(seed);
    io::Picture p = test::picture(kSide, kSide, {"R", "G", "B"});
    for (float& value : p.pixels)
        value = float(grey + deviation * std::sqrt(-2 * std::log(1 - double(random.next()))) *
                                 std::cos(2 * std::numbers::pi * double(random.next())));
    return p;
}

// The disc of a lamp that few samples hit: 1 in 32 pixels shows 32 times its light. A pinhole,
// which has no disc at all, must not look better by far than this picture, whose light is right.
TEST(ChartErrors, LosingADiscOfLightIsNoBetterThanItsNoise) {
    const io::Picture reference = with_disc([](int) { return 1.; });
    const io::Picture lost = with_disc([](int) { return 0.; });
    test::Random random(3);
    const io::Picture fireflies =
        with_disc([&](int) { return random.next() < 1.f / 32 ? 32. : 0.; });
    const io::Flip flip(reference);
    const ChartSeed of_lost = errors_of(lost, reference, flip);
    const ChartSeed of_fireflies = errors_of(fireflies, reference, flip);
    EXPECT_GT(of_fireflies.relative_mse, 10 * of_lost.relative_mse) << "the fault that it had";
    EXPECT_NEAR(of_fireflies.symmetric_mse / of_lost.symmetric_mse, 1, 0.1);

    // As methods that take equally long.
    MeasuredCase of;
    of.methods.resize(2);
    of.methods[0].points = {{32, std::vector<ChartSeed>(5, of_lost)}};
    of.methods[1].points = {{32, std::vector<ChartSeed>(5, of_fireflies)}};
    for (MeasuredMethod& method : of.methods)
        for (ChartSeed& seed : method.points[0].seeds) seed.cpu_s = 1;
    EXPECT_NEAR(efficiencies(of)[1].to_first, 1, 0.1);

    // More samples of the lamp win, as they should.
    const io::Picture smooth = with_disc([&](int) { return 0.5 + double(random.next()); });
    EXPECT_LT(errors_of(smooth, reference, flip).symmetric_mse, of_lost.symmetric_mse / 5);
}

TEST(ChartErrors, DoNotDependOnTheUnitOfLight) {
    const io::Picture reference = noisy(1, 0.01, 1), picture = noisy(1, 0.1, 2);
    const auto brighter = [](io::Picture p) {
        for (float& value : p.pixels) value *= 1000;
        return p;
    };
    const ChartSeed of = errors_of(picture, reference, io::Flip(reference));
    EXPECT_NEAR(of.symmetric_mse, 0.01 / (1 + 1. / 16), 0.001);
    const io::Picture reference_1000 = brighter(reference);
    EXPECT_NEAR(
        errors_of(brighter(picture), reference_1000, io::Flip(reference_1000)).symmetric_mse,
        of.symmetric_mse, 1e-5 * of.symmetric_mse);
}

// What a perfect picture is charged for is the reference's own error: the mean of four parts has a
// quarter of the variance of one.
TEST(ChartErrors, OwnErrorOfTheReferenceIsWhatAPerfectPictureIsCharged) {
    std::vector<io::Picture> parts;
    for (uint32_t i = 0; i < 4; ++i) parts.push_back(noisy(0.5, 0.05, 10 + i));
    const ChartReference reference = reference_of(parts, 0);
    const double expected = 0.0025 / 4 / (0.25 + 0.25 / 16);
    EXPECT_NEAR(reference.symmetric_mse.value(), expected, 0.05 * expected);
    const ChartSeed perfect =
        errors_of(noisy(0.5, 0, 1), reference.picture, io::Flip(reference.picture));
    EXPECT_NEAR(perfect.symmetric_mse, reference.symmetric_mse.value(), 0.05 * expected);
}

TEST(ChartErrors, AFireflyInThePartsDoesNotHideItself) {
    std::vector<io::Picture> parts(4, noisy(0.5, 0, 1));
    const auto with_firefly = [&](float light) {
        auto some = parts;
        some[2].pixels[300] = light;
        const ChartReference reference = reference_of(some, 0);
        const ChartSeed perfect =
            errors_of(parts[0], reference.picture, io::Flip(reference.picture));
        const double values = double(parts[0].pixels.size());
        return std::pair{values * reference.symmetric_mse.value(), values * perfect.symmetric_mse};
    };
    const double floor = 0.5 / 4;
    // Six pairs, of which three have the firefly in the numerator, and none there and below.
    EXPECT_NEAR(with_firefly(1.5f).first, 3 * 1. / (0.25 + floor * floor) / 48, 1e-3);
    // A great one costs as much as it can in what is measured.
    EXPECT_NEAR(with_firefly(1000.f).first, 2, 1e-9);
    EXPECT_NEAR(with_firefly(1000.f).second, 2, 0.01);
}

}  // namespace
}  // namespace petzval::apps
