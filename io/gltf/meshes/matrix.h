// SPDX-License-Identifier: Apache-2.0
// Properties of a node's matrix.
#pragma once

#include <array>
#include <cmath>

#include "core/math/math.h"

namespace petzval::io {

/// Determinant of the upper 3x3 part over the product of its rows' lengths: -1 to 1, 0 where the
/// matrix flattens space.
[[nodiscard]] double relative_determinant(const M44d&);
/// Whether a matrix flattens space.
[[nodiscard]] inline bool is_singular(const M44d& m) {
    return !(std::fabs(relative_determinant(m)) > 1e-14);  // a 0 that is rounded
}
/// Row of a matrix: the image of an axis (0 to 2), or of the origin (3).
[[nodiscard]] inline V3d row(const M44d& m, int axis) {
    return {m[axis][0], m[axis][1], m[axis][2]};
}

/// Greatest factor by which a matrix makes something longer, or a little more.
[[nodiscard]] double stretch(const M44d&);

/// Rotation by a quaternion (x, y, z, w) of any length; none for the length 0. Rows are the images
/// of the axes.
[[nodiscard]] M44d rotation_matrix(const std::array<double, 4>&);

}  // namespace petzval::io
