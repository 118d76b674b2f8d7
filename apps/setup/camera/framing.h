// SPDX-License-Identifier: Apache-2.0
// Framing: where a camera stands so that a scene fills its picture.
#pragma once

#include <array>
#include <optional>

#include "core/scene/scene.h"

namespace petzval::apps {

/// Eye and target of a camera that sees the whole scene, as near as can be but for a narrow margin,
/// from the front, a little from above and the right. What is flat is seen from where it is broad.
/// yfov_rad: vertical angle of view. aspect: width over height. stand_back_m: by how much further
/// away the eye stands, for a lens that sees less when it is focused near. all_around: it sees the
/// whole scene also when the scene is turned about the vertical axis through its middle. Nothing
/// for a scene that is too large, or too far away, for a camera's numbers.
[[nodiscard]] std::optional<std::array<V3f, 2>> frame_scene(const Scene&, float yfov_rad,
                                                            float aspect, double stand_back_m,
                                                            bool all_around = false);

}  // namespace petzval::apps
