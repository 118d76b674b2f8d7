// SPDX-License-Identifier: Apache-2.0
// Figures and lines of progress: what they say is so, and they fit.
#include "apps/cli/progress_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace petzval::apps {
namespace {

std::string line(const ProgressGoal& goal, uint64_t samples, double elapsed_s, int columns = 40,
                 ProgressBar bar = ProgressBar::No) {
    return progress_line(figures_under_way(goal, samples, elapsed_s), columns, bar);
}

TEST(ProgressText, SaysHowFarAndHowLong) {
    const ProgressGoal goal{100, 1'000'000, {}};
    EXPECT_EQ(line(goal, 250'000, 30), "25.0 %  8333 samples/s  1:30 left");
    EXPECT_EQ(line(goal, 250'000, 30, 60), "25.0 %  8333 samples/s  0:30 gone  1:30 left");
    EXPECT_EQ(line(goal, 250'000, 30, 39, ProgressBar::Yes),
              "[####...............] 25.0 %  1:30 left");
    EXPECT_EQ(line(goal, 250'000, 30, 20), "25.0 %  1:30 left");
    EXPECT_EQ(progress_line(figures_at_end(1'000'000, 120), 40, ProgressBar::No),
              "100.0 %  8333 samples/s  2:00");
    EXPECT_EQ(phase_line(Phase::Bvh, 75, 40), "building the BVH  1:15");
}

TEST(ProgressText, WhatIsNotKnownIsNotSaid) {
    const ProgressFigures none = figures_under_way({100, 1000, {}}, 0, 5);
    EXPECT_FALSE(none.left_s);
    EXPECT_EQ(none.fraction, 0);
    EXPECT_EQ(progress_line(none, 40, ProgressBar::No), "0.0 %  0 samples/s  0:05 gone");
}

TEST(ProgressText, HugeCountsHaveAnHonestEnd) {
    const uint64_t most = uint64_t{65536} * 65536 << 30;  // --size 65536x65536 --spp 2^30
    EXPECT_EQ(line({1, most, {}}, 1'000'000, 1, 45), "0.0 %  1 M samples/s  more than a year left");
    EXPECT_EQ(line({1, most, {}}, 1, 1e6, 45), "0.0 %  0 samples/s  more than a year left");
    EXPECT_EQ(line({1, uint64_t(2e6) * 86400 * 10, {}}, 2'000'000, 1, 60),
              "0.0 %  2 M samples/s  0:01 gone  10 days left");
    EXPECT_EQ(line({1, most, 3600.}, 1'000'000, 900), "25.0 %  1111 samples/s  45:00 left");
}

TEST(ProgressText, ATimeLimitEndsAtIt) {
    EXPECT_NEAR(figures_under_way({100, {}, 10.}, 5000, 4).fraction, 0.4, 1e-12);
    EXPECT_EQ(figures_under_way({100, {}, 10.}, 5000, 4).left_s, 6.);
    // Beyond the limit the first pass is still to be done.
    const ProgressFigures late = figures_under_way({100, {}, 1.}, 50, 2);
    EXPECT_NEAR(*late.left_s, 2, 1e-12);
    EXPECT_NEAR(late.fraction, 0.5, 1e-12);
    EXPECT_LT(figures_under_way({100, {}, 10.}, 5000, 10.5).fraction, 1) << "not over yet";
    EXPECT_EQ(line({100, {}, 10.}, 5000, 9.9999), "99.9 %  500 samples/s  0:00 left");
    EXPECT_EQ(figures_at_end(5000, 10.5).fraction, 1);
}

TEST(ProgressText, FitsWhateverTheFigures) {
    for (const uint64_t total : {uint64_t{1}, uint64_t{1} << 40, uint64_t{1} << 62})
        for (const uint64_t part : {uint64_t{0}, uint64_t{1}, total / 3, total})
            for (const double elapsed_s : {0., 1e-9, 59.6, 3599.9, 1e5, 1e9, 1e300})
                for (const double limit_s : {1e-3, 1e3, 1e300})
                    for (const int columns : {0, 5, 20, 39, 40, 80, 200}) {
                        ProgressFigures f = figures_under_way({1, total, limit_s}, part, elapsed_s);
                        ASSERT_TRUE(f.fraction >= 0 && f.fraction < 1);
                        ASSERT_TRUE(!f.left_s || *f.left_s >= 0);
                        for (const ProgressBar bar : {ProgressBar::No, ProgressBar::Yes}) {
                            const std::string text = progress_line(f, columns, bar);
                            ASSERT_LE(text.size(), size_t(columns)) << text;
                            ASSERT_EQ(text.find('-'), text.npos) << text;
                            ASSERT_EQ(text.find("nan"), text.npos) << text;
                        }
                        f = figures_at_end(part, elapsed_s);
                        ASSERT_LE(progress_line(f, columns, ProgressBar::Yes).size(),
                                  size_t(columns));
                        ASSERT_LE(phase_line(Phase::Planning, elapsed_s, columns).size(),
                                  size_t(columns));
                    }
}

}  // namespace
}  // namespace petzval::apps
