// SPDX-License-Identifier: Apache-2.0
// Pilot of the light choice: a few paths through a scene, before its first sample.
#pragma once

#include "camera/camera.h"
#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/spectrum/observer.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// The choice, fitted by a pilot where lights at infinity and others share it; the choice itself
/// elsewhere. A pure function of its arguments: the pilot has a fixed number of paths over the full
/// frame and numbers of its own.
[[nodiscard]] LightChoice fitted_by_pilot(const LightChoice&, const Scene&, const Bvh&,
                                          const camera::Camera&, const Observer&, V2i frame_px);

}  // namespace petzval::integrator
