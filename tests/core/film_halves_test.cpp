// SPDX-License-Identifier: Apache-2.0
#include "core/film/film_halves.h"

#include <gtest/gtest.h>

#include "core/film/film.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

constexpr FilmKeeps kHalved{.halves = true};

FilmSample sample_of(const Rgb& colour, const Guide& guide = {}) {
    FilmSample sample;
    sample.colour = colour;
    sample.guide = guide;
    return sample;
}

Film one_pixel() {
    return {{1, 1}, {0, 0, 1, 1}, {}, {}, kHalved};
}

TEST(FilmHalves, HaveTheEvenAndTheOddSamples) {
    Film film = one_pixel();
    const Guide guide{true, V3f(0.5f, 0.25f, 1), V3f(0, -1, 0), 1};
    for (uint32_t i = 0; i < 8; ++i)
        film.add(0, 0, i, sample_of(Rgb(float(i), 1, 2), i < 4 ? guide : Guide{}));
    const auto even = film.half(0, 0, 0), odd = film.half(0, 0, 1);
    EXPECT_EQ(even.colour, V3f(3, 1, 2));
    EXPECT_EQ(odd.colour, V3f(4, 1, 2));
    // 0, 2, 4 and 6 have the variance 20 / 3, their mean a fourth of it.
    EXPECT_NEAR(even.variance.x, 5. / 3, 1e-6);
    EXPECT_EQ(even.variance.y, 0);
    // Samples that hit nothing count as 0.
    const std::array<float, kGuideNumbers> wanted{0.25f, 0.125f, 0.5f, 0, -0.5f, 0, 0, 0.5f};
    EXPECT_EQ(even.guide, wanted);
    EXPECT_EQ(odd.guide, wanted);
}

TEST(FilmHalves, OneSampleDoesNotKnowItsVariance) {
    Film film = one_pixel();
    film.add(0, 0, 0, sample_of(Rgb(3.f)));
    EXPECT_EQ(film.half(0, 0, 0).variance, V3f(9));
    EXPECT_EQ(film.half(0, 0, 1).colour, V3f(0));
    EXPECT_EQ(film.half(0, 0, 1).variance, V3f(0));
}

// In any order, and in parts that are added: the same bytes.
TEST(FilmHalves, AreTheSameInAnyOrder) {
    test::Random random(1);
    Film forwards = one_pixel(), backwards = one_pixel(), part = one_pixel(), sum = one_pixel();
    std::vector<FilmSample> samples;
    for (int i = 0; i < 100; ++i) {
        const float bright = std::exp(30 * random.next() - 10);
        const V3f albedo(random.next(), random.next(), random.next());
        samples.push_back(
            sample_of(Rgb(bright, 2 * bright, 0.1f),
                      {random.next() < 0.7f, albedo, V3f(0, 0, random.next()), 5 * bright}));
    }
    std::vector<uint8_t> packed(Film::bytes_per_pixel(0, {}, kHalved)), other = packed;
    for (uint32_t i = 0; i < 100; ++i) {
        forwards.add(0, 0, i, samples[i]);
        backwards.add(0, 0, 99 - i, samples[99 - i]);
        (i < 37 ? sum : part).add(0, 0, i, samples[i]);
    }
    part.pack(0, 0, packed.data());
    sum.add_packed(0, 0, packed.data());
    forwards.pack(0, 0, packed.data());
    for (const Film* film : {&backwards, &sum}) {
        film->pack(0, 0, other.data());
        EXPECT_EQ(other, packed);
    }
}

TEST(FilmHalves, CountsThatAreForgedAreSeen) {
    Film film = one_pixel();
    for (uint32_t i = 0; i < 5; ++i) film.add(0, 0, i, sample_of(Rgb(1.f)));
    std::vector<uint8_t> packed(Film::bytes_per_pixel(0, {}, kHalved));
    film.pack(0, 0, packed.data());
    const auto count = [&] { return Film::packed_count(packed.data(), {}, {}, kHalved, {0, 8}); };
    EXPECT_EQ(count(), 5u);
    const size_t halves = packed.size() - FilmHalves::bytes_per_pixel();
    for (const size_t at : {size_t(15), size_t(48 + 15), size_t(96 + 7)}) {  // sums, highest byte
        packed[halves + at] ^= 0x40;
        EXPECT_EQ(count(), std::nullopt) << at;
        packed[halves + at] ^= 0x40;
    }
    EXPECT_EQ(count(), 5u);
}

// Of a film with bins both halves of each bin are kept apart; together they are the bin.
TEST(FilmHalves, HaveTheirBins) {
    constexpr Bins kBins{400, 100, 3};
    Film film({1, 1}, {0, 0, 1, 1}, {}, kBins, kHalved), other = film;
    Film plain({1, 1}, {0, 0, 1, 1}, {}, kBins);
    Bands bands;
    bands.nm = f4{450, 550, 650, 750};
    bands.pdf = f4{0.0025f, 0.0025f, 0.0025f, 0.0025f};  // times 4 lanes and 100 nm: 1
    bands.on = m4{-1, -1, -1, -1};
    bands.spectral = true;
    for (uint32_t i = 0; i < 9; ++i) {
        const SpectralFilm::Sample light{i % kReplicates, f4{1, 2, 4, 8} * float(i), V3f(1)};
        for (Film* to : {&film, &plain}) to->add(0, 0, i, sample_of(Rgb(1.f)), light, bands);
    }
    std::vector<uint8_t> packed(Film::bytes_per_pixel(0, kBins, kHalved));
    film.pack(0, 0, packed.data());
    EXPECT_EQ(Film::packed_count(packed.data(), {}, kBins, kHalved, {0, 9}), 9u);
    other.add_packed(0, 0, packed.data());
    for (const Film* of : {&film, &other}) {
        std::array<float, 3> even, odd, all, without;
        of->spectral()->half_bin_means(0, 0, of->half(0, 0, 0).count, even.data());
        of->spectral()->half_bin_means(0, 1, of->half(0, 0, 1).count, odd.data());
        of->spectral()->bin_means(0, 9, all.data());
        plain.spectral()->bin_means(0, 9, without.data());
        EXPECT_FLOAT_EQ(even[0], 4);  // of 0, 2, 4, 6 and 8
        EXPECT_FLOAT_EQ(odd[2], 4 * 4);
        EXPECT_EQ(all, without);
    }
}

// A part of a frame keeps what a denoiser sees around it.
TEST(FilmHalves, AFilmKeepsPixelsAroundItsCrop) {
    const Film film({100, 50}, {40, 2, 50, 10}, {}, {}, kHalved);
    EXPECT_EQ(film.crop(), (Rect{40, 2, 50, 10}));
    EXPECT_EQ(film.pixels(), (Rect{6, 0, 84, 44}));
    EXPECT_EQ(Film({100, 50}, {40, 2, 50, 10}, {}).pixels(), (Rect{40, 2, 50, 10}));
}

}  // namespace
}  // namespace petzval
