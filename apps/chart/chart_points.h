// SPDX-License-Identifier: Apache-2.0
// Statistics of cost and error: intervals, efficiency, the Pareto front.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace petzval::apps {

struct Interval {
    double mean = 0, low = 0, high = 0;
};

/// Mean and its 95 % confidence interval under Student's t. At least 5 values.
[[nodiscard]] Interval confidence_95(std::span<const double> values);

/// Cost and errors of one render.
struct ChartSeed {
    uint32_t seed = 0;
    double cpu_s = 0, symmetric_mse = 0, relative_mse = 0, flip = 0;
};

/// Measurements of one method at one number of samples.
struct ChartPoint {
    uint32_t samples = 0;  ///< of each pixel
    std::vector<ChartSeed> seeds;

    [[nodiscard]] Interval cpu_s() const;
    [[nodiscard]] Interval symmetric_mse() const;
    [[nodiscard]] Interval relative_mse() const;
    [[nodiscard]] Interval flip() const;
    /// Efficiency 1 / (symmetric MSE * CPU s), 1/s, from the mean of the product over the seeds.
    /// `high` is infinite where the interval of the product reaches 0.
    [[nodiscard]] Interval efficiency() const;
};

/// Indices of the points {cost, error} that no other one beats: none is at most as costly, at most
/// as wrong, and better in one of the two. By increasing cost.
[[nodiscard]] std::vector<size_t> pareto_front(std::span<const std::array<double, 2>> points);

}  // namespace petzval::apps
