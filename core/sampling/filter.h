// SPDX-License-Identifier: Apache-2.0
// Reconstruction filters, sampled in proportion to their value, so that every sample of a pixel has
// the same weight (filter importance sampling: Ernst et al. 2006).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// Separable filters, not negative, 0 beyond the radius. Gauss has its standard deviation at a
/// third of the radius; BlackmanHarris is the minimum 4-term window (Harris 1978, "On the Use of
/// Windows for Harmonic Analysis", table 1: -92 dB).
enum class FilterKind { Box, Gauss, BlackmanHarris };

class Filter {
  public:
    /// The radius (half the width) must be above 0.
    Filter(FilterKind, float radius_px);
    /// Offset from the pixel's centre, in pixels, distributed as the filter. u in [0, 1)^2.
    [[nodiscard]] V2f sample(V2f u) const { return {sample1(u.x), sample1(u.y)}; }
    /// Density of sample() at any offset, up to a factor: 1 at the centre, 0 beyond the radius.
    [[nodiscard]] float value(V2f offset_px) const {
        return value1(offset_px.x) * value1(offset_px.y);
    }
    /// Density of sample(), 1/px^2.
    [[nodiscard]] float density_per_px2(V2f offset_px) const { return peak_ * value(offset_px); }

    [[nodiscard]] FilterKind kind() const { return kind_; }
    [[nodiscard]] float radius_px() const { return radius_px_; }

  private:
    static constexpr uint32_t kSteps = 1 << 10;  ///< of the table on one side: 4 KB
    [[nodiscard]] float sample1(float u) const;
    [[nodiscard]] float value1(float offset_px) const;

    FilterKind kind_;
    float radius_px_;
    float peak_;                    ///< density in the middle, 1/px^2
    std::vector<float> values_;     ///< profile on half an axis, at equal steps from the centre
    std::vector<float> quantiles_;  ///< of the left half, in pixels; see the constructor
};

// Branchless: which half it is cannot be predicted.
inline float Filter::sample1(float u) const {
    const float half = u - 0.5f;
    const float position = std::sqrt(1.f - 2.f * std::fabs(half)) * float{kSteps};
    const uint32_t step = std::min(static_cast<uint32_t>(position), kSteps - 1);
    const float* at = &quantiles_[step];
    return std::copysign(lerp(at[0], at[1], position - static_cast<float>(step)), half);
}

}  // namespace petzval
