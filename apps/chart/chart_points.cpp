// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "apps/setup/student_t.h"

namespace petzval::apps {
namespace {

template <class F>
Interval over_seeds(const ChartPoint& point, const F& value) {
    std::vector<double> values;
    for (const ChartSeed& seed : point.seeds) values.push_back(value(seed));
    return confidence_95(values);
}

}  // namespace

Interval confidence_95(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.) / n;
    double squares = 0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    const double half = student_t_975(n - 1) * std::sqrt(squares / (n - 1) / n);
    return {mean, mean - half, mean + half};
}

Interval ChartPoint::cpu_s() const {
    return over_seeds(*this, [](const ChartSeed& s) { return s.cpu_s; });
}
Interval ChartPoint::symmetric_mse() const {
    return over_seeds(*this, [](const ChartSeed& s) { return s.symmetric_mse; });
}
Interval ChartPoint::relative_mse() const {
    return over_seeds(*this, [](const ChartSeed& s) { return s.relative_mse; });
}
Interval ChartPoint::flip() const {
    return over_seeds(*this, [](const ChartSeed& s) { return s.flip; });
}
Interval ChartPoint::efficiency() const {
    const Interval product =
        over_seeds(*this, [](const ChartSeed& s) { return s.symmetric_mse * s.cpu_s; });
    return {1 / product.mean, 1 / product.high,
            product.low > 0 ? 1 / product.low : std::numeric_limits<double>::infinity()};
}

std::vector<size_t> pareto_front(std::span<const std::array<double, 2>> points) {
    std::vector<size_t> order(points.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return points[a] < points[b]; });
    std::vector<size_t> front;
    for (const size_t i : order) {
        // Equals of the last one on the front are not beaten by it.
        if (front.empty() || points[i][1] < points[front.back()][1] ||
            points[i] == points[front.back()])
            front.push_back(i);
    }
    return front;
}

}  // namespace petzval::apps
