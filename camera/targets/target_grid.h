// SPDX-License-Identifier: Apache-2.0
// Targets of a frame: which small bright things each part of it aims camera rays at.
#pragma once

#include <memory>
#include <span>

#include "camera/run_tasks.h"
#include "camera/target_camera.h"
#include "core/light/small_features.h"

namespace petzval::camera {

/// The ball around a lamp, as a target.
[[nodiscard]] Target target_of(const SmallFeature& lamp);

/// Targets for the lamps among some things: of each cell of the frame those that its rays pass, but
/// few of them; at most 256, by what each is expected to add to a pixel. A cell has 16 x 16 pixels;
/// less where there would be under 20 along a side, more where there would be over 48. nullptr
/// where there are none, or the frame is smaller than 16 x 16 pixels. A function of the arguments
/// alone. No ray is cast into the scene. Each cell is a task.
[[nodiscard]] std::shared_ptr<const TargetGrid> find_targets(const TargetCamera&, V2i size_px,
                                                             std::span<const SmallFeature>,
                                                             const RunTasks& = one_by_one);

}  // namespace petzval::camera
