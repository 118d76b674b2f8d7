// SPDX-License-Identifier: Apache-2.0
// Lamps that shine into a camera.
#pragma once

#include "camera/pose.h"
#include "core/light/small_features.h"
#include "core/traversal/bvh.h"

namespace petzval::apps {

/// Whether a lamp in front of the camera is seen from the middle of its entrance pupil.
[[nodiscard]] bool shines_in(const SmallFeature& lamp, const camera::Pose&, const Bvh&);

}  // namespace petzval::apps
