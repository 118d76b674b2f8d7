// SPDX-License-Identifier: Apache-2.0
// Whether a scene can be seen by the light that its file gives it.
#pragma once

#include "core/scene/scene.h"

namespace petzval {

/// Light that a scene has of itself.
enum class OwnLight : uint8_t {
    None,   ///< it would be black
    Faint,  ///< something glows, and it would be black but for that
    Enough
};

/// Light of a scene that finish_scene() has not seen yet, its sky apart. Any light of
/// KHR_lights_punctual is enough, and so is a surface brighter than 1 nit: glTF's emissiveFactor
/// asks for no more, viewers show it but light nothing with it, and lamps have
/// KHR_materials_emissive_strength. Below that it counts how much glows: walls of a closed space
/// that reflect half of the light are as bright as the mean of what all surfaces emit (Goebel 1967,
/// "Generalized integrating-sphere theory"). Unlit materials need no light.
[[nodiscard]] OwnLight own_light(const Scene&);

}  // namespace petzval
