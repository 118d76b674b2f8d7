// SPDX-License-Identifier: Apache-2.0
// Verdicts on plans of scenes that are made to fool them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "apps/plan/plan.h"
#include "tests/measure/plan_truth.h"

namespace petzval {

/// Samples of all pixels together.
struct JudgeBudget {
    double truth_samples = 5e6;  ///< of bias and of noise each
    double plan_samples = 5e6;   ///< that a plan may take
};

/// What a plan says of a model, and what is true.
struct Row {
    std::string model;
    double predicted = 0;
    Bounded bias;  ///< roots
    bool chosen = false;
    bool outside = false;  ///< the plan says that it is surely beyond the tolerance: no promise
    [[nodiscard]] bool broken() const { return !outside && bias.low > predicted; }
    [[nodiscard]] bool broken_twice() const { return !outside && bias.low > 2 * predicted; }
};

/// Plan of a scene, and the truth about it.
struct Verdict {
    uint32_t index = 0;
    std::string kind;
    bool decoy = false, refused = false, at_least = false, needless = false;
    double tolerance = 0, plan_cpu_s = 0, truth_cpu_s = 0, noise_predicted = 0;
    uint64_t samples = 0;
    Bounded noise;  ///< roots
    std::vector<Row> rows;

    /// The row of what was chosen; nullptr where the plan was refused.
    [[nodiscard]] const Row* chosen() const;
    [[nodiscard]] bool noise_exceeded(double times = 1) const {
        return !refused && !at_least && noise.low > times * noise_predicted;
    }
    [[nodiscard]] bool beyond_tolerance() const {
        return chosen() && std::hypot(chosen()->bias.low, noise.low) > tolerance && !at_least;
    }
};

/// Verdict on the plan of plan_scene(index).
[[nodiscard]] Verdict judge(uint32_t index, const JudgeBudget&, integrator::TbbExecutor&);

}  // namespace petzval
