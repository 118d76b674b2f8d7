// SPDX-License-Identifier: Apache-2.0
// A triangle as a point sees it: its solid angle, and directions that are uniform in it.
#pragma once

#include <algorithm>
#include <array>

#include "core/math/math.h"
#include "core/math/trig.h"

namespace petzval {

namespace spherical_triangle_detail {

inline V3d towards(const V3f& p, const V3f& corner) {
    const V3d d = V3d(corner) - V3d(p);
    return d / std::sqrt(d.dot(d));
}

// Unit vector across axis, on the side of v.
inline V3d across(const V3d& axis, const V3d& v) {
    const V3d d = v - axis * axis.dot(v);
    const double length = std::sqrt(d.dot(d));
    return length > 0. ? d / length : V3d(0.);
}

}  // namespace spherical_triangle_detail

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

inline SphericalTriangle::SphericalTriangle(const V3f& p, const std::array<V3f, 3>& corner)
    : a_(spherical_triangle_detail::towards(p, corner[0])),
      b_(spherical_triangle_detail::towards(p, corner[1])),
      c_(spherical_triangle_detail::towards(p, corner[2])) {
    determinant_ = std::fabs(a_.dot(b_.cross(c_)));
    const double cosines = 1. + a_.dot(b_) + b_.dot(c_) + c_.dot(a_);
    excess_turns_ = atan2_turns(static_cast<float>(determinant_), static_cast<float>(cosines));
}

// All sines and cosines of the drawn area come from one pair of unit length, which the polynomials
// give to 1e-7: its error is one of u only.
inline V3f SphericalTriangle::direction(V2f u) const {
    const double ab = a_.dot(b_), gap = 0.5 * (a_ - b_).dot(a_ - b_);  // 1 - ab
    const double alpha_x = b_.dot(c_) - ab * a_.dot(c_);
    const double scale = 1. / std::sqrt(alpha_x * alpha_x + determinant_ * determinant_);
    const double cos_alpha = alpha_x * scale, sin_alpha = determinant_ * scale;

    const SinCos drawn = sincos_turns(u.x * excess_turns_);
    const Imath::V2d unit_half = Imath::V2d(drawn.cosine, drawn.sine).normalized();
    const double half = unit_half.y, cos_half = unit_half.x;
    const double sine = 2. * half * cos_half, versine = 2. * half * half;
    const double s = sine * cos_alpha - (1. - versine) * sin_alpha;
    const double t = (1. - versine) * cos_alpha + sine * sin_alpha;
    const double x = sine * sin_alpha - versine * cos_alpha;          // t - cos_alpha
    const double y = sine * cos_alpha + (versine - gap) * sin_alpha;  // s + sin_alpha ab
    const double below = (y * s + x * t) * sin_alpha;
    const double q = below != 0. ? ((y * t - x * s) * cos_alpha - y) / below : 1.;
    const double cos_arc = std::clamp(q, -1., 1.);
    const V3d c = a_ * cos_arc +
                  spherical_triangle_detail::across(a_, c_) * std::sqrt(1. - cos_arc * cos_arc);
    const double drop = u.y * (1. - c.dot(b_));
    const V3d d = b_ * (1. - drop) + spherical_triangle_detail::across(b_, c) *
                                         std::sqrt(std::max(0., drop * (2. - drop)));
    return V3f(d);
}

}  // namespace petzval
