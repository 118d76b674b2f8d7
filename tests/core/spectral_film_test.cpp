// SPDX-License-Identifier: Apache-2.0
#include "core/film/spectral_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/film/film.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

constexpr Bins kBins{380, 10, 35};

Bands bands_at(f4 nm, f4 pdf, m4 on) {
    Bands bands;
    bands.nm = nm;
    bands.pdf = pdf;
    bands.on = on;
    bands.spectral = true;
    return bands;
}

std::vector<float> means(const SpectralFilm& film, size_t pixel, uint32_t count) {
    std::vector<float> out(static_cast<size_t>(film.bins().count));
    film.bin_means(pixel, count, out.data());
    return out;
}

void add_colour(SpectralFilm& film, size_t pixel, uint32_t index, const V3f& c) {
    film.add(pixel, Rgb(c.x, c.y, c.z), {index % kReplicates, f4{}, V3f(0.f)}, Bands::rgb());
}

TEST(SpectralFilm, ALaneGoesToItsBinAlone) {
    SpectralFilm film(2, kBins);
    // Both ends of the first bin, which is half open, and what lies outside of all.
    film.add(1, Rgb(0.f), {0, f4{3, 5, 7, 9}, V3f(1, 2, 3)},
             bands_at(f4{380, 390, 379.99f, 730}, f4{0.5f, 0.25f, 1, 1}, m4{-1, -1, -1, -1}));
    // A lane that is off adds nothing, whatever it holds; it is not one of the lanes that share.
    film.add(1, Rgb(0.f), {1, f4{8, NAN, 1, 1}, V3f(3, 6, 9)},
             bands_at(f4{405, 405, 405, 405}, f4{2, 0, 0, 0}, m4{-1, 0, 0, 0}));
    const std::vector<float> found = means(film, 1, 2);
    EXPECT_FLOAT_EQ(found[0], 3 / (0.5f * 4 * 10) / 2);
    EXPECT_FLOAT_EQ(found[1], 5 / (0.25f * 4 * 10) / 2);
    EXPECT_FLOAT_EQ(found[2], 8 / (2.f * 1 * 10) / 2);
    for (size_t i = 3; i < found.size(); ++i) EXPECT_EQ(found[i], 0.f) << i;
    EXPECT_EQ(film.xyz(1, 2), V3f(2, 4, 6));
    for (const float mean : means(film, 0, 2)) EXPECT_EQ(mean, 0.f);
    EXPECT_EQ(film.xyz(0, 2), V3f(0.f));
}

TEST(SpectralFilm, NoSamplesAreBlack) {
    const SpectralFilm film(1, kBins);
    for (const float mean : means(film, 0, 0)) EXPECT_EQ(mean, 0.f);
    EXPECT_EQ(film.xyz(0, 0), V3f(0.f));
}

// Wavelengths that are drawn more densely towards the red, with four lanes on or one.
TEST(SpectralFilm, AFlatSpectrumIsTheSameInEveryBin) {
    for (const int lanes : {1, 4}) {
        SpectralFilm film(1, kBins);
        constexpr uint32_t n = 1 << 16;
        for (uint32_t i = 0; i < n; ++i) {
            f4 nm, pdf;
            for (int lane = 0; lane < 4; ++lane) {
                const double u = std::fmod((i + 0.5) / n + 0.25 * lane, 1.);
                nm[lane] = static_cast<float>(360 + 470 * std::sqrt(u));
                pdf[lane] = static_cast<float>(2 * std::sqrt(u) / 470);
            }
            const m4 on = lanes == 1 ? m4{-1, 0, 0, 0} : m4{-1, -1, -1, -1};
            film.add(0, Rgb(0.f), {i % kReplicates, splat(3.f), V3f(0.f)}, bands_at(nm, pdf, on));
        }
        // The first bin has the fewest of the evenly spread samples, 148 of each lane; its edges
        // take or leave one of them at most.
        for (const float mean : means(film, 0, n)) EXPECT_NEAR(mean, 3, 3. / 148) << lanes;
    }
}

// Nearly normal: the sum of 12 uniform numbers, of mean 0 and variance 1.
float noise(test::Random& random) {
    float sum = -6;
    for (int i = 0; i < 12; ++i) sum += random.next();
    return sum;
}

