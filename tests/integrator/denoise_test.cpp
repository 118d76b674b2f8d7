// SPDX-License-Identifier: Apache-2.0
// Denoising of pictures whose truth is known.
#include "integrator/denoise/denoise.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "integrator/render/executor.h"
#include "tests/support/statistics.h"

namespace petzval::integrator {
namespace {

constexpr V2i kFrame{96, 80};
constexpr Rect kWhole{0, 0, kFrame.x, kFrame.y};

/// A picture: the true colour of a pixel, and what guides there.
struct NoisyPicture {
    std::function<V3f(int x, int y)> truth;
    std::function<Guide(int x, int y)> guide = [](int, int) { return Guide{}; };
};

/// A sample is the truth times a number, whose mean is 1. chance: that it is not 0.
Film film_of(const NoisyPicture& scene, uint32_t samples, float chance, uint32_t seed,
             Rect crop = kWhole) {
    Film film(kFrame, crop, {}, {}, {.halves = true});
    const Rect there = film.pixels();
    for (int y = there.y0; y < there.y1; ++y)
        for (int x = there.x0; x < there.x1; ++x) {
            test::Random random(seed + static_cast<uint32_t>(y * kFrame.x + x));
            const V3f truth = scene.truth(x, y);
            for (uint32_t i = 0; i < samples; ++i) {
                const float u = random.next(), v = random.next();
                const float factor = u < chance ? 2 * v / chance : 0;
                FilmSample sample;
                sample.colour = Rgb(truth.x, truth.y, truth.z) * factor;
                sample.guide = scene.guide(x, y);
                film.add(x, y, i, sample);
            }
        }
    return film;
}

Denoised denoised(const Film& film, int threads = 1) {
    ThreadExecutor executor(threads);
    return *denoise(film, executor);
}

struct Errors {
    double noisy = 0, denoised = 0, stated = 0;  ///< mean squares
    double z = 0;  ///< of stated - denoised, by blocks of 16 x 16 pixels
};

Errors errors_of(const Film& film, const Denoised& picture, const NoisyPicture& scene) {
    constexpr int kBlock = 16;
    Errors out;
    std::vector<double> blocks(size_t(kFrame.x / kBlock * (kFrame.y / kBlock)));
    const double pixels = double(kFrame.x) * kFrame.y;
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x) {
            const size_t at = picture.offset(x, y);
            const double truth = double(scene.truth(x, y).x);
            const double square = std::pow(double(picture.colour[at].x) - truth, 2);
            out.noisy += std::pow(double(film.colour(x, y).x) - truth, 2) / pixels;
            out.denoised += square / pixels;
            out.stated += double(picture.squared_error[at].x) / pixels;
            blocks[size_t(y / kBlock * (kFrame.x / kBlock) + x / kBlock)] +=
                double(picture.squared_error[at].x) - square;
        }
    double sum = 0, squares = 0;
    for (const double block : blocks) {
        sum += block;
        squares += block * block;
    }
    out.z = sum / std::sqrt(squares);
    return out;
}

float wave(int x, int y) {
    return 2 + std::sin(0.07f * static_cast<float>(x)) * std::cos(0.05f * static_cast<float>(y));
}

const NoisyPicture kSmooth{[](int x, int y) { return V3f(wave(x, y)); }};
/// Fine stripes that the albedo has too, in smooth light.
const NoisyPicture kStripes{
    [](int x, int y) { return V3f((x + y) % 4 < 2 ? 0.6f : 0.4f) * wave(x, y); },
    [](int x, int y) {
        return Guide{true, V3f((x + y) % 4 < 2 ? 0.6f : 0.4f), V3f(0, 0, 1), 3};
    }};

/// The same stripes, of which the guides know nothing.
const NoisyPicture kHidden{kStripes.truth};

TEST(Denoiser, SmoothLightHasFarLessNoise) {
    const Film film = film_of(kSmooth, 32, 0.5f, 1);
    const Errors errors = errors_of(film, denoised(film), kSmooth);
    EXPECT_LT(errors.denoised, 0.05 * errors.noisy);
}

// What the guides have is kept: a mean of neighbours would be 25 times worse.
TEST(Denoiser, TexturesAreKept) {
    const Film film = film_of(kStripes, 32, 0.5f, 2);
    const Errors errors = errors_of(film, denoised(film), kStripes);
    EXPECT_LT(errors.denoised, 0.1 * errors.noisy);
    NoisyPicture blind = kStripes;
    blind.guide = kSmooth.guide;
    const Film unguided = film_of(blind, 32, 0.5f, 2);
    EXPECT_LT(errors.denoised, 0.5 * errors_of(unguided, denoised(unguided), blind).denoised);
}

// An edge that the noise of the samples hides, and a pilot estimate shows. With weights from the
// samples in both estimates the error is 0.037 of that without.
TEST(Denoiser, FaintEdgesAreFoundInNoise) {
    const NoisyPicture edge{[](int x, int) { return V3f(x < kFrame.x / 2 ? 1.f : 1.5f); }};
    double noisy = 0, left = 0;
    for (uint32_t seed = 0; seed < 4; ++seed) {
        const Film film = film_of(edge, 32, 0.5f, 11 + 1000 * seed);
        const Errors errors = errors_of(film, denoised(film), edge);
        noisy += errors.noisy, left += errors.denoised;
    }
    EXPECT_LT(left, 0.028 * noisy);
}

// Grains that no guide shows, at noise that is less or more than they are. With 48 samples the
// first estimate alone has 1.07 times the error of the picture.
TEST(Denoiser, DetailThatNoGuideShowsIsNoWorseThanWithout) {
    const NoisyPicture grains{[](int x, int y) {
        return V3f(test::Random(static_cast<uint32_t>(y * kFrame.x + x)).next() < 0.5f ? 1.f
                                                                                       : 1.4f);
    }};
    for (const uint32_t samples : {16u, 32u, 48u, 64u, 256u}) {
        const Film film = film_of(grains, samples, 1, 9);
        const Errors errors = errors_of(film, denoised(film), grains);
        EXPECT_LT(errors.denoised, 0.97 * errors.noisy) << samples;
    }
}

// Bright stripes of noise alone, and dark ones of grains that no guide shows: what is best for the
// bright ones would take the grains away. If those took part in the sums of the dark ones, the
// error in the dark would be 1.1 times that without denoising.
TEST(Denoiser, DarkDetailIsKeptBesideBrightNoise) {
    const auto is_dark = [](int x) { return x / 8 % 2 == 0; };
    const NoisyPicture stripes{[&](int x, int y) {
        const bool grain = test::Random(static_cast<uint32_t>(y * kFrame.x + x)).next() < 0.5f;
        return V3f(is_dark(x) ? grain ? 1.f : 1.4f : 10.f);
    }};
    const Film film = film_of(stripes, 64, 1, 10);
    const Denoised picture = denoised(film);
    std::array<double, 2> noisy{}, left{};  // bright, dark
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x) {
            const double truth = double(stripes.truth(x, y).x);
            noisy[is_dark(x)] += std::pow(double(film.colour(x, y).x) - truth, 2);
            left[is_dark(x)] += std::pow(double(picture.colour[picture.offset(x, y)].x) - truth, 2);
        }
    EXPECT_LT(left[0], 0.1 * noisy[0]) << left[0] / noisy[0];
    EXPECT_LT(left[1], 1.05 * noisy[1]) << left[1] / noisy[1];
}

