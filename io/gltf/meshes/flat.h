// SPDX-License-Identifier: Apache-2.0
// Matrices that flatten space.
#pragma once

#include "core/math/math.h"

namespace petzval::io {

/// Dimensions that a matrix leaves: 3, 2 where it flattens space onto a plane, 1 for a line or a
/// point, or where it is not finite.
[[nodiscard]] int dimensions_left(const M44d&);

/// Matrix in place of one that flattens onto a plane, for a mesh in that box: a sheet that is
/// thin enough not to show, but thick enough that what lay in front still does. Without it, fronts
/// and backs would lie at the same place, and which of them a ray meets would be left to rounding.
/// It does not mirror, as glTF 2.0, section 3.7.4 counts only a negative determinant as mirroring.
[[nodiscard]] M44d thickened(const M44d& flat, const Box3f& of_mesh);

}  // namespace petzval::io
