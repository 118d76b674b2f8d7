// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/filter.h"

#include <algorithm>

namespace petzval {
namespace {

// Steps of the table on one side: 4 KB.
constexpr uint32_t kSteps = 1 << 10;

// Value at x in [-1, 1], up to a factor.
double profile(FilterKind kind, double x) {
    const double pi = static_cast<double>(kPi);
    switch (kind) {
        case FilterKind::Box:
            return 1;
        case FilterKind::Gauss:
            return std::exp(-4.5 * x * x);
        case FilterKind::BlackmanHarris:
            break;
    }
    return 0.35875 + 0.48829 * std::cos(pi * x) + 0.14128 * std::cos(2 * pi * x) +
           0.01168 * std::cos(3 * pi * x);
}

}  // namespace

// The profile is integrated on a fine grid and its quantiles are read off, with straight lines
// between them: a lookup without a search, as every camera ray makes two. One half is enough, at
// equal steps of the root of the probability, which are fine where the tail is thin.
Filter::Filter(FilterKind kind, float radius_px) : kind_(kind), radius_px_(radius_px) {
    constexpr int cells = 1 << 17, values = 1 << 9;
    for (int i = 0; i <= values; ++i)
        values_.push_back(
            static_cast<float>(profile(kind, i / static_cast<double>(values)) / profile(kind, 0)));
    std::vector<double> cdf(cells + 1, 0.0);
    for (int i = 0; i < cells; ++i)
        cdf[i + 1] = cdf[i] + profile(kind, (2 * i + 1) / static_cast<double>(cells) - 1);
    int cell = 0;
    for (uint32_t k = 0; k <= kSteps; ++k) {
        const double root = static_cast<double>(k) / kSteps, wanted = cdf[cells] * root * root / 2;
        while (cell + 1 < cells && cdf[cell + 1] <= wanted) ++cell;
        const double within = (wanted - cdf[cell]) / (cdf[cell + 1] - cdf[cell]);
        const double x = 2 * (cell + std::clamp(within, 0.0, 1.0)) / cells - 1;
        quantiles_.push_back(static_cast<float>(radius_px * std::min(x, 0.)));
    }
}

// Branchless: which half it is cannot be predicted.
float Filter::sample1(float u) const {
    const float half = u - 0.5f;
    const float position = std::sqrt(1.f - 2.f * std::fabs(half)) * float{kSteps};
    const uint32_t step = std::min(static_cast<uint32_t>(position), kSteps - 1);
    const float* at = &quantiles_[step];
    return std::copysign(lerp(at[0], at[1], position - static_cast<float>(step)), half);
}

float Filter::value1(float offset_px) const {
    const float position =
        std::fabs(offset_px) / radius_px_ * static_cast<float>(values_.size() - 1);
    const auto last = static_cast<float>(values_.size() - 1);
    if (!(position < last)) return position == last ? values_.back() : 0.f;
    const auto step = static_cast<size_t>(position);
    return lerp(values_[step], values_[step + 1], position - static_cast<float>(step));
}

V2f Filter::sample(V2f u) const {
    return {sample1(u.x), sample1(u.y)};
}

}  // namespace petzval
