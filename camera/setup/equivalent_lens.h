// SPDX-License-Identifier: Apache-2.0
// Equivalent pinhole: the simple camera that comes nearest to a lens.
#pragma once

#include <optional>

#include "camera/camera.h"
#include "camera/setup/focus_plane.h"

namespace petzval::camera {

/// Vertical angle of view, degrees, at which a pinhole in the entrance pupil sees the plane of
/// focus as the lens does at half the height of the film. From 2,048 rays. Nothing where the lens
/// leaves that dark.
[[nodiscard]] std::optional<float> equivalent_fov_deg(const Camera&, const FocusPlane&);

}  // namespace petzval::camera
