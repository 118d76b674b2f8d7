// SPDX-License-Identifier: Apache-2.0
// SVG outlines as cubic Bezier curves: transforming the control points transforms the curve, which
// is not so for an arc's radii.
#pragma once

#include <Imath/ImathMatrix.h>

#include <string>
#include <string_view>
#include <vector>

#include "camera/iris/aperture.h"

namespace petzval::io {

/// A path as SVG has it.
namespace svg {

struct Cubic {
    V2d a, b, end;  ///< control points after the start, which is where the last one ended
    bool straight = false;
};
struct Subpath {
    V2d start;
    std::vector<Cubic> curves;
};
using Outline = std::vector<Subpath>;

}  // namespace svg

/// Place of a text in its file, for errors.
struct TextPlace {
    std::string file, place;
};

/// Outline from the d attribute of a path: M L H V C S Q T A Z in both cases (SVG 2, chapter 9).
/// Throws InputError with the character at which it goes wrong.
[[nodiscard]] svg::Outline read_svg_path(std::string_view data, const TextPlace&);
/// Outline from the points attribute of a polygon. Throws InputError.
[[nodiscard]] svg::Outline read_svg_points(std::string_view points, const TextPlace&);
/// Matrix of a transform attribute: matrix, translate, scale, rotate, skewX, skewY. Throws
/// InputError.
[[nodiscard]] Imath::M33d read_svg_transform(std::string_view text, const TextPlace&);
/// Numbers that commas and spaces separate. Throws InputError unless there are exactly n.
[[nodiscard]] std::vector<double> read_svg_numbers(std::string_view text, size_t n,
                                                   const TextPlace&);

/// Adds part of an ellipse whose axes are turned by turn_rad, in pieces of at most 45 degrees, each
/// within 5e-6 of the radius (Goldapp 1991, "Approximation of circular arcs by cubic polynomials").
void add_ellipse_arc(svg::Subpath&, V2d centre, V2d radii, double turn_rad, double from_rad,
                     double by_rad);

/// Polygon contours within 1e-4 of half the outline's larger extent. Points that fall on the one
/// before them are left out. Stops soon after kMaxPolygonVertices; find_fault() reports that.
[[nodiscard]] std::vector<std::vector<V2d>> flatten(const svg::Outline&);

}  // namespace petzval::io
