// SPDX-License-Identifier: Apache-2.0
#include "core/filter.h"

#include <array>

namespace petzval {
namespace {

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

Filter::Filter(FilterKind kind, float radius_px) : kind_(kind), radius_px_(radius_px) {
    constexpr int kCells = 1024;
    std::array<float, kCells> weights;
    for (int i = 0; i < kCells; ++i)
        weights[i] =
            static_cast<float>(profile(kind, (2 * i + 1) / static_cast<double>(kCells) - 1));
    profile_ = Piecewise1D(weights);
}

float Filter::sample1(float u) const {
    const Piecewise1D::Draw drawn = profile_.sample(u);
    return radius_px_ * (2.f * (drawn.cell + drawn.offset) / profile_.size() - 1.f);
}

V2f Filter::sample(V2f u) const {
    return {sample1(u.x), sample1(u.y)};
}

}  // namespace petzval
