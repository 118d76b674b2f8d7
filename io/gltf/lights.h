// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, and the cameras of a glTF file.
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "io/gltf/gltf.h"
#include "io/gltf/model.h"
#include "io/gltf/nodes.h"
#include "io/gltf/tally.h"

namespace petzval {

/// Adds the punctual lights of the scene's nodes, in depth-first order, but those of no intensity;
/// and the illuminants that they name.
void read_lights(const GltfModel&, const GltfNodes&, Scene&, GltfTally&);

/// Cameras of the scene's nodes, in depth-first order.
[[nodiscard]] std::vector<GltfCamera> read_cameras(const GltfModel&, const GltfNodes&, GltfTally&);

}  // namespace petzval
