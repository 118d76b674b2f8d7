// SPDX-License-Identifier: Apache-2.0
// One glTF primitive as a Mesh, in the mesh's own space.
#pragma once

#include <vector>

#include "core/mesh.h"
#include "io/gltf_model.h"
#include "io/gltf_tally.h"

namespace tinygltf {
struct Primitive;
}

namespace petzval {

/// False, and counted, for points, lines and primitives without positions.
[[nodiscard]] bool is_drawn(const tinygltf::Primitive&, GltfTally&);

/// Reads attributes and triangles of a primitive that is drawn, and applies the morph targets with
/// their weights. Tangents are read only on request: they serve normal maps. Directions are as the
/// file has them, the material is left at 0. Throws InputError.
[[nodiscard]] Mesh read_primitive(const GltfModel&, const tinygltf::Primitive&,
                                  const std::string& place,
                                  const std::vector<double>& morph_weights, bool with_tangents,
                                  GltfTally&);

/// Index of the accessor, -1 where the primitive has no such attribute.
[[nodiscard]] int attribute(const tinygltf::Primitive&, const std::string& name);

/// Throws InputError where an attribute has not as many elements as there are positions.
void check_attribute_count(const GltfModel&, const std::string& place, const std::string& name,
                           size_t count, size_t expected);

}  // namespace petzval
