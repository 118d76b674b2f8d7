// SPDX-License-Identifier: Apache-2.0
// Targets as the film points of a cell see them.
#pragma once

#include <optional>

#include "camera/pose.h"
#include "camera/targets/stop_map.h"

namespace petzval::camera {

/// A target made ready for the cell of a map, in a frame of so many pixels; nothing where none of
/// the cell's rays passes it. iris_mm2: area of the iris.
[[nodiscard]] std::optional<ListedTarget> list_target(const Target&, const StopMap&, const Pose&,
                                                      V2i frame_px, double iris_mm2);

}  // namespace petzval::camera
