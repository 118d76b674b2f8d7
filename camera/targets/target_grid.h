// SPDX-License-Identifier: Apache-2.0
// Targets of a frame: which small bright things each part of it aims camera rays at.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "camera/target_camera.h"
#include "core/light/small_features.h"

namespace petzval::camera {

/// The ball around a lamp, as a target.
[[nodiscard]] Target target_of(const SmallFeature& lamp);

/// Targets for the lamps among some things: of each cell of 16 x 16 pixels or a little more those
/// that its rays pass, but few of them, by what each is expected to add to a pixel. nullptr where
/// there are none, or the frame is smaller than a cell. A function of
/// the arguments alone. No ray is cast into the scene. at_row is called before each row of cells:
/// an exception of it ends the search.
[[nodiscard]] std::shared_ptr<const TargetGrid> find_targets(
    const TargetCamera&, V2i size_px, std::span<const SmallFeature>,
    const std::function<void()>& at_row = [] {});

}  // namespace petzval::camera