// The mean over many pixels of the squared standard error is what theory says of the mean of n.
TEST(SpectralFilm, StandardErrorOfAKnownVariance) {
    const V3f sigma(1, 0.5f, 4), level(3, 100, 0);
    constexpr size_t pixels = 3000;
    test::Random random(1);
    for (const uint32_t n : {8u, 11u, 15u, 64u, 100u}) {
        SpectralFilm film(pixels, Bins{380, 350, 1});
        std::array<test::Moments, 4> squares;
        for (size_t p = 0; p < pixels; ++p) {
            for (uint32_t i = 0; i < n; ++i) {
                const float r = noise(random), g = noise(random), b = noise(random);
                add_colour(film, p, i, level + sigma * V3f(r, g, b));
            }
            const V3f error = film.standard_error(p, {0, n});
            for (int c = 0; c < 3; ++c) squares[size_t(c)].add(double(error[c]) * error[c]);
            const double light = film.luminance_error(p, {0, n});
            squares[3].add(light * light);
        }
        const double r = 0.2126 * sigma.x, g = 0.7152 * sigma.y, b = 0.0722 * sigma.z;
        const std::array<double, 4> variance{sigma.x * sigma.x, sigma.y * sigma.y,
                                             sigma.z * sigma.z, r * r + g * g + b * b};
        for (size_t c = 0; c < 4; ++c) {
            const test::Moments& m = squares[c];
            EXPECT_TRUE(test::agrees(m, variance[c] / n))
                << n << " samples, number " << c << ": " << m.mean() * n / variance[c];
            EXPECT_LT(m.standard_error(), 0.02 * m.mean());  // so that the test has teeth
        }
    }
}

// A range that begins anywhere: the replicates that have one sample more are others.
TEST(SpectralFilm, StandardErrorOfARangeThatDoesNotBeginAtZero) {
    constexpr size_t pixels = 3000;
    constexpr SampleRange kRange{5, 16};
    test::Random random(2);
    SpectralFilm film(pixels, Bins{380, 350, 1});
    test::Moments squares;
    for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t i = kRange.first; i < kRange.end; ++i)
            add_colour(film, p, i, V3f(10 + noise(random), 0, 0));
        const double error = double(film.standard_error(p, kRange).x);
        squares.add(error * error);
    }
    EXPECT_TRUE(test::agrees(squares, 1. / kRange.count())) << squares.mean() * kRange.count();
}

TEST(SpectralFilm, FewerSamplesThanReplicatesTellNoError) {
    constexpr float unknown = std::numeric_limits<float>::infinity();
    SpectralFilm film(1, kBins);
    for (uint32_t n = 0; n < kReplicates; ++n) {
        EXPECT_EQ(film.standard_error(0, {0, n}), V3f(unknown)) << n;
        EXPECT_EQ(film.luminance_error(0, {0, n}), unknown) << n;
        add_colour(film, 0, n, V3f(1, 2, 3));
    }
    EXPECT_EQ(film.standard_error(0, {0, kReplicates}), V3f(0.f));
    EXPECT_EQ(film.luminance_error(0, {0, kReplicates}), 0.f);
}

// Spectral radiance of a lane that the colour does not see: beyond the sums of the bins.
TEST(SpectralFilm, RadianceBeyondTheRangeIsNoSample) {
    Film film({1, 1}, {0, 0, 1, 1}, {}, kBins);
    const Bands bands = bands_at(f4{405, 505, 605, 705}, splat(1e-3f), m4{-1, -1, -1, -1});
    FilmSample sample;
    film.add(0, 0, 3, sample, {3, f4{1e9f, 0, 0, 0}, V3f(0.f)}, bands);
    film.add(0, 0, 4, sample, {4, f4{1e7f, 0, 0, 0}, V3f(0.f)}, bands);
    EXPECT_EQ(film.left_out().too_large, 1u);
    EXPECT_EQ(film.left_out().index, 3u);
    film.add(0, 0, 5, sample, {5, f4{INFINITY, 0, 0, 0}, V3f(0.f)}, bands);
    EXPECT_EQ(film.left_out().too_large, 1u);
    EXPECT_EQ(film.left_out().not_finite, 1u);
    EXPECT_FLOAT_EQ(means(*film.spectral(), 0, 1)[2], 1e7f / (1e-3f * 4 * 10));
}

TEST(SpectralFilm, WhatIsNotFiniteIsLeftOutOfEverySum) {
    Film film({1, 1}, {0, 0, 1, 1}, {}, kBins);
    const Bands bands = bands_at(f4{405, 505, 605, 705}, splat(0.01f), m4{-1, -1, -1, -1});
    for (uint32_t i = 0; i < 9; ++i) {
        FilmSample sample;
        sample.colour = Rgb(i == 8 ? INFINITY : 1.f);
        const f4 radiance = splat(i == 8 ? INFINITY : 1.f);
        film.add(0, 0, i, sample, {i % kReplicates, radiance, V3f(radiance[0])}, bands);
    }
    ASSERT_EQ(film.sample_count(0, 0), 8u);
    EXPECT_EQ(film.left_out().not_finite, 1u);
    const SpectralFilm& spectral = *film.spectral();
    EXPECT_EQ(spectral.xyz(0, 8), V3f(1.f));
    EXPECT_EQ(spectral.standard_error(0, {0, 8}), V3f(0.f));
    EXPECT_FLOAT_EQ(means(spectral, 0, 8)[2], 1 / (0.01f * 4 * 10));
}

}  // namespace
}  // namespace petzval
