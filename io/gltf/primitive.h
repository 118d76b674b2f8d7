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

/// False for points, lines and primitives without positions, which are counted, and for modes that
/// glTF does not have.
[[nodiscard]] bool is_drawn(const tinygltf::Primitive&, GltfTally&);

/// Reads attributes and triangles of a primitive that is drawn, and applies the morph targets with
/// their weights. Tangents are read only on request: they serve normal maps. Directions are as the
/// file has them, the material is left at 0.
[[nodiscard]] Mesh read_primitive(const GltfModel&, const tinygltf::Primitive&,
                                  const std::vector<double>& morph_weights, bool with_tangents,
                                  GltfTally&);

/// Index of the accessor, -1 where the primitive has no such attribute.
[[nodiscard]] int attribute(const tinygltf::Primitive&, const std::string& name);

}  // namespace petzval
