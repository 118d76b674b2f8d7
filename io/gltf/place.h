// SPDX-License-Identifier: Apache-2.0
// Meshes of a glTF scene, and their instances.
#pragma once

#include "core/scene/scene.h"
#include "io/gltf/materials.h"
#include "io/gltf/model.h"
#include "io/gltf/nodes.h"
#include "io/gltf/tally.h"
#include "io/gltf/variants.h"

namespace petzval {

/// Fills scene.meshes and scene.instances (and, through the materials, what they need). A mesh
/// that stands once, or is posed by a skin, is stored in world space; any other once in its own
/// space, with an instance for each place. Throws InputError.
void place_meshes(const GltfModel&, const GltfNodes&, const GltfVariant&, GltfMaterials&, Scene&,
                  GltfTally&);

}  // namespace petzval
