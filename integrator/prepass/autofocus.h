// SPDX-License-Identifier: Apache-2.0
// Autofocus: depth of the scene under a point of the film.
#pragma once

#include <optional>

#include "camera/camera.h"
#include "core/traversal/bvh.h"

namespace petzval::integrator {

/// Depth, metres: distance along `axis` (unit, the camera's viewing direction) from `eye` to what a
/// point of the film shows; nothing where the ray of the film's point meets nothing.
[[nodiscard]] std::optional<float> depth_under(const Scene&, const Bvh&,
                                               const camera::Camera& pinhole, const V3f& eye,
                                               const V3f& axis, V2f film);

/// Median depth over the middle ninth of the film; nothing where that is empty.
[[nodiscard]] std::optional<float> depth_of_middle(const Scene&, const Bvh&,
                                                   const camera::Camera& pinhole, const V3f& eye,
                                                   const V3f& axis);

}  // namespace petzval::integrator
