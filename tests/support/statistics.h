// SPDX-License-Identifier: Apache-2.0
// Significance: the few distributions that tests need, and the correction for running many tests.
//
// One policy for all tests: seeds are fixed; a mean is held against what is expected by agrees(),
// with as many degrees of freedom as its error has, a histogram by chi_square.h; and the chance
// that a correct program fails any of them is kAlpha. What is allowed beside chance is a tolerance
// with a reason.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>

#include "core/math/math.h"

namespace petzval::test {

/// Chance that a correct program fails one statistical test of the whole suite.
inline constexpr double kAlpha = 0.01;
/// Upper bound on the statistical tests (of means and of histograms) that the whole suite runs.
inline constexpr int kStatisticalTests = 1000;

/// Significance of each of n independent tests that together have kAlpha: Sidak 1967.
[[nodiscard]] inline double sidak(int tests = kStatisticalTests) {
    return -std::expm1(std::log1p(-kAlpha) / tests);
}

/// Chance that a standard normal number is at least as far from 0 as z.
[[nodiscard]] inline double two_sided_p(double z) {
    return std::erfc(std::fabs(z) / std::sqrt(2.0));
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

/// Regularised incomplete beta function I_x(a, b): the continued fraction (Abramowitz and Stegun
/// 1964, 26.5.8, by Lentz's method), on the side of the mean where it converges fast.
[[nodiscard]] inline double incomplete_beta(double a, double b, double x) {
    if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x)) /
                         a;
    double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), fraction = d;
    for (int m = 1; m < 100000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / (1 + even * d);
        c = 1 + even / c;
        fraction *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + odd * d);
        c = 1 + odd / c;
        fraction *= c * d;
        if (std::fabs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

/// Chance that a number of Student's t is at least as far from 0 as t. Abramowitz and Stegun 1964,
/// 26.7.1; beyond a million degrees of freedom it is the normal number's.
[[nodiscard]] inline double two_sided_t_p(double t, double degrees) {
    if (!(degrees < 1e6) || std::isinf(t)) return two_sided_p(t);
    return incomplete_beta(degrees / 2, 0.5, degrees / (degrees + t * t));
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

/// A mean with its standard error, and the degrees of freedom of that error: infinite where it is
/// known from theory.
struct Mean {
    double value = 0, error = 0, degrees = HUGE_VAL;

    Mean(double of_value, double standard_error, double of_degrees = HUGE_VAL)
        : value(of_value), error(standard_error), degrees(of_degrees) {}
    Mean(const Moments& m)  // NOLINT(google-explicit-constructor): a stream is its mean
        : value(m.mean()), error(m.standard_error()), degrees(m.count() - 1) {}
};
inline std::ostream& operator<<(std::ostream& out, const Mean& m) {
    return out << m.value << " +- " << m.error;
}

/// Of independent means; degrees by Welch 1947 and Satterthwaite 1946.
[[nodiscard]] inline Mean operator-(const Mean& a, const Mean& b) {
    const double va = a.error * a.error, vb = b.error * b.error;
    const double spread = va * va / a.degrees + vb * vb / b.degrees;
    return {a.value - b.value, std::sqrt(va + vb),
            spread > 0 ? (va + vb) * (va + vb) / spread : HUGE_VAL};
}

/// Chance that a mean is as far from what is expected, beyond a tolerance, if it estimates that.
[[nodiscard]] inline double p_of(const Mean& mean, double expected, double tolerance = 0) {
    const double off = std::fabs(mean.value - expected) - tolerance;
    if (off <= 0) return 1;
    return mean.error > 0 ? two_sided_t_p(off / mean.error, mean.degrees) : 0;
}

/// Does a mean agree with what is expected, but for a tolerance and for chance?
[[nodiscard]] inline bool agrees(const Mean& mean, double expected, double tolerance = 0) {
    return p_of(mean, expected, tolerance) >= sidak();
}

/// Least chance, place by place, that two lists of means differ by as much if they estimate the
/// same.
template <size_t N>
[[nodiscard]] double least_p(const std::array<Moments, N>& a, const std::array<Moments, N>& b) {
    double least = 1;
    for (size_t i = 0; i < N; ++i) least = std::min(least, p_of(Mean(a[i]) - Mean(b[i]), 0));
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
