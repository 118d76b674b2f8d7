// SPDX-License-Identifier: Apache-2.0
// Options of an iris, without the shapes themselves.
#pragma once

#include <cstdint>

namespace petzval::camera {

/// Scale of a shape to the round stop. EqualArea: the shape has the area of the stop (a mask: area
/// times transmission), so that it lets through what the f-number says; it may reach beyond the
/// stop. Inscribed: the largest scale at which it does not.
enum class ApertureScale : uint8_t { EqualArea, Inscribed };

/// Methods to draw points of an iris. All are uniform by area (a mask: in proportion to its
/// transmission). Formula: in closed form (circle, triangle, parallelogram) or by the inverse of a
/// mask's running sums. Triangles: one is chosen by the running sum of their areas, then a point of
/// it. Alias: the same by an alias table. Rejection: points of the bounding box until one is
/// inside.
enum class IrisSampling : uint8_t { Formula, Triangles, Alias, Rejection };

}  // namespace petzval::camera
