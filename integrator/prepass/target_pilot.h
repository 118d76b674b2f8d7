// SPDX-License-Identifier: Apache-2.0
// Pilot of the targets: a few rays to each, before the first sample, tell where they pay.
#pragma once

#include "camera/run_tasks.h"
#include "camera/target_camera.h"
#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// Those of a camera's targets that pay, cell by cell; nullptr where there is none. Half of a
/// chance is the same for all of a cell, half is in proportion to the light that each is found to
/// bring. They pay where they lower the square of the frame's mean noise times its cost. A pure
/// function of its arguments: at most 8 camera samples are rendered in a cell, in RGB, and about 48
/// rays to its targets; more to images. Each cell is a task.
[[nodiscard]] std::shared_ptr<const camera::TargetGrid> targets_that_pay(
    const camera::TargetCamera&, const Scene&, const Bvh&, const LightChoice&, V2i frame_px,
    const camera::RunTasks& = camera::one_by_one);

}  // namespace petzval::integrator