// The stated error is without bias: over several pictures, each by its blocks. A denoiser of which
// one half saw the other one would state too little.
TEST(Denoiser, ItsStatedErrorIsTheTrueOne) {
    constexpr uint32_t kPictures = 6;
    for (const NoisyPicture* scene : {&kSmooth, &kStripes, &kHidden})
        for (const float chance : {1.f, 0.1f}) {
            double stated = 0, truth = 0, z = 0;
            for (uint32_t seed = 0; seed < kPictures; ++seed) {
                const Film film = film_of(*scene, 16, chance, 1000 * seed);
                const Errors errors = errors_of(film, denoised(film), *scene);
                stated += errors.stated / kPictures;
                truth += errors.denoised / kPictures;
                z += errors.z / std::sqrt(double(kPictures));
            }
            EXPECT_GT(test::two_sided_p(z), test::sidak()) << chance << " " << z;
            EXPECT_NEAR(stated / truth, 1, 0.3) << chance;
        }
}

// Where noise and detail are about as large, a pixel's own noise has a part in how much of it is
// taken away. The stated error leaves that out: over many pictures it is the true one.
TEST(Denoiser, ItsStatedErrorIsNoSmallerForWhatItWasFittedTo) {
    constexpr int kPictures = 120;
    double sum = 0, squares = 0, truth = 0;
    for (uint32_t seed = 0; seed < kPictures; ++seed) {
        const Film film = film_of(kHidden, 16, 1, 77000 + 1000 * seed);
        const Errors errors = errors_of(film, denoised(film), kHidden);
        const double apart = errors.stated - errors.denoised;
        sum += apart, squares += apart * apart, truth += errors.denoised;
    }
    const double mean = sum / kPictures,
                 deviation = std::sqrt((squares / kPictures - mean * mean) / double(kPictures - 1));
    EXPECT_GT(test::two_sided_p(mean / deviation), test::sidak()) << mean / deviation;
    EXPECT_LT(deviation, 0.01 * truth / kPictures);
}

