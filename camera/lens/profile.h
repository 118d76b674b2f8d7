// SPDX-License-Identifier: Apache-2.0
// Outlines of a lens in a plane through its axis.
#pragma once

#include <array>
#include <vector>

#include "camera/lens/lens.h"
#include "camera/lens/paraxial.h"

namespace petzval::camera {

/// Sag, z from the surface's own vertex, at a height in a section, mm; NaN beyond the conic's
/// reach.
[[nodiscard]] double sag_mm(const LensSurface&, double height_mm, Section);

using Outline = std::vector<std::array<double, 2>>;  ///< {z, height}, mm; z from the first vertex

/// Outline of a surface from edge to edge, bottom first; as far as it reaches.
[[nodiscard]] Outline surface_outline(const Lens&, int surface, Section);

/// Closed outline of the glass behind a surface: both its faces and a rim at the larger of the two
/// heights. Empty where air follows.
[[nodiscard]] Outline element_outline(const Lens&, int surface, Section);

}  // namespace petzval::camera
