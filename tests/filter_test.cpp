// SPDX-License-Identifier: Apache-2.0
#include "core/filter.h"

#include "tests/support/chi_square.h"

namespace petzval {
namespace {

using test::Random;

// Along one axis, x in radii; not normalised.
double gauss(double x) {
    return std::exp(-0.5 * std::pow(3 * x, 2));
}
double blackman_harris(double x) {
    const double a = M_PI * (x + 1);  // 0 to 2 pi over the window
    return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
}
double box(double) {
    return 1;
}

struct Case {
    FilterKind kind;
    double (*profile)(double);
};

class Filters : public ::testing::TestWithParam<Case> {};

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

INSTANTIATE_TEST_SUITE_P(All, Filters,
                         ::testing::Values(Case{FilterKind::Box, box},
                                           Case{FilterKind::Gauss, gauss},
                                           Case{FilterKind::BlackmanHarris, blackman_harris}));

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

}  // namespace
}  // namespace petzval
