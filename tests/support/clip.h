// SPDX-License-Identifier: Apache-2.0
// What of a polygon lies in a rectangle or around a point, by ways of its own: the reference for
// what iris shapes are cut into.
#pragma once

#include <algorithm>
#include <functional>
#include <numbers>
#include <vector>

#include "camera/iris/aperture.h"

namespace petzval::test {

[[nodiscard]] inline double signed_area(const std::vector<V2d>& contour) {
    double area = 0;
    for (size_t i = 0; i < contour.size(); ++i)
        area += contour[i].cross(contour[(i + 1) % contour.size()]) / 2;
    return area;
}

/// What lies where inside() is not negative. Sutherland and Hodgman 1974.
[[nodiscard]] inline std::vector<V2d> clip(const std::vector<V2d>& contour,
                                           const std::function<double(V2d)>& inside) {
    std::vector<V2d> out;
    for (size_t i = 0; i < contour.size(); ++i) {
        const V2d &a = contour[i], &b = contour[(i + 1) % contour.size()];
        const double ia = inside(a), ib = inside(b);
        if (ia >= 0) out.push_back(a);
        if ((ia >= 0) != (ib >= 0)) out.push_back(a + (b - a) * (ia / (ia - ib)));
    }
    return out;
}

/// Area in a rectangle; holes must run against the contours around them.
[[nodiscard]] inline double area_in(const camera::Polygon& polygon, double x0, double x1, double y0,
                                    double y1) {
    double area = 0;
    for (std::vector<V2d> c : polygon.contours) {
        c = clip(c, [=](V2d p) { return p.x - x0; });
        c = clip(c, [=](V2d p) { return x1 - p.x; });
        c = clip(c, [=](V2d p) { return p.y - y0; });
        area += signed_area(clip(c, [=](V2d p) { return y1 - p.y; }));
    }
    return area;
}

/// Turns of the contours about a point: the sum of the angles of all edges.
[[nodiscard]] inline int turns_about(const camera::Polygon& polygon, V2d p) {
    double angle = 0;
    for (const auto& contour : polygon.contours)
        for (size_t i = 0; i < contour.size(); ++i) {
            const V2d a = contour[i] - p, b = contour[(i + 1) % contour.size()] - p;
            angle += std::atan2(a.cross(b), a.dot(b));
        }
    return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

[[nodiscard]] inline double distance_to_edge(const camera::Polygon& polygon, V2d p) {
    double least = HUGE_VAL;
    for (const auto& contour : polygon.contours)
        for (size_t i = 0; i < contour.size(); ++i) {
            const V2d &a = contour[i], along = contour[(i + 1) % contour.size()] - a;
            const double t = std::clamp((p - a).dot(along) / along.dot(along), 0.0, 1.0);
            least = std::min(least, (p - a - along * t).length());
        }
    return least;
}

}  // namespace petzval::test
