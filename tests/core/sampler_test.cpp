// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sampler.h"

#include <set>

#include "tests/support/chi_square.h"

namespace petzval {
namespace {

// Second dimension by Sobol's own recurrence for the primitive polynomial x + 1 (degree 1, no inner
// coefficients): m_k = 2 m_(k-1) xor m_(k-1), m_1 = 1; v_k = m_k / 2^k. Sobol 1967; Bratley and Fox
// 1988, equation 2.
uint32_t sobol_by_recurrence(uint32_t index) {
    uint32_t point = 0, m = 1;
    for (int k = 1; k <= 32; ++k) {
        if (index >> (k - 1) & 1) point ^= m << (32 - k);
        m = (2 * m) ^ m;
    }
    return point;
}

TEST(Sobol, DimensionsFollowTheDirectionNumbers) {
    for (uint32_t i = 0; i < 70000; ++i) {
        ASSERT_EQ(sobol_1(i), sobol_by_recurrence(i)) << i;
        const uint32_t far = hash32(i);
        ASSERT_EQ(sobol_1(far), sobol_by_recurrence(far)) << far;
    }
    // Radical inverse: 6 = 110 in base 2 mirrors to 0.011.
    EXPECT_EQ(sobol_0(6), 0x60000000u);
    EXPECT_EQ(sobol_0(1), 0x80000000u);
    EXPECT_EQ(sobol_0(0x80000000u), 1u);
}

class Stratified : public ::testing::TestWithParam<SamplerKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Stratified,
                         ::testing::Values(SamplerKind::Owen, SamplerKind::Sobol));

// A (0, m, 2)-net: every elementary interval of area 2^-m holds one of the 2^m points of a block.
TEST_P(Stratified, EveryBlockIsANet) {
    for (int m = 1; m <= 8; ++m)
        for (uint32_t block = 0; block < 4; ++block)
            for (const auto& [dim, vertex] :
                 {std::pair{Dim::Bsdf, 0u}, {Dim::Bsdf, 1u}, {Dim::Bsdf, 2u}, {Dim::Lens, 0u}}) {
                std::vector<V2f> points;
                for (uint32_t i = 0; i < 1u << m; ++i)
                    points.push_back(
                        Sampler(GetParam(), 7, {31, 5, (block << m) + i}).get2(dim, vertex));
                for (int a = 0; a <= m; ++a) {
                    std::set<uint32_t> cells;
                    for (const V2f& p : points)
                        cells.insert((static_cast<uint32_t>(p.x * (1 << a)) << 16) +
                                     static_cast<uint32_t>(p.y * (1 << (m - a))));
                    ASSERT_EQ(cells.size(), points.size())
                        << "m " << m << " block " << block << " split " << a;
                }
            }
}

// Niederreiter 1987: a (0, 4)-sequence in base 4. Each block of 4^m points has one in each box
// whose sides are powers of a quarter and whose volume is 4^-m.
TEST_P(Stratified, FilmAndLensAreANetTogether) {
    for (uint32_t m = 1; m <= 4; ++m) {
        const uint32_t n = 1u << (2 * m);
        for (const uint32_t block : {0u, 1u, 7u}) {
            std::vector<std::array<float, 4>> points;
            for (uint32_t i = 0; i < n; ++i) {
                const Sampler sampler(GetParam(), 3, {5, 9, block * n + i});
                const V2f film = sampler.get2(Dim::Film), lens = sampler.get2(Dim::Lens);
                points.push_back({film.x, film.y, lens.x, lens.y});
            }
            for (uint32_t a = 0; a <= m; ++a)
                for (uint32_t b = 0; a + b <= m; ++b)
                    for (uint32_t c = 0; a + b + c <= m; ++c) {
                        const std::array<uint32_t, 4> sides{a, b, c, m - a - b - c};
                        std::set<uint32_t> boxes;
                        for (const auto& p : points) {
                            uint32_t box = 0;
                            for (size_t k = 0; k < 4; ++k) {
                                const uint32_t parts = 1u << (2 * sides[k]);
                                box = box * parts +
                                      static_cast<uint32_t>(p[k] * static_cast<float>(parts));
                            }
                            boxes.insert(box);
                        }
                        EXPECT_EQ(boxes.size(), n) << m << ": " << a << ' ' << b << ' ' << c;
                    }
        }
    }
}

TEST_P(Stratified, OneDimensionHasOnePointInEachInterval) {
    for (int m = 1; m <= 10; ++m) {
        std::set<uint32_t> cells;
        for (uint32_t i = 0; i < 1u << m; ++i)
            cells.insert(static_cast<uint32_t>(
                Sampler(GetParam(), 3, {2, 9, (5u << m) + i}).get1(Dim::LightRest, 1) * (1 << m)));
        ASSERT_EQ(cells.size(), size_t{1} << m);
    }
}

class Kinds : public ::testing::TestWithParam<SamplerKind> {};
INSTANTIATE_TEST_SUITE_P(All, Kinds,
                         ::testing::Values(SamplerKind::Owen, SamplerKind::Sobol,
                                           SamplerKind::Independent));

TEST_P(Kinds, IsAFunctionOfItsArgumentsOnly) {
    const Sampler a(GetParam(), 5, {10, 20, 30}), b(GetParam(), 5, {10, 20, 30});
    const V2f later = a.get2(Dim::LightPoint, 4);
    EXPECT_EQ(a.get1(Dim::Film), b.get1(Dim::Film));
    EXPECT_EQ(later, b.get2(Dim::LightPoint, 4));
    EXPECT_EQ(a.get_bits(Dim::Coverage, 2), b.get_bits(Dim::Coverage, 2));
    const Sampler others[] = {
        Sampler(GetParam(), 6, {10, 20, 30}), Sampler(GetParam(), 5, {11, 20, 30}),
        Sampler(GetParam(), 5, {10, 21, 30}), Sampler(GetParam(), 5, {20, 10, 30}),
        Sampler(GetParam(), 5, {10, 20, 31}), Sampler(GetParam(), 5, {-10, 20, 30})};
    for (const Sampler& other : others) {
        EXPECT_NE(a.get2(Dim::LightPoint, 4), other.get2(Dim::LightPoint, 4));
        EXPECT_NE(a.get_bits(Dim::LightPoint, 4), other.get_bits(Dim::LightPoint, 4));
    }
}

TEST_P(Kinds, NumbersOfAVertexAreThoseOfItsDimensions) {
    for (uint32_t i = 0; i < 2000; ++i) {
        const Sampler sampler(GetParam(), 9, {static_cast<int>(i % 7), -3, hash32(i) >> (i % 32)});
        const auto numbers = sampler.at_vertex(i % 17);
        ASSERT_EQ(numbers.bsdf_lobe, sampler.get1(Dim::BsdfLobe, i % 17));
        ASSERT_EQ(numbers.bsdf, sampler.get2(Dim::Bsdf, i % 17));
        ASSERT_EQ(numbers.light_rest, sampler.get1(Dim::LightRest, i % 17));
        ASSERT_EQ(numbers.light_point, sampler.get2(Dim::LightPoint, i % 17));
        ASSERT_EQ(numbers.roulette_after, sampler.get1(Dim::Roulette, i % 17 + 1));
    }
}

TEST_P(Kinds, IsUniformInTheUnitSquare) {
    // Over the first samples of many pixels, which no construction makes uniform by itself.
    std::vector<double> observed(256), expected(256, 65536.0 / 256);
    test::Moments mean;
    for (uint32_t i = 0; i < 65536; ++i) {
        const Sampler sampler(GetParam(), 11,
                              {static_cast<int>(i % 256), static_cast<int>(i / 256), 0});
        const V2f p = sampler.get2(Dim::Lens);
        ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
        ++observed[static_cast<int>(p.x * 16) * 16 + static_cast<int>(p.y * 16)];
        mean.add(sampler.get1(Dim::Roulette, 3));
    }
    EXPECT_TRUE(test::chi_square(observed, expected));
    EXPECT_TRUE(test::agrees(mean, 0.5)) << mean.mean();
    EXPECT_NEAR(mean.variance(), 1.0 / 12, 0.002);
}

// Mean product of two centred uniform numbers: 0 where they are independent, standard error
// 1 / (12 sqrt(n)).
bool uncorrelated(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
    const auto n = static_cast<double>(a.size());
    return test::agrees({sum / n, 1 / (12 * std::sqrt(n))}, 0);
}

TEST_P(Kinds, DimensionsVerticesAndPixelsAreIndependent) {
    constexpr uint32_t kSize = 16384;
    const auto series = [&](Dim dim, uint32_t vertex, int dx, uint32_t seed, bool second) {
        std::vector<float> out;
        for (uint32_t i = 0; i < kSize; ++i) {
            const V2f p = Sampler(GetParam(), seed, {static_cast<int>(i / 16) + dx, 3, i % 16})
                              .get2(dim, vertex);
            out.push_back(second ? p.y : p.x);
        }
        return out;
    };
    const auto base = series(Dim::Bsdf, 1, 0, 1, false);
    EXPECT_TRUE(uncorrelated(base, series(Dim::Bsdf, 1, 0, 1, true)));
    EXPECT_TRUE(uncorrelated(base, series(Dim::LightPoint, 1, 0, 1, false)));
    EXPECT_TRUE(uncorrelated(base, series(Dim::LightPoint, 1, 0, 1, true)));
    EXPECT_TRUE(uncorrelated(base, series(Dim::Bsdf, 2, 0, 1, false)));
    EXPECT_TRUE(uncorrelated(base, series(Dim::Bsdf, 1, 1, 1, false)));
    EXPECT_TRUE(uncorrelated(base, series(Dim::Bsdf, 1, 0, 2, false)));
    EXPECT_FALSE(uncorrelated(base, base));
}

// The mean of a smooth function over 256 samples: Owen's points must beat independent ones by far.
TEST(Sampler, StratifiedPointsIntegrateBetter) {
    const auto squared_error = [](SamplerKind kind) {
        double total = 0;
        for (int pixel = 0; pixel < 200; ++pixel) {
            double sum = 0;
            for (uint32_t i = 0; i < 256; ++i) {
                const V2f p = Sampler(kind, 1, {pixel, 0, i}).get2(Dim::LightPoint, 2);
                sum += p.x * p.x * std::cos(p.y);
            }
            total += std::pow(sum / 256 - std::sin(1.0) / 3, 2);
        }
        return total / 200;
    };
    const double independent = squared_error(SamplerKind::Independent);
    EXPECT_LT(squared_error(SamplerKind::Owen), independent / 300);
    EXPECT_LT(squared_error(SamplerKind::Sobol), independent / 50);
}

}  // namespace
}  // namespace petzval
