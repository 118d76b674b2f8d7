// SPDX-License-Identifier: Apache-2.0
#include "core/light/spherical_triangle.h"

#include <algorithm>

#include "core/math/trig.h"

namespace petzval {
namespace {

V3d towards(const V3f& p, const V3f& corner) {
    const V3d d = V3d(corner) - V3d(p);
    return d / std::sqrt(d.dot(d));
}

// Unit vector across axis, on the side of v.
V3d across(const V3d& axis, const V3d& v) {
    const V3d d = v - axis * axis.dot(v);
    const double length = std::sqrt(d.dot(d));
    return length > 0. ? d / length : V3d(0.);
}

}  // namespace

SphericalTriangle::SphericalTriangle(const V3f& p, const std::array<V3f, 3>& corner)
    : a_(towards(p, corner[0])), b_(towards(p, corner[1])), c_(towards(p, corner[2])) {
    determinant_ = std::fabs(a_.dot(b_.cross(c_)));
    const double cosines = 1. + a_.dot(b_) + b_.dot(c_) + c_.dot(a_);
    excess_turns_ = atan2_turns(static_cast<float>(determinant_), static_cast<float>(cosines));
}

// All sines and cosines of the drawn area come from one pair of unit length, which the polynomials
// give to 1e-7: its error is one of u only.
V3f SphericalTriangle::direction(V2f u) const {
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
    const V3d c = a_ * cos_arc + across(a_, c_) * std::sqrt(1. - cos_arc * cos_arc);
    const double drop = u.y * (1. - c.dot(b_));
    const V3d d = b_ * (1. - drop) + across(b_, c) * std::sqrt(std::max(0., drop * (2. - drop)));
    return V3f(d);
}

}  // namespace petzval
