// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {
namespace {

constexpr double kPi_d = std::numbers::pi;
// a0 to a3 of the window: Harris 1978, table 1.
constexpr double kA0 = 0.35875, kA1 = 0.48829, kA2 = 0.14128, kA3 = 0.01168;

// Value at x in [-1, 1], up to a factor.
double profile(FilterKind kind, double x) {
    switch (kind) {
        case FilterKind::Box:
            return 1;
        case FilterKind::Gauss:
            return std::exp(-4.5 * x * x);
        case FilterKind::BlackmanHarris:
            break;
    }
    return kA0 + kA1 * std::cos(kPi_d * x) + kA2 * std::cos(2 * kPi_d * x) +
           kA3 * std::cos(3 * kPi_d * x);
}

// Integral of the profile from -1 to x.
double integral(FilterKind kind, double x) {
    switch (kind) {
        case FilterKind::Box:
            return x + 1;
        case FilterKind::Gauss: {
            const double root = std::sqrt(4.5);
            return std::sqrt(kPi_d) / (2 * root) * (std::erf(root * x) + std::erf(root));
        }
        case FilterKind::BlackmanHarris:
            break;
    }
    return kA0 * (x + 1) + (kA1 * std::sin(kPi_d * x) + kA2 / 2 * std::sin(2 * kPi_d * x) +
                            kA3 / 3 * std::sin(3 * kPi_d * x)) /
                               kPi_d;
}

// Place below which the integral is `wanted`, at `least` or right of it. Newton's iteration: the
// profile rises up to 0, so that after one step it comes from the right and never jumps back.
double quantile(FilterKind kind, double wanted, double least) {
    constexpr int kMostSteps = 50;
    double x = least;
    for (int i = 0; i < kMostSteps; ++i) {
        const double step = (integral(kind, x) - wanted) / profile(kind, x);
        x = std::clamp(x - step, least, 0.);
        if (std::fabs(step) < 1e-10) break;
    }
    return x;
}

}  // namespace

// The quantiles are read off at few places, with straight lines between them: a lookup without a
// search, as every camera ray makes two. One half is enough, at equal steps of the root of the
// probability, which are fine where the tail is thin.
Filter::Filter(FilterKind kind, float radius_px) : kind_(kind), radius_px_(radius_px) {
    constexpr int values = 1 << 9;
    for (int i = 0; i <= values; ++i)
        values_.push_back(
            static_cast<float>(profile(kind, i / static_cast<double>(values)) / profile(kind, 0)));
    const double half = integral(kind, 0);
    peak_ = static_cast<float>(sqr(profile(kind, 0) / (2 * half * double(radius_px))));
    double x = -1;
    for (uint32_t k = 0; k <= kSteps; ++k) {
        const double root = static_cast<double>(k) / kSteps;
        x = quantile(kind, half * root * root, x);
        quantiles_.push_back(static_cast<float>(radius_px * x));
    }
}

float Filter::value1(float offset_px) const {
    const float position =
        std::fabs(offset_px) / radius_px_ * static_cast<float>(values_.size() - 1);
    const auto last = static_cast<float>(values_.size() - 1);
    if (!(position < last)) return position == last ? values_.back() : 0.f;
    const auto step = static_cast<size_t>(position);
    return lerp(values_[step], values_[step + 1], position - static_cast<float>(step));
}

}  // namespace petzval