// Light of a hundred-thousandth of a nit is denoised as light of a nit is.
TEST(Denoiser, DimPicturesAreDenoisedAsBrightOnes) {
    constexpr float kDim = 1e-5f;
    const NoisyPicture dim{[](int x, int y) { return kStripes.truth(x, y) * kDim; }};
    const Film film = film_of(kHidden, 64, 0.5f, 3), dim_film = film_of(dim, 64, 0.5f, 3);
    const double bright = errors_of(film, denoised(film), kHidden).denoised;
    const double scaled = errors_of(dim_film, denoised(dim_film), dim).denoised;
    EXPECT_NEAR(scaled / (double(kDim) * double(kDim)) / bright, 1, 0.01);
}

// A window never makes light: what comes of a pixel lies within what is about it.
TEST(Denoiser, NothingIsNegativeOrBrighterThanItsSamples) {
    const NoisyPicture edges{
        [](int x, int y) { return V3f(x < 40 ? 1e-3f : 1e4f, y < 30 ? 0.f : 1.f, 5); }};
    const Film film = film_of(edges, 4, 0.3f, 3);
    const Denoised picture = denoised(film);
    V3f most(0.f);
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x)
            for (uint32_t half : {0u, 1u})
                for (int c = 0; c < 3; ++c)
                    most[c] = std::max(most[c], film.half(x, y, half).colour[c]);
    for (const V3f& colour : picture.colour)
        for (int c = 0; c < 3; ++c) {
            ASSERT_GE(colour[c], 0);
            ASSERT_LE(colour[c], most[c] * 1.0001f);
        }
}

// One sample in a million is 1e9 times as bright: it does not spread.
TEST(Denoiser, FirefliesDoNotSpread) {
    Film film = film_of(kSmooth, 16, 1, 4);
    FilmSample firefly;
    firefly.colour = Rgb(1e9f);
    film.add(50, 40, 16, firefly);
    const Denoised picture = denoised(film);
    for (const V3f& colour : picture.colour) ASSERT_LT(colour.x, 10);
}

// A small lamp that every sample meets stays as it is, and its surroundings stay dark.
TEST(Denoiser, ALampOfOnePixelIsKept) {
    const NoisyPicture lamp{[](int x, int y) { return V3f(x == 50 && y == 40 ? 1e4f : 1.f); }};
    const Film film = film_of(lamp, 64, 1, 5);
    const Denoised picture = denoised(film);
    EXPECT_NEAR(picture.colour[picture.offset(50, 40)].x, 1e4, 3e3);
    for (int y = 30; y < 50; ++y)
        for (int x = 40; x < 60; ++x)
            if (x != 50 || y != 40)
                EXPECT_LT(picture.colour[picture.offset(x, y)].x, 2) << x << " " << y;
}

TEST(Denoiser, BlackPicturesAndSinglePixelsAreNoFault) {
    const NoisyPicture black{[](int, int) { return V3f(0.f); }};
    for (const V3f& colour : denoised(film_of(black, 4, 1, 6)).colour) ASSERT_EQ(colour, V3f(0));
    for (const uint32_t samples : {0u, 1u, 2u, 3u})
        for (const V3f& colour : denoised(film_of(kSmooth, samples, 1, 6)).colour)
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(colour[c])) << samples;
    // One sample stays as it is: the half without samples does not make it darker.
    const Film single = film_of(kSmooth, 1, 1, 6);
    EXPECT_EQ(denoised(single).colour[3 * kFrame.x + 5].x, single.colour(5, 3).x);
    Film film({1, 1}, {0, 0, 1, 1}, {}, {}, {.halves = true});
    FilmSample sample;
    sample.colour = Rgb(0.5f, 1, 2);
    for (uint32_t i = 0; i < 4; ++i) film.add(0, 0, i, sample);
    const V3f alone = denoised(film).colour.front();
    EXPECT_NEAR(alone.x, 0.5f, 1e-6);
    EXPECT_NEAR(alone.z, 2, 1e-5);
    // Pixels without two others about them are no fireflies.
    for (const int width : {1, 2}) {
        Film tiny({width, 1}, {0, 0, width, 1}, {}, {}, {.halves = true});
        for (int x = 0; x < width; ++x)
            for (uint32_t i = 0; i < 2; ++i) {
                sample.colour = Rgb(float(x + 1));
                tiny.add(x, 0, i, sample);
            }
        for (const V3f& colour : denoised(tiny).colour) EXPECT_GE(colour.x, 0.9f) << width;
    }
}

