// SPDX-License-Identifier: Apache-2.0
// Estimates of a pilot against closed forms: pictures of nothing but a sky, whose only noise is
// that of the wavelengths drawn.
#include "apps/plan/pilot_error.h"

#include <gmock/gmock.h>

#include <cmath>

#include "io/image/symmetric_mse.h"
#include "tests/support/cli_spectral.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

constexpr uint32_t kSamples = 2;  ///< of a replicate: few, so that its mean is noisy

class PilotErrors : public CliSpectral {
  protected:
    PilotErrors() {
        TinyGltf nothing;
        add_perspective(nothing, "wide", 1.f);
        use(nothing);
        request_.scene = scene_;
        request_.size = {64, 36};
        job_.sampler = SamplerKind::Independent;
    }
    [[nodiscard]] std::unique_ptr<PilotModel> sky(const Pilot& pilot, float grey, bool noisy,
                                                  uint32_t samples = kSamples) const {
        SceneRequest request = request_;
        request.background = Rgb(grey, grey, grey);
        if (noisy) request.spectral.mode = SpectralMode::Wavelengths;
        auto model = pilot.model(set_up_render(request, [](const std::string&) {}), job_, {});
        pilot.sample(*model, samples);
        return model;
    }

    integrator::TbbExecutor executor_{2};
    SceneRequest request_;
    integrator::RenderJob job_;
};

// Half as bright, with a fifth of noise in a replicate's mean: within 2 % of
// the closed form. Denominators that share samples with the numerator, or whose noise stays, are
// further off.
TEST_F(PilotErrors, BiasHasNoBias) {
    constexpr double kA = 0.5, kB = 1, kFloor = 0.1;
    const double truth = io::symmetric_square(kA, kB, kFloor);
    test::Moments found, noise;
    for (uint32_t seed = 0; seed < 24; ++seed) {
        const Pilot pilot(request_.size, 2304, executor_, seed);
        const auto a = sky(pilot, kA, true), b = sky(pilot, kB, true);
        const PilotScale scale{a.get(), b.get(), kFloor};
        found.add(square_error(pilot, {{a.get(), 1}, {b.get(), -1}}, scale).mean);
        noise.add(noise_of(pilot, *b, {b.get(), b.get(), kFloor}).variances.back().mean);
    }
    EXPECT_GT(noise.mean(), 0.02) << "there is some";
    EXPECT_TRUE(test::agrees(found, truth, 0.02 * truth)) << found.mean() << ' ' << truth;
}

PilotNoise noise_in_blocks(double each) {
    PilotNoise noise;
    noise.blocks.fill(each);
    return noise;
}

// Samples of 10,000 times the light in three blocks of sixteen, of either or of both.
TEST(TypicalRatio, IsNotTurnedByAFewBrightSamples) {
    const PilotNoise hero = noise_in_blocks(3), split = noise_in_blocks(1);
    PilotNoise bright_hero = hero, bright_split = split;
    for (const size_t b : {2, 7, 11}) bright_hero.blocks[b] *= 1e4;
    for (const size_t b : {1, 7, 15}) bright_split.blocks[b] *= 1e4;
    EXPECT_EQ(typical_ratio(hero, split), 3);
    EXPECT_EQ(typical_ratio(bright_hero, split), 3);
    EXPECT_EQ(typical_ratio(hero, bright_split), 3);
    EXPECT_EQ(typical_ratio(bright_hero, bright_split), 3);
    EXPECT_EQ(typical_ratio(noise_in_blocks(0), split), std::nullopt);
}

TEST_F(PilotErrors, BlocksAddUpToTheNoise) {
    const Pilot pilot(request_.size, 500, executor_);
    const auto model = sky(pilot, 1, true);
    const PilotNoise noise = noise_of(pilot, *model, {model.get(), model.get(), 0.1});
    double sum = 0;
    for (const double block : noise.blocks) {
        EXPECT_GT(block, 0);
        EXPECT_LT(block, noise.variances.back().mean / 4) << "they are spread";
        sum += block;
    }
    EXPECT_NEAR(sum, noise.variances.back().mean, 1e-12);
}

// However bright the samples of a pilot pixel are, it counts no more than a pixel can be off.
TEST_F(PilotErrors, BlocksHoldNoMoreThanAPixelCanBeOff) {
    const Pilot pilot(request_.size, 500, executor_);
    const auto bright = sky(pilot, 1, true), dark = sky(pilot, 1e-3f, false);
    const PilotNoise noise = noise_of(pilot, *bright, {dark.get(), dark.get(), 1e-3});
    EXPECT_GT(noise.variances.back().mean, 1e3);
    double sum = 0;
    for (const double block : noise.blocks) sum += block;
    EXPECT_NEAR(sum, io::kMostSymmetricMse, 0.05);
}

// Twice as bright is as wrong as half as bright.
TEST_F(PilotErrors, IsSymmetric) {
    const Pilot pilot(request_.size, 500, executor_);
    const auto a = sky(pilot, 0.5f, false), b = sky(pilot, 1, false);
    const auto error = [&](const PilotModel& x, const PilotModel& y) {
        return square_error(pilot, {{&x, 1}, {&y, -1}}, {&x, &y, 0.1}).mean;
    };
    EXPECT_NEAR(error(*a, *b), error(*b, *a), 1e-9);
    EXPECT_NEAR(error(*a, *b), io::symmetric_square(0.5, 1, 0.1), 1e-6);
}

// The variance of a sample, against that of many samples.
TEST_F(PilotErrors, NoiseHasNoBias) {
    const Pilot reference(request_.size, 2304, executor_, 100);
    const auto many = sky(reference, 1, true, 256);
    const double truth =
        256 * noise_of(reference, *many, {many.get(), many.get(), 0.25}).variances.back().mean;
    test::Moments found;
    for (uint32_t seed = 0; seed < 24; ++seed) {
        const Pilot pilot(request_.size, 2304, executor_, seed);
        const auto few = sky(pilot, 1, true);
        found.add(kSamples *
                  noise_of(pilot, *few, {few.get(), few.get(), 0.25}).variances.back().mean);
    }
    EXPECT_TRUE(test::agrees(found, truth, 0.02 * truth)) << found.mean() << ' ' << truth;
}

TEST_F(PilotErrors, PartsCountWhatHoldsTheNoise) {
    const Pilot pilot(request_.size, 2304, executor_);
    const auto noisy = sky(pilot, 1, true);
    const double parts = noise_of(pilot, *noisy, {noisy.get(), noisy.get(), 0.25}).parts;
    EXPECT_GT(parts, 0.2 * static_cast<double>(pilot.pixels())) << "all pixels are alike";
    EXPECT_LE(parts, static_cast<double>(pilot.pixels()));
}

}  // namespace
}  // namespace petzval::apps
