// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, EXT_lights_ies, and the cameras of a glTF file.
#pragma once

#include <vector>

#include "core/scene/lamp.h"
#include "core/scene/scene.h"
#include "io/gltf/gltf.h"
#include "io/gltf/model.h"
#include "io/gltf/nodes.h"
#include "io/gltf/tally.h"

namespace petzval {

/// Adds the punctual lights of the scene's nodes, in depth-first order, but those of no intensity;
/// and the illuminants that they name. Those with a radius are returned, and are not yet in the
/// scene.
[[nodiscard]] std::vector<BallLamp> read_lights(const GltfModel&, const GltfNodes&, Scene&,
                                                GltfTally&);

/// Adds the lights of EXT_lights_ies likewise, and their profiles. Throws InputError for a profile
/// that cannot be read.
void read_profile_lights(const GltfModel&, const GltfNodes&, Scene&, GltfTally&);

/// Cameras of the scene's nodes, in depth-first order.
[[nodiscard]] std::vector<GltfCamera> read_cameras(const GltfModel&, const GltfNodes&, GltfTally&);

}  // namespace petzval
