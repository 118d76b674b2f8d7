// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, and the cameras of a glTF file.
#pragma once

#include <vector>

#include "core/light.h"
#include "io/gltf.h"
#include "io/gltf_model.h"
#include "io/gltf_nodes.h"
#include "io/gltf_tally.h"

namespace petzval {

/// Punctual lights of the scene's nodes, in depth-first order; those of no intensity are left out.
[[nodiscard]] std::vector<Light> read_lights(const GltfModel&, const GltfNodes&, GltfTally&);

/// Cameras of the scene's nodes, in depth-first order.
[[nodiscard]] std::vector<GltfCamera> read_cameras(const GltfModel&, const GltfNodes&, GltfTally&);

}  // namespace petzval
