// SPDX-License-Identifier: Apache-2.0
// Lens focused at a distance that counts from its entrance pupil, as all of Petzval's do.
#pragma once

#include <limits>
#include <optional>

#include "camera/lens/focus.h"
#include "camera/lens/lens.h"

namespace petzval::camera {

struct FocusedLens {
    Lens lens;
    double entrance_pupil_mm;  ///< from the first vertex, paraxial, line d
};

/// The lens with an axial point sharp at distance_mm in front of its entrance pupil; infinite for a
/// distant one. The pupil is that of the lens in focus: a group that focuses moves it, so that both
/// are found together. stop_radius_mm: as for focused(). Nothing where the lens cannot focus there.
[[nodiscard]] std::optional<FocusedLens> focused_from_pupil(
    const Lens&, double distance_mm, FocusBy = FocusBy::Paraxial,
    double stop_radius_mm = std::numeric_limits<double>::infinity());

}  // namespace petzval::camera
