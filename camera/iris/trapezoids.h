// SPDX-License-Identifier: Apache-2.0
// Trapezoids between level lines that tile a polygon: for its area, the part of it in a circle, and
// the pieces that are sampled.
#pragma once

#include <vector>

#include "camera/iris/aperture.h"

namespace petzval::camera {

/// Trapezoid of level bottom and top; x of the left and right side at each.
struct Trapezoid {
    double bottom, top;
    double left[2], right[2];  ///< at the bottom, at the top

    [[nodiscard]] double area() const {
        return (right[0] - left[0] + right[1] - left[1]) * (top - bottom) / 2;
    }
    /// Corner i, counter-clockwise from the lower left.
    [[nodiscard]] V2d corner(int i) const {
        return {i == 0   ? left[0]
                : i == 1 ? right[0]
                : i == 2 ? right[1]
                         : left[1],
                i < 2 ? bottom : top};
    }
};

/// Trapezoids that tile a polygon without fault, by rising bottom: every one lies between two
/// edges that are neighbours, as far up and down as they stay so. At most three for each vertex.
[[nodiscard]] std::vector<Trapezoid> trapezoids(const Polygon&);

/// Area that a convex trapezoid shares with the circle of that radius about the origin.
[[nodiscard]] double area_in_circle(const Trapezoid&, double radius);

}  // namespace petzval::camera
