// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/filter.h"

#include <numbers>

#include "tests/support/chi_square.h"

namespace petzval {
namespace {

using test::Random;

// Along one axis, x in radii; not normalised.
double gauss(double x) {
    return std::exp(-0.5 * std::pow(3 * x, 2));
}
double blackman_harris(double x) {
    const double a = std::numbers::pi * (x + 1);  // 0 to 2 pi over the window
    return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
}
double box(double) {
    return 1;
}

struct FilterCase {
    FilterKind kind;
    double (*profile)(double);
};

class Filters : public ::testing::TestWithParam<FilterCase> {};

TEST_P(Filters, OffsetsAreDistributedAsTheFilter) {
    constexpr double kRadius = 1.5;
    const Filter filter(GetParam().kind, kRadius);
    const auto profile = GetParam().profile;
    double norm = 0;
    for (int i = 0; i < 10000; ++i) norm += profile((i + 0.5) / 5000 - 1) / 5000 * kRadius;
    const auto density = [&](double x, double y) {
        return profile(x / kRadius) * profile(y / kRadius) / (norm * norm);
    };
    const auto place = [&](Random& random) -> std::optional<V2f> {
        return filter.sample(random.next2());
    };
    EXPECT_TRUE(test::chi_square_grid({-kRadius, kRadius, -kRadius, kRadius, 48, 48}, density,
                                      place, 400000, 1));
}

TEST_P(Filters, AreSymmetricAndMonotone) {
    const Filter filter(GetParam().kind, 2.f);
    float last = -2.f;
    for (int i = 0; i < 10000; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / 10000;
        const V2f a = filter.sample({u, 1 - u});
        ASSERT_NEAR(a.x, -a.y, 1e-4);
        ASSERT_GE(a.x, last);
        last = a.x;
    }
    EXPECT_GE(filter.sample({0.f, 0.f}).x, -2.f);
    EXPECT_LE(filter.sample({kOneMinus, kOneMinus}).x, 2.f);
}

// Where straight lines meet: the tail is the integral of the profile there, by the midpoint rule.
TEST_P(Filters, TailsHoldWhatTheProfileHas) {
    const Filter filter(GetParam().kind, 1.f);
    const auto integral_to = [&](double x) {
        constexpr int kSteps = 200000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            sum += GetParam().profile(-1 + (x + 1) * (i + 0.5) / kSteps);
        return sum * (x + 1) / kSteps;
    };
    for (const int k : {1, 2, 5, 20, 100, 400}) {
        const double u = (k / 1024.) * (k / 1024.) / 2;
        const double x = double(filter.sample({static_cast<float>(u), 0.5f}).x);
        EXPECT_NEAR(integral_to(x) / integral_to(1), u, 2e-3 * u) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Filters,
    ::testing::Values(FilterCase{FilterKind::Box, box}, FilterCase{FilterKind::Gauss, gauss},
                      FilterCase{FilterKind::BlackmanHarris, blackman_harris}));

TEST(Filters, BoxOfHalfAPixelIsThePixel) {
    const Filter filter(FilterKind::Box, 0.5f);
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const V2f u = random.next2();
        const V2f offset = filter.sample(u);
        ASSERT_NEAR(offset.x, u.x - 0.5f, 1e-6);
        ASSERT_NEAR(offset.y, u.y - 0.5f, 1e-6);
    }
}

// Against counts of samples in cells of a twentieth of the radius; the outermost of 2^13 quantiles
// is a straight line.
TEST(Filter, ValueIsTheDensityOfSamples) {
    for (const FilterKind kind : {FilterKind::Box, FilterKind::Gauss, FilterKind::BlackmanHarris}) {
        const Filter filter(kind, 1.7f);
        constexpr int kCells = 20, kDraws = 1 << 20;
        std::vector<double> count(kCells), due(kCells);
        double sum = 0;
        for (int i = 0; i < kDraws; ++i) {
            const float x = filter.sample({(i + 0.5f) / kDraws, 0.5f}).x;
            ++count[size_t(std::min(kCells - 1, int(std::fabs(x) / 1.7f * kCells)))];
        }
        for (int c = 0; c < kCells; ++c)
            for (int i = 0; i < 100; ++i) {
                const float x = (float(c) + (float(i) + 0.5f) / 100) / kCells * 1.7f;
                due[size_t(c)] += double(filter.value({x, 0}));
                sum += double(filter.value({-x, 0}));
            }
        for (int c = 0; c < kCells; ++c)
            EXPECT_NEAR(count[size_t(c)] / kDraws, due[size_t(c)] / sum, 1e-4) << int(kind) << c;
        EXPECT_EQ(filter.value({0, 0}), 1);
        EXPECT_EQ(filter.value({1.71f, 0}), 0);
        EXPECT_EQ(filter.value({0, -1.71f}), 0);
        EXPECT_FLOAT_EQ(filter.value({0.4f, 0.9f}),
                        filter.value({0.4f, 0}) * filter.value({0, 0.9f}));
    }
}

}  // namespace
}  // namespace petzval
