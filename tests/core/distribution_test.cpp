// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/distribution.h"
#include "core/sampling/alias_table.h"

#include "tests/support/chi_square.h"

namespace petzval {
namespace {

using test::Random;

std::vector<float> spiky_weights(int size, uint32_t seed) {
    std::vector<float> weights(size);
    Random random(seed);
    for (float& w : weights) {
        const float u = random.next();
        w = u < 0.3f ? 0.f : std::pow(1000.f, 2 * u - 1);
    }
    weights[size / 2] = 5000.f;
    return weights;
}

TEST(Piecewise1D, DrawsInProportionToWeight) {
    const auto weights = spiky_weights(300, 1);
    const Piecewise1D distribution(weights);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    EXPECT_NEAR(distribution.sum(), sum, 1e-6 * sum);
    std::vector<double> observed(weights.size()), expected;
    for (const float w : weights) expected.push_back(200000 * w / sum);
    Random random(2);
    for (int i = 0; i < 200000; ++i) ++observed[distribution.sample(random.next()).cell];
    EXPECT_TRUE(test::chi_square(observed, expected));
}

// The sampler's numbers are multiples of 2^-24: counting all of them leaves nothing to chance.
TEST(Piecewise1D, ProbabilityIsExactlyTheShareOfAllNumbers) {
    const auto weights = spiky_weights(1000, 3);
    const Piecewise1D distribution(weights);
    std::vector<uint32_t> count(weights.size());
    uint32_t last = 0;
    for (uint32_t i = 0; i < kDistributionUnits; ++i) {
        const auto drawn = distribution.sample(static_cast<float>(i) / kDistributionUnits);
        ASSERT_GE(drawn.cell, last) << "order is lost at " << i;
        last = drawn.cell;
        ++count[drawn.cell];
    }
    for (uint32_t i = 0; i < weights.size(); ++i) {
        EXPECT_EQ(count[i], distribution.probability(i) * kDistributionUnits);
        EXPECT_EQ(count[i] > 0, weights[i] > 0) << i;
    }
}

TEST(Piecewise1D, OffsetRunsThroughTheCell) {
    const Piecewise1D distribution(std::vector<float>{1, 0, 3});
    EXPECT_EQ(distribution.sample(0.f).cell, 0u);
    EXPECT_NEAR(distribution.sample(0.125f).offset, 0.5, 1e-6);
    EXPECT_EQ(distribution.sample(0.25f).cell, 2u);
    EXPECT_NEAR(distribution.sample(0.25f).offset, 0, 1e-6);
    EXPECT_NEAR(distribution.sample(0.625f).offset, 0.5, 1e-6);
    EXPECT_NEAR(distribution.sample(0.625f).probability, 0.75, 1e-6);
}

TEST(Piecewise1D, TopOfTheIntervalIsTheLastCellWithWeight) {
    const Piecewise1D distribution(std::vector<float>{0, 2, 1, 0, 0});
    for (const float u : {kOneMinus, 1.f}) {
        const auto drawn = distribution.sample(u);
        EXPECT_EQ(drawn.cell, 2u);
        EXPECT_LT(drawn.offset, 1.f);
    }
    EXPECT_EQ(distribution.sample(0.f).cell, 1u);
}

TEST(Piecewise1D, TinyWeightsKeepAChance) {
    std::vector<float> weights(200000, 1e-12f);
    weights[777] = 1e6f;
    const Piecewise1D distribution(weights);
    for (uint32_t i = 0; i < weights.size(); ++i) ASSERT_GT(distribution.probability(i), 0.f);
    EXPECT_GT(distribution.probability(777), 0.98f);
    EXPECT_EQ(distribution.sample(kOneMinus).cell, 199999u);
}

TEST(Piecewise1D, OneCell) {
    const Piecewise1D distribution(std::vector<float>{1e-30f});
    EXPECT_EQ(distribution.sample(0.999f).cell, 0u);
    EXPECT_EQ(distribution.probability(0), 1.f);
}

TEST(Piecewise2D, DrawsInProportionToWeight) {
    constexpr int kWidth = 40, kHeight = 25;
    auto weights = spiky_weights(kWidth * kHeight, 4);
    std::fill_n(weights.begin() + 3 * kWidth, 2 * kWidth, 0.f);  // rows without weight
    const Piecewise2D distribution(weights, kWidth, kHeight);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    EXPECT_NEAR(distribution.sum(), sum, 1e-6 * sum);
    std::vector<double> observed(weights.size()), expected;
    for (const float w : weights) expected.push_back(300000 * w / sum);
    Random random(5);
    for (int i = 0; i < 300000; ++i) {
        const auto drawn = distribution.sample(random.next2());
        ASSERT_EQ(drawn.probability, distribution.probability(drawn.column, drawn.row));
        ++observed[drawn.row * kWidth + drawn.column];
    }
    EXPECT_TRUE(test::chi_square(observed, expected));
    double total = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) total += distribution.probability(x, y);
    EXPECT_NEAR(total, 1, 1e-6);
}

TEST(Piecewise2D, IsUniformWithinCells) {
    const Piecewise2D distribution(std::vector<float>{1, 2, 3, 0}, 2, 2);
    const auto density = [](double x, double y) {
        const double weight[2][2] = {{1, 2}, {3, 0}};
        return weight[y >= 0.5][x >= 0.5] / 6 * 4;
    };
    const auto place = [&](Random& random) -> std::optional<V2f> {
        const auto drawn = distribution.sample(random.next2());
        return V2f((drawn.column + drawn.offset.x) / 2, (drawn.row + drawn.offset.y) / 2);
    };
    EXPECT_TRUE(test::chi_square_grid({0, 1, 0, 1, 16, 16}, density, place, 100000, 6));
}

TEST(Piecewise2D, UnitsSayTheSame) {
    const auto weights = spiky_weights(300 * 25, 7);
    const Piecewise2D distribution(weights, 300, 25);
    Random random(8);
    for (int i = 0; i < 20000; ++i) {
        const V2f u = i == 0 ? V2f(1.f) : random.next2();
        const auto drawn = distribution.sample(u);
        const auto units = distribution.sample_units(u);
        ASSERT_EQ(units.column, drawn.column);
        ASSERT_EQ(units.row, drawn.row);
        ASSERT_EQ(units.units, distribution.units(drawn.column, drawn.row));
        ASSERT_LT(units.unit, units.units);
        const float offset = (units.unit + units.rest) / units.units;
        ASSERT_NEAR(offset, drawn.offset.x, 1e-6);
        ASSERT_EQ(units.row_offset, drawn.offset.y);
        ASSERT_EQ(distribution.row_probability(units.row) * (units.units * 0x1p-24f),
                  drawn.probability);
    }
}

TEST(Piecewise2D, KeepsStrataApart) {
    // A uniform density must hand a stratified set on as it is.
    const Piecewise2D distribution(std::vector<float>(7 * 5, 2.f), 7, 5);
    for (int i = 0; i < 64; ++i) {
        const V2f u((i % 8 + 0.3f) / 8, (i / 8 + 0.7f) / 8);
        const auto drawn = distribution.sample(u);
        EXPECT_NEAR((drawn.column + drawn.offset.x) / 7, u.x, 1e-5);
        EXPECT_NEAR((drawn.row + drawn.offset.y) / 5, u.y, 1e-5);
    }
}

// Over a fine grid of u each cell comes up in proportion, with offsets that fill [0, 1).
TEST(AliasTable, DrawsByWeightAndLeavesAUniformNumber) {
    const std::vector<float> weights = {3, 0, 1, 0.5f, 0, 7, 1e-3f, 2};
    const AliasTable table(weights);
    constexpr int kSteps = 1 << 20;
    std::vector<double> count(weights.size()), offsets(weights.size());
    for (int i = 0; i < kSteps; ++i) {
        const auto [cell, offset] = table.sample((i + 0.5f) / kSteps);
        ASSERT_LT(cell, weights.size());
        ASSERT_TRUE(offset >= 0 && offset < 1);
        count[cell] += 1;
        offsets[cell] += offset;
    }
    for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(count[i] / kSteps, weights[i] / 13.501, 16. / kSteps) << i;
        if (count[i] < 1000) continue;
        EXPECT_NEAR(offsets[i] / count[i], 0.5, 1e-3) << i;
    }
    const AliasTable one(std::vector<float>{5});
    EXPECT_EQ(one.sample(0.999999f).cell, 0u);
}

}  // namespace
}  // namespace petzval
