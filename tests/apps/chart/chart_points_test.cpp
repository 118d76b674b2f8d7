// SPDX-License-Identifier: Apache-2.0
// What is made of measurements: intervals, efficiency, the Pareto front, what a report believes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/chart/chart_report.h"
#include "apps/setup/student_t.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

TEST(ChartPoints, QuantilesOfStudentsT) {
    // Abramowitz and Stegun 1964, table 26.10.
    EXPECT_NEAR(student_t_975(1), 12.706, 1e-3);
    EXPECT_NEAR(student_t_975(2), 4.303, 1e-3);
    EXPECT_NEAR(student_t_975(3), 3.182, 2e-2);
    EXPECT_NEAR(student_t_975(4), 2.776, 1e-3);
    EXPECT_NEAR(student_t_975(9), 2.262, 1e-3);
    EXPECT_NEAR(student_t_975(30), 2.042, 1e-3);
    EXPECT_NEAR(student_t_975(1e9), 1.960, 1e-3);
    for (const double degrees : {4., 7., 11., 30., 1000.})
        EXPECT_NEAR(test::two_sided_t_p(student_t_975(degrees), degrees), 0.05, 1e-4) << degrees;
    EXPECT_NEAR(test::two_sided_t_p(8.610, 4), 0.001, 1e-6);
}

TEST(ChartPoints, IntervalOfFiveNumbers) {
    // Variance 2.5, standard error sqrt(2.5 / 5) = 0.7071, times 2.776.
    const Interval i = confidence_95(std::vector<double>{1, 2, 3, 4, 5});
    EXPECT_DOUBLE_EQ(i.mean, 3);
    EXPECT_NEAR(i.high - i.mean, 1.963, 1e-3);
    EXPECT_DOUBLE_EQ(i.high - i.mean, i.mean - i.low);
}

// Of made-up normal numbers 95 % of the intervals hold the mean: 1900 of 2000, within 4.9 standard
// deviations of sqrt(2000 * 0.95 * 0.05).
TEST(ChartPoints, IntervalsHoldTheMeanAsOftenAsTheySay) {
    test::Random random(7);
    int held = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> v;
        for (int i = 0; i < 5; ++i)
            v.push_back(3 + std::sqrt(-2 * std::log(1 - double(random.next()))) *
                                std::cos(2 * std::numbers::pi * double(random.next())));
        const Interval i = confidence_95(v);
        held += i.low <= 3 && 3 <= i.high;
    }
    EXPECT_TRUE(test::agrees({double(held), std::sqrt(2000 * 0.95 * 0.05)}, 1900)) << held;
}

/// A point with that symmetric MSE; its relative MSE and FLIP say the opposite.
ChartPoint point(uint32_t samples, double cpu_s, double mse) {
    ChartPoint p{samples, {}};
    for (uint32_t i = 0; i < 5; ++i)
        p.seeds.push_back({i, cpu_s * (1 + 0.01 * (i - 2.)), mse * (1 - 0.02 * (i - 2.)),
                           1e-3 / mse, 1e-3 / mse});
    return p;
}

TEST(ChartPoints, EfficiencyIsOneOverErrorTimesTime) {
    const ChartPoint p = point(8, 2, 0.05);
    // Mean of the product: 0.1 (1 - 0.0002 * 2).
    EXPECT_NEAR(p.efficiency().mean, 1 / (0.1 * (1 - 0.0004)), 1e-9);
    EXPECT_LT(p.efficiency().low, p.efficiency().mean);
    EXPECT_GT(p.efficiency().high, p.efficiency().mean);
    ChartPoint wild = p;
    wild.seeds[0].symmetric_mse = 100;
    EXPECT_TRUE(std::isinf(wild.efficiency().high));
}

TEST(ChartPoints, ParetoFrontHoldsWhatNothingBeats) {
    using Points = std::vector<std::array<double, 2>>;
    const auto front = [](const Points& points) { return pareto_front(points); };
    EXPECT_EQ(front({}), std::vector<size_t>());
    EXPECT_EQ(front({{4, 1}, {1, 4}, {2, 2}, {3, 3}}), (std::vector<size_t>{1, 2, 0}));
    EXPECT_EQ(front({{1, 2}, {1, 1}}), std::vector<size_t>{1}) << "as costly, worse";
    EXPECT_EQ(front({{2, 1}, {1, 1}}), std::vector<size_t>{1}) << "as good, costlier";
    EXPECT_EQ(front({{1, 1}, {1, 1}}).size(), 2u) << "neither beats the other";
}

TEST(ChartReport, EfficiencyIsOfTheLastPointThatIsBelieved) {
    MeasuredCase of;
    of.reference.symmetric_mse = 0.01;
    of.methods.resize(2);
    of.methods[0].points = {point(1, 1, 0.1), point(2, 2, 0.05), point(4, 4, 0.015)};
    of.methods[1].points = {point(1, 1, 0.018)};
    const auto rows = efficiencies(of);
    EXPECT_TRUE(rows[0].believed);
    EXPECT_EQ(rows[0].point.samples, 2u) << "0.015 is less than twice 0.01";
    EXPECT_FALSE(rows[1].believed);
    EXPECT_NEAR(rows[1].to_first, 0.1 / 0.018, 1e-3);
    of.reference.symmetric_mse.reset();
    EXPECT_EQ(efficiencies(of)[0].point.samples, 4u) << "no floor is known";
}

}  // namespace
}  // namespace petzval::apps
