// SPDX-License-Identifier: Apache-2.0
// Meshes of a glTF scene, and their instances.
#pragma once

#include <optional>

#include "core/scene/scene.h"
#include "io/gltf/animation/node_motion.h"
#include "io/gltf/document/model.h"
#include "io/gltf/document/nodes.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/document/variants.h"
#include "io/gltf/materials/materials.h"

namespace petzval::io {

/// Fills scene.meshes and scene.instances (and, through the materials, what they need). A mesh
/// that stands once, or is posed by a skin, is stored in world space; any other once in its own
/// space, with an instance for each place. What moves while the shutter is open moves in the scene:
/// nodes as instances, skins and morph targets as steps of a mesh. Points and lines are spheres and
/// cylinders of the radius in the world; without one they are skipped, and counted. Throws
/// InputError, also where all that would take more memory than there is.
void place_meshes(const GltfModel&, const GltfNodes&, const NodeMotion&, const GltfVariant&,
                  GltfMaterials&, Scene&, GltfTally&, std::optional<float> stroke_radius_m);

}  // namespace petzval::io
