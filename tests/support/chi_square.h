// SPDX-License-Identifier: Apache-2.0
// Pearson's chi-square test of samples against the density that they claim to have.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/statistics.h"

namespace petzval::test {

/// Compares counts with expectations, cell by cell. Cells that expect fewer than 5 are pooled, as
/// the statistic is not chi-square distributed for them; cells that expect nothing join that pool.
[[nodiscard]] inline ::testing::AssertionResult chi_square(const std::vector<double>& observed,
                                                           const std::vector<double>& expected) {
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    double statistic = 0, pooled_expected = 0, pooled_observed = 0, worst = 0;
    int cells = 0;
    std::string worst_cell;
    const auto close_pool = [&](size_t last) {
        const double term = std::pow(pooled_observed - pooled_expected, 2) / pooled_expected;
        if (term > worst)
            worst_cell = "; worst is cell " + std::to_string(last) + " with " +
                         std::to_string(pooled_observed) + " samples, not " +
                         std::to_string(pooled_expected);
        worst = std::max(worst, term);
        statistic += term;
        pooled_expected = pooled_observed = 0;
        ++cells;
    };
    for (const size_t i : order) {
        pooled_expected += expected[i];
        pooled_observed += observed[i];
        if (pooled_expected >= 5) close_pool(i);
    }
    if (pooled_expected < 1e-3 && pooled_observed > 0)
        return ::testing::AssertionFailure() << pooled_observed << " samples where none can fall";
    if (pooled_expected >= 1e-3) close_pool(order.back());
    if (cells < 2) return ::testing::AssertionFailure() << "fewer than two cells to compare";
    const double p = chi_square_p(statistic, cells - 1);
    if (p >= sidak()) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "chi-square " << statistic << " with " << cells - 1
                                         << " degrees of freedom: p = " << p << worst_cell;
}

/// Integral over a rectangle by 4 x 4 midpoints; halves the rectangle both ways at least
/// least_depth times, and then while that changes the result by more than 0.1 % and more than
/// `negligible`, at most 8 times. Densities that end abruptly need a least depth, or slivers slip
/// between the midpoints.
[[nodiscard]] inline double integrate(const std::function<double(double, double)>& f, double x0,
                                      double x1, double y0, double y1, double negligible,
                                      int least_depth = 0, int depth = 0) {
    const auto rule = [&](double ax, double bx, double ay, double by) {
        double sum = 0;
        for (int i = 0; i < 16; ++i)
            sum += f(ax + (bx - ax) * (i % 4 + 0.5) / 4, ay + (by - ay) * (i / 4 + 0.5) / 4);
        return sum * (bx - ax) * (by - ay) / 16;
    };
    const double xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
    if (depth >= least_depth) {
        const double coarse = rule(x0, x1, y0, y1);
        const double fine = rule(x0, xm, y0, ym) + rule(xm, x1, y0, ym) + rule(x0, xm, ym, y1) +
                            rule(xm, x1, ym, y1);
        if (depth == 8 || std::fabs(fine - coarse) <= std::max(1e-3 * std::fabs(fine), negligible))
            return fine;
    }
    const auto part = [&](double ax, double bx, double ay, double by) {
        return integrate(f, ax, bx, ay, by, negligible / 4, least_depth, depth + 1);
    };
    return part(x0, xm, y0, ym) + part(xm, x1, y0, ym) + part(x0, xm, ym, y1) +
           part(xm, x1, ym, y1);
}

/// What a chi-square test over a rectangle is made of. f is the density per unit of the rectangle's
/// area; place() gives a sample in its coordinates, or nothing where sampling failed.
struct Grid {
    double x0, x1, y0, y1;
    int columns, rows;
    int least_depth = 0;  ///< of the integration in a cell
};

/// Failures fill a cell of their own, which expects what the density leaves of 1.
[[nodiscard]] inline ::testing::AssertionResult chi_square_grid(
    const Grid& g, const std::function<double(double, double)>& density,
    const std::function<std::optional<V2f>(Random&)>& place, int samples, uint32_t seed) {
    const double width = (g.x1 - g.x0) / g.columns, height = (g.y1 - g.y0) / g.rows;
    std::vector<double> expected, observed(static_cast<size_t>(g.columns) * g.rows + 1);
    for (int row = 0; row < g.rows; ++row)
        for (int column = 0; column < g.columns; ++column)
            expected.push_back(samples * integrate(density, g.x0 + column * width,
                                                   g.x0 + (column + 1) * width, g.y0 + row * height,
                                                   g.y0 + (row + 1) * height, 1e-3 / samples,
                                                   g.least_depth));
    const double left = samples - std::accumulate(expected.begin(), expected.end(), 0.0);
    if (left < -0.01 * samples)
        return ::testing::AssertionFailure()
               << "the density integrates to " << 1 - left / samples << ", more than 1";
    Random random(seed);
    for (int i = 0; i < samples; ++i) {
        const auto at = place(random);
        if (!at) {
            ++observed.back();
            continue;
        }
        const int column = static_cast<int>((at->x - g.x0) / width);
        const int row = static_cast<int>((at->y - g.y0) / height);
        ++observed[static_cast<size_t>(std::clamp(row, 0, g.rows - 1)) * g.columns +
                   std::clamp(column, 0, g.columns - 1)];
    }
    // What integration leaves by its own error is not a failure that anyone expects.
    expected.push_back(left > 1e-3 * samples || observed.back() > 0 ? std::max(left, 0.0) : 0.0);
    return chi_square(observed, expected);
}

/// Directions over the whole sphere, in 30 x 60 cells of the polar angle and the azimuth about +z.
/// draw returns nothing where sampling fails; pdf is in 1/sr.
[[nodiscard]] inline ::testing::AssertionResult chi_square_sphere(
    const std::function<std::optional<V3f>(Random&)>& draw,
    const std::function<double(const V3f&)>& pdf, uint32_t seed, int samples = 200000,
    int least_depth = 0) {
    const double pi = std::numbers::pi;
    const auto density = [&](double azimuth, double polar) {
        const double s = std::sin(polar);
        return s * pdf(V3f(static_cast<float>(s * std::cos(azimuth)),
                           static_cast<float>(s * std::sin(azimuth)),
                           static_cast<float>(std::cos(polar))));
    };
    const auto place = [&](Random& random) -> std::optional<V2f> {
        const auto w = draw(random);
        if (!w) return std::nullopt;
        return V2f(std::atan2(w->y, w->x), std::atan2(std::hypot(w->x, w->y), w->z));
    };
    return chi_square_grid({-pi, pi, 0, pi, 60, 30, least_depth}, density, place, samples, seed);
}

}  // namespace petzval::test
