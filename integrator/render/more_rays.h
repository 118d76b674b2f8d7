// SPDX-License-Identifier: Apache-2.0
// Rays of samples that only some cameras have: to targets, and of a camera that moves.
#pragma once

#include <span>

#include "camera/camera.h"

namespace petzval {

/// Finds the rays of film points to the targets of a camera that has some.
void find_target_rays(const Camera&, std::span<const FilmPoint>, std::span<const Bands>,
                      std::span<CameraSample> out);

/// Draws a time for each film point, and moves its rays to where the camera stands then: ordinary
/// ones, and those to targets, of which there may be none.
void move_rays(const Shutter&, std::span<const FilmPoint>, std::span<CameraSample> ordinary,
               std::span<CameraSample> to_targets);

}  // namespace petzval
