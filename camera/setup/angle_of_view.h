// SPDX-License-Identifier: Apache-2.0
// Angle of view of a lens on its film.
#pragma once

#include <optional>

#include "camera/lens/lens.h"
#include "core/math/math.h"

namespace petzval::camera {

/// Vertical angle of view, radians, with a distant scene in focus: by the ray of line d through the
/// middle of the stop; the paraxial angle for a lens that sends none there.
[[nodiscard]] float angle_of_view_rad(const Lens&, float film_height_mm, double focal_length_mm);

/// The lens scaled until a distant scene yfov_rad high fills the film's height. Nothing where it
/// does not see so far to the side.
[[nodiscard]] std::optional<Lens> scaled_to_view(const Lens&, float film_height_mm, float yfov_rad);

}  // namespace petzval::camera
