// SPDX-License-Identifier: Apache-2.0
// Significance: the few distributions that tests need, and the correction for running many tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/math/math.h"

namespace petzval::test {

/// Chance that a correct program fails one statistical test of the whole suite.
inline constexpr double kAlpha = 0.01;
/// Upper bound on the statistical tests (chi-square and z) that the whole suite runs.
inline constexpr int kStatisticalTests = 1000;

/// Significance of each of n independent tests that together have kAlpha: Sidak 1967.
[[nodiscard]] inline double sidak(int tests = kStatisticalTests) {
    return -std::expm1(std::log1p(-kAlpha) / tests);
}

/// Chance that a standard normal number is at least as far from 0 as z.
[[nodiscard]] inline double two_sided_p(double z) {
    return std::erfc(std::fabs(z) / std::sqrt(2.0));
}

/// Does a mean with this standard error agree with what is expected?
[[nodiscard]] inline bool z_test(double mean, double standard_error, double expected) {
    return two_sided_p((mean - expected) / standard_error) >= sidak();
}

/// Upper tail Q(a, x) of the regularised incomplete gamma function: the series (Abramowitz and
/// Stegun 1964, 6.5.29) below a + 1, the continued fraction (6.5.31, by Lentz's method) above.
[[nodiscard]] inline double upper_gamma(double a, double x) {
    if (x <= 0) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
    for (int i = 1; i < 100000; ++i) {
        const double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        fraction *= c * d;
        if (std::fabs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

/// Chance that a chi-square number with that many degrees of freedom is at least x.
[[nodiscard]] inline double chi_square_p(double x, double degrees) {
    return upper_gamma(degrees / 2, x / 2);
}

/// Mean and variance of a stream of numbers: Welford 1962.
class Moments {
  public:
    void add(double x) {
        const double delta = x - mean_;
        mean_ += delta / ++count_;
        squares_ += delta * (x - mean_);
    }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double variance() const { return squares_ / (count_ - 1); }
    [[nodiscard]] double standard_error() const { return std::sqrt(variance() / count_); }
    [[nodiscard]] double count() const { return count_; }

  private:
    double count_ = 0, mean_ = 0, squares_ = 0;
};

/// Least chance, place by place, that two lists of means differ by as much if they estimate the
/// same.
template <size_t N>
[[nodiscard]] double least_p(const std::array<Moments, N>& a, const std::array<Moments, N>& b) {
    double least = 1;
    for (size_t i = 0; i < N; ++i) {
        const double error = std::hypot(a[i].standard_error(), b[i].standard_error());
        least = std::min(least, two_sided_p((a[i].mean() - b[i].mean()) / error));
    }
    return least;
}

/// Numbers in [0, 1) that are the same on every machine: hashes of a counter.
class Random {
  public:
    explicit Random(uint32_t seed) : seed_(seed) {}
    float next() { return to_unit_float(hash32(seed_, count_++)); }
    V2f next2() {
        const float x = next();
        return {x, next()};
    }
    /// Uniform direction: a point of the unit ball, pushed out.
    V3f direction() {
        for (;;) {
            const float x = 2 * next() - 1, y = 2 * next() - 1, z = 2 * next() - 1;
            const float length2 = x * x + y * y + z * z;
            if (length2 > 1e-4f && length2 <= 1.f) return V3f(x, y, z) / std::sqrt(length2);
        }
    }

  private:
    uint32_t seed_, count_ = 0;
};

}  // namespace petzval::test
