// SPDX-License-Identifier: Apache-2.0
// Which cameras can aim their rays at targets.
#pragma once

#include <memory>

#include "camera/target_camera.h"

namespace petzval::camera {

/// Camera that aims the rays of another at targets, of which it has none yet; nullptr for one whose
/// rays nobody can aim.
[[nodiscard]] std::unique_ptr<TargetCamera> target_camera(const std::shared_ptr<const Camera>&);

}  // namespace petzval::camera
