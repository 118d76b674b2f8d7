// SPDX-License-Identifier: Apache-2.0
// Shapes of an iris, in units of their own: iris.h scales them. The optical axis is the origin; x
// to the right and y up as the photographer sees them from behind the camera, angles
// counter-clockwise. So the blur of a far light shows the shape as it is drawn here, that of a near
// light shows it turned by 180 degrees.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/math.h"

namespace petzval::camera {

/// The round stop itself.
struct Disk {};

/// Area that closed contours enclose. Either rule is SVG's of that name; they differ only where a
/// contour lies within another that runs the same way.
struct Polygon {
    std::vector<std::vector<V2d>> contours;  ///< the last vertex is joined to the first
    bool even_odd = false;                   ///< else non-zero, SVG's default
};

/// A grey-scale picture, its centre on the axis, its texels square and each of one transmission.
struct Mask {
    int width = 0, height = 0;
    std::vector<float> texels;  ///< transmission, [0, 1]; row 0 at the top
};

using ApertureShape = std::variant<Disk, Polygon, Mask>;

inline constexpr int kMinBlades = 3, kMaxBlades = 100;
/// Most vertices of a polygon, all contours together.
inline constexpr size_t kMaxPolygonVertices = 10000;
/// Largest magnitude of a coordinate.
inline constexpr double kMaxPolygonCoordinate = 1e9;

/// Regular polygon on the unit circle, its first vertex at angle 90 degrees + rotation. roundness,
/// [0, 1]: curvature of the blades' edges in units of the circle's; 1 is the circle. Curved edges
/// are polylines within 2e-4 of the arc; their vertices stand just so far outside it that the area
/// is the arc's. Throws std::invalid_argument for what is out of range.
[[nodiscard]] Polygon regular_polygon(int blades, double rotation_deg = 0, double roundness = 0);

/// Star of that many tips on the unit circle, the first at the top. The inner vertices stand at
/// (3 - sqrt 5) / 2 = 0.382, which makes five tips the pentagram {5/2}; scaled to the area of a
/// round stop its tips reach 1.673 of the stop's radius. Throws std::invalid_argument unless tips
/// are kMinBlades to kMaxBlades.
[[nodiscard]] Polygon star(int tips);

/// Square of side 2 with level edges.
[[nodiscard]] Polygon square();
/// Parallelogram of base 2 and height 1 that leans to the right by 1/2.
[[nodiscard]] Polygon rhomboid();
/// square() less a square hole of half its side.
[[nodiscard]] Polygon frame();

/// Fault that makes a polygon unusable, and its place; contour and vertex count from 0.
struct PolygonFault {
    size_t contour = 0, vertex = 0;
    std::string message;  ///< "contour 1, vertex 3 at (2, 0.5): ...", counted from 1
};
/// The first fault of a polygon: too few or too many vertices, one that is not finite or stands on
/// the next, an edge that runs back along the one before it or meets another edge.
[[nodiscard]] std::optional<PolygonFault> find_fault(const Polygon&);
/// Fault of a mask: its size, a texel outside of [0, 1], or all of them black.
[[nodiscard]] std::optional<std::string> find_fault(const Mask&);

}  // namespace petzval::camera
