// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, EXT_lights_ies, and the cameras of a glTF file.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/scene/lamp.h"
#include "core/scene/scene.h"
#include "io/gltf/animation/node_motion.h"
#include "io/gltf/document/model.h"
#include "io/gltf/document/nodes.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/gltf.h"

namespace petzval::io {

/// Adds the punctual lights of the scene's nodes, in depth-first order, but those of no intensity;
/// and the illuminants that they name. Those with a radius are returned, and are not yet in the
/// scene.
[[nodiscard]] std::vector<BallLamp> read_lights(const GltfModel&, const GltfNodes&,
                                                const NodeMotion&, Scene&, GltfTally&);

/// Lamps of the visible nodes that have an area (area_extras), likewise. Adds the illuminants that
/// they name. Throws InputError where a node's light has no use for one.
[[nodiscard]] std::vector<FlatLamp> read_flat_lamps(const GltfModel&, const GltfNodes&,
                                                    const NodeMotion&, Scene&, GltfTally&);

/// Adds the lights of EXT_lights_ies likewise, and their profiles. Throws InputError for a profile
/// that cannot be read.
void read_profile_lights(const GltfModel&, const GltfNodes&, const NodeMotion&, Scene&, GltfTally&);

/// Makes the last light of the scene move as a node does, where that moves: make(place) gives the
/// light at a place in the world, or nothing where it cannot be.
void move_last_light(const NodeMotion&, int node, Scene&, GltfTally&,
                     const std::function<std::optional<Light>(const M44d&)>& make);

/// Cameras of the scene's nodes, in depth-first order.
[[nodiscard]] std::vector<GltfCamera> read_cameras(const GltfModel&, const GltfNodes&,
                                                   const NodeMotion&, GltfTally&);

}  // namespace petzval::io