// A lamp that few samples meet does not shine on the dark about it.
TEST(Denoiser, TheDarkBesideALampStaysDark) {
    const NoisyPicture lamp{[](int x, int y) {
        return V3f(std::abs(x - 48) < 2 && std::abs(y - 40) < 2 ? 1e5f : 0.f);
    }};
    for (const auto& [chance, samples] : {std::pair(0.3f, 16u), {0.2f, 32u}})
        for (const uint32_t seed : {11u, 12000u, 13000u, 140000u}) {
            const Denoised picture = denoised(film_of(lamp, samples, chance, seed));
            for (int y = 0; y < kFrame.y; ++y)
                for (int x = 0; x < kFrame.x; ++x)
                    if (std::max(std::abs(x - 48), std::abs(y - 40)) > 3)
                        ASSERT_LT(picture.colour[picture.offset(x, y)].x, 5)
                            << x << " " << y << ", " << chance;
        }
}

TEST(Denoiser, CropsAndThreadsHaveTheSameBytes) {
    const Film film = film_of(kStripes, 32, 0.5f, 7);
    const Denoised whole = denoised(film), by_three = denoised(film, 3);
    EXPECT_EQ(whole.colour, by_three.colour);
    for (const Rect& crop : {Rect{0, 0, 5, 7}, Rect{33, 20, 90, 61}, Rect{95, 79, 96, 80}}) {
        const Denoised part = denoised(film_of(kStripes, 32, 0.5f, 7, crop));
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) {
                ASSERT_EQ(part.colour[part.offset(x, y)], whole.colour[whole.offset(x, y)]);
                ASSERT_EQ(part.squared_error[part.offset(x, y)],
                          whole.squared_error[whole.offset(x, y)]);
            }
    }
}

// Each bin is a multiple of the colour, in every sample. So is the denoised one, also where a
// firefly in the dark is taken away.
TEST(Denoiser, BinsHaveTheSharesOfTheColour) {
    constexpr Bins kBins{400, 100, 3};
    Film film(kFrame, kWhole, {}, kBins, {.halves = true});
    Bands bands;
    bands.nm = f4{450, 550, 650, 750};  // the last one is in no bin
    bands.pdf = f4{0.01f, 0.01f, 0.01f, 0.01f};
    bands.on = m4{-1, -1, -1, -1};
    bands.spectral = true;
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x) {
            test::Random random(static_cast<uint32_t>(y * kFrame.x + x));
            for (uint32_t i = 0; i < 16; ++i) {
                const float light = x < 40 ? 0 : wave(x, y) * 2 * random.next(),
                            nits = x == 20 && y == 40 && i == 3 ? 1e5f : light;
                FilmSample sample;
                sample.colour = Rgb(nits);
                film.add(x, y, i, sample, {i % kReplicates, f4{1, 2, 3, 4} * nits, V3f(nits)},
                         bands);
            }
        }
    const Denoised picture = denoised(film);
    ASSERT_EQ(picture.bins.size(), 3 * picture.colour.size());
    for (size_t at = 0; at < picture.colour.size(); ++at) {
        const float nits = picture.colour[at].x;
        ASSERT_GE(nits, 0);
        for (size_t b = 0; b < 3; ++b) {
            const float expected = nits * static_cast<float>(b + 1) / 4;  // over 0.01 x 4 x 100 nm
            ASSERT_GE(picture.bins[3 * at + b], 0);
            ASSERT_NEAR(picture.bins[3 * at + b], expected, 1e-5f * expected) << at;
        }
    }
}

TEST(Denoiser, AStopLeavesNothing) {
    ThreadExecutor executor(2);
    const std::atomic<bool> stop = true;
    EXPECT_FALSE(denoise(film_of(kSmooth, 2, 1, 8), executor, &stop).has_value());
}

}  // namespace
}  // namespace petzval::integrator
