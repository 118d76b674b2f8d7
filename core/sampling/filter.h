// SPDX-License-Identifier: Apache-2.0
// Reconstruction filters, sampled in proportion to their value, so that every sample of a pixel has
// the same weight (filter importance sampling: Ernst et al. 2006).
#pragma once

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
    [[nodiscard]] V2f sample(V2f u) const;
    /// Density of sample() at any offset, up to a factor: 1 at the centre, 0 beyond the radius.
    [[nodiscard]] float value(V2f offset_px) const {
        return value1(offset_px.x) * value1(offset_px.y);
    }

    [[nodiscard]] FilterKind kind() const { return kind_; }
    [[nodiscard]] float radius_px() const { return radius_px_; }

  private:
    [[nodiscard]] float sample1(float u) const;
    [[nodiscard]] float value1(float offset_px) const;

    FilterKind kind_;
    float radius_px_;
    std::vector<float> values_;     ///< profile on half an axis, at equal steps from the centre
    std::vector<float> quantiles_;  ///< of the left half, in pixels; see the constructor
};

}  // namespace petzval
