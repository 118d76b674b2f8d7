// SPDX-License-Identifier: Apache-2.0
// A triangle as a point sees it: its solid angle, and directions that are uniform in it.
#pragma once

#include <array>

#include "core/math/math.h"

namespace petzval {

class SphericalTriangle {
  public:
    /// The triangle of three corners, none of them at p, as p sees it.
    SphericalTriangle(const V3f& p, const std::array<V3f, 3>& corner);

    /// Solid angle, sr; 0 to 2 pi. Van Oosterom and Strackee 1983, "The Solid Angle of a Plane
    /// Triangle", equation 8.
    [[nodiscard]] float solid_angle() const { return 4 * kPi * excess_turns_; }
    /// Unit direction from p, uniform in the solid angle, which must be above 0; u in [0, 1)^2.
    /// Arvo 1995, "Stratified Sampling of Spherical Triangles".
    [[nodiscard]] V3f direction(V2f u) const;

  private:
    V3d a_, b_, c_;  ///< unit, towards the corners
    double determinant_;
    float excess_turns_;  ///< half of the spherical excess
};

}  // namespace petzval
