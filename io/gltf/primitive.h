// SPDX-License-Identifier: Apache-2.0
// One glTF primitive as a Mesh, in the mesh's own space.
#pragma once

#include <vector>

#include "core/scene/mesh.h"
#include "io/gltf/model.h"
#include "io/gltf/tally.h"

namespace tinygltf {
struct Primitive;
}

namespace petzval {

/// Whether a primitive is drawn. Not drawn are points, lines and primitives without positions,
/// which are counted, and modes that glTF does not have.
[[nodiscard]] bool is_drawn(const tinygltf::Primitive&, GltfTally&);

/// Reads attributes and triangles of a primitive that is drawn, and applies the morph targets with
/// their weights. Tangents are read only on request: they serve normal maps. Directions are as the
/// file has them, the material is left at 0.
[[nodiscard]] Mesh read_primitive(const GltfModel&, const tinygltf::Primitive&,
                                  const std::vector<double>& morph_weights, bool with_tangents,
                                  GltfTally&);

/// Accessor index of an attribute; -1 where the primitive has none of that name.
[[nodiscard]] int attribute(const tinygltf::Primitive&, const std::string& name);

}  // namespace petzval
