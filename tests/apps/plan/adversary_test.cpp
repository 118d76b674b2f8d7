// SPDX-License-Identifier: Apache-2.0
// Plans of scenes that are made to fool them: a small part of tests/measure/plan_adversary.
#include <gtest/gtest.h>

#include "tests/measure/plan_verdict.h"

namespace petzval::apps {
namespace {

constexpr uint32_t kScenes = 24;  ///< three of each kind

// What is true is known within bounds of 95 %, and a plan's figures are bounds too: of 24 scenes
// one may be above its promise by chance, none far.
TEST(Adversary, DoesNotFoolPlans) {
    integrator::TbbExecutor executor(2);
    int above = 0, noisy = 0, figures = 0;
    for (uint32_t i = 0; i < kScenes; ++i) {
        const Verdict v = judge(i, {4e5, 6e5}, executor);
        SCOPED_TRACE(v.kind + " " + std::to_string(i));
        bool kept = true;
        for (const Row& row : v.rows) {
            kept = kept && !row.broken();
            EXPECT_FALSE(row.broken_twice())
                << row.model << ": " << row.predicted << ", truly from " << row.bias.low;
        }
        above += !kept;
        figures += !v.refused && !v.at_least;
        noisy += v.noise_exceeded();
        EXPECT_FALSE(v.noise_exceeded(1.5)) << v.noise_predicted << ' ' << v.noise.low;
    }
    EXPECT_LE(above, 1);
    EXPECT_LE(noisy, 1);
    EXPECT_GE(figures, 8) << "not everything is called \"at least\"";
}

}  // namespace
}  // namespace petzval::apps
