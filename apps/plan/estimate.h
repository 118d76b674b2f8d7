// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace petzval::apps {

/// A mean over the pixels of a frame, its standard error, and what pixels that were not sampled
/// may add.
struct Estimate {
    double mean = 0, error = 0;
    double unseen = 0;  ///< upper bound

    /// Standard errors from the mean to a bound: more than the 1.645 of 95 %, as pixels have long
    /// tails and a few of them hide the worst.
    static constexpr double kSure = 2;
    [[nodiscard]] double high() const { return std::max(mean, 0.) + kSure * error + unseen; }
    [[nodiscard]] double low() const { return std::max(mean - kSure * error, 0.); }
};

}  // namespace petzval::apps
