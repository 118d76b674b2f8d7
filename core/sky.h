// SPDX-License-Identifier: Apache-2.0
// Light from infinitely far: an equirectangular picture or one colour, and its importance sampling.
#pragma once

#include "core/distribution.h"
#include "core/math.h"
#include "core/spectrum.h"

namespace petzval {

/// Directions are world space. u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi from the top, before
/// the rotation about +y (counter-clockwise seen from above).
class Sky {
  public:
    /// A black sky.
    Sky() = default;
    /// The same radiance, in nits, from everywhere.
    static Sky uniform(Rgb radiance);
    /// RGB texels in nits, row 0 at the zenith; strength multiplies them. Texels must be finite and
    /// not negative.
    static Sky picture(std::vector<float> rgb, int width, int height, float rotate_deg,
                       float strength);

    [[nodiscard]] bool black() const { return average_ <= 0.f; }
    /// Mean luminance over the sphere, nits.
    [[nodiscard]] float average_luminance() const { return average_; }
    [[nodiscard]] Rgb radiance(const V3f& direction) const;
    /// Draws a direction in proportion to luminance.
    [[nodiscard]] V3f sample(V2f u) const;
    /// Density of `sample`, 1/sr; 0 for a black sky.
    [[nodiscard]] float pdf(const V3f& direction) const;

  private:
    [[nodiscard]] V2f to_uv(const V3f& direction) const;

    Rgb colour_{0.f};
    float average_ = 0.f;
    int width_ = 0, height_ = 0;  ///< 0: uniform
    std::vector<float> rgb_;
    float turn_ = 0.f;  ///< rotation in turns
    Piecewise2D importance_;
};

}  // namespace petzval
