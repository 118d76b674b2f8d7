// SPDX-License-Identifier: Apache-2.0
#include "core/film/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/film/film.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

template <class Sum>
double sum_of(std::initializer_list<float> values) {
    Sum sum;
    for (const float value : values) sum.add(value);
    return sum.value();
}

// Floats of any magnitude up to the limit, of both signs.
std::vector<float> any_floats(size_t count, uint32_t seed, float limit) {
    test::Random random(seed);
    std::vector<float> out(count);
    for (float& value : out) {
        const int exponent = -60 + static_cast<int>(random.next() * 106);
        value = std::min(std::ldexp(1 + random.next(), exponent), std::nextafter(limit, 0.f));
        if (random.next() < 0.5f) value = -value;
    }
    return out;
}

TEST(ExactSum, OneNumberIsRoundedToTheNearestUnit) {
    constexpr double unit = 0x1p-48;
    for (const float value : any_floats(100000, 1, FilmSum::kLimit)) {
        const double wanted = std::round(double(value) / unit) * unit;  // halves away from zero
        ASSERT_EQ(sum_of<FilmSum>({value}), wanted) << value;
    }
    EXPECT_EQ(sum_of<FilmSum>({0x1p-49f}), unit);
    EXPECT_EQ(sum_of<FilmSum>({-0x1p-49f}), -unit);
    EXPECT_EQ(sum_of<FilmSum>({std::nextafter(0x1p-49f, 0.f)}), 0);
    EXPECT_EQ(sum_of<FilmSum>({0x1.8p-48f}), 2 * unit);
    EXPECT_EQ(sum_of<FilmSum>({0.f, -0.f, 1e-38f, 1e-45f}), 0);
    EXPECT_EQ(sum_of<SpectralSum>({0x1p-64f, 0x1.8p-65f}), 0x1p-63);
}

// What cancels leaves nothing behind, whatever was beside it.
TEST(ExactSum, LargeNumbersDoNotSwallowSmallOnes) {
    EXPECT_EQ(sum_of<FilmSum>({1e14f, 0x1p-48f, -1e14f}), 0x1p-48);
    EXPECT_EQ(sum_of<SpectralSum>({1e9f, 0x1p-64f, -1e9f}), 0x1p-64);
}

// As many of the largest numbers as there are indices: the sum does not run over.
TEST(ExactSum, TheLargestSumFits) {
    for (const float sign : {1.f, -1.f}) {
        FilmSum sum;
        sum.add(sign * std::nextafter(FilmSum::kLimit, 0.f));
        for (int doubling = 0; doubling < 32; ++doubling) sum += FilmSum(sum);
        EXPECT_EQ(sum.value(), double(sign * std::nextafter(FilmSum::kLimit, 0.f)) * 0x1p32);
    }
}

TEST(ExactSum, OrderAndGroupingDoNotMatter) {
    std::vector<float> values = any_floats(5000, 2, FilmSum::kLimit);
    FilmSum in_order;
    for (const float value : values) in_order.add(value);
    test::Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        for (size_t i = values.size(); i > 1; --i)
            std::swap(values[i - 1], values[size_t(random.next() * float(i))]);
        std::array<FilmSum, 7> parts;
        for (size_t i = 0; i < values.size(); ++i) parts[i * i % 7].add(values[i]);
        FilmSum joined;
        for (const FilmSum& part : parts) joined += part;
        ASSERT_EQ(joined, in_order);
    }
}

FilmSample any_sample(test::Random& random) {
    FilmSample s;
    s.colour = Rgb(random.next() * 1e3f, random.next(), random.next() * 1e-6f);
    s.alpha = random.next();
    s.hit = random.next() < 0.7f;
    for (V3f& layer : s.aov) layer = V3f(random.next(), -random.next(), 1e4f * random.next());
    if (random.next() < 0.05f) s.colour = Rgb(std::numeric_limits<float>::infinity());
    if (random.next() < 0.05f) s.colour = Rgb(1e20f);
    return s;
}

std::vector<uint8_t> bytes_of(const Film& film) {
    const size_t each = Film::bytes_per_pixel(film.aovs().size(), film.spectral()->bins());
    std::vector<uint8_t> out;
    for (int y = film.crop().y0; y < film.crop().y1; ++y)
        for (int x = film.crop().x0; x < film.crop().x1; ++x) {
            out.resize(out.size() + each);
            film.pack(x, y, out.data() + out.size() - each);
        }
    return out;
}

// Films of parts of the samples, packed and added in any order, have the bytes of one film.
TEST(Film, PartsAddUpToTheWhole) {
    const Rect crop{2, 1, 6, 4};
    const std::vector<Aov> layers{Aov::Depth, Aov::Normal};
    const Bins bins{380, 50, 7};
    const auto empty = [&] { return Film({8, 6}, crop, layers, bins); };
    Film whole = empty();
    std::vector<Film> parts(5, empty());
    test::Random random(4);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (uint32_t i = 0; i < 40; ++i) {
                const FilmSample s = any_sample(random);
                Bands bands = Bands::rgb();
                bands.nm = f4{400 + 300 * random.next(), 450, 500, 0};
                const SpectralFilm::Sample lanes{i % kReplicates, f4{random.next(), 1, 2, 0},
                                                 V3f(random.next())};
                whole.add(x, y, i, s, lanes, bands);
                parts[size_t(random.next() * 5)].add(x, y, i, s, lanes, bands);
            }
    const Film::LeftOut due = whole.left_out();
    ASSERT_GT(due.not_finite, 0u);
    ASSERT_GT(due.too_large, 0u);
    for (const auto& order : {std::array{0, 1, 2, 3, 4}, std::array{3, 1, 4, 0, 2}}) {
        Film joined = empty();
        std::vector<uint8_t> packed(Film::bytes_per_pixel(layers.size(), bins));
        for (const int part : order)
            for (int y = crop.y0; y < crop.y1; ++y)
                for (int x = crop.x0; x < crop.x1; ++x) {
                    parts[size_t(part)].pack(x, y, packed.data());
                    joined.add_packed(x, y, packed.data());
                }
        EXPECT_EQ(bytes_of(joined), bytes_of(whole));
        EXPECT_EQ(joined.left_out().not_finite, due.not_finite);
        EXPECT_EQ(joined.left_out().too_large, due.too_large);
        EXPECT_EQ(joined.left_out().index, due.index);
        EXPECT_EQ(joined.taken_count(3, 2), 40u);
    }
}

}  // namespace
}  // namespace petzval
