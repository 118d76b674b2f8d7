// SPDX-License-Identifier: Apache-2.0
// One glTF primitive as a Mesh, in the mesh's own space.
#pragma once

#include <vector>

#include "io/gltf/document/model.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/meshes/source_mesh.h"

namespace tinygltf {
struct Primitive;
}

namespace petzval::io {

/// Kind of shapes that a primitive draws.
enum class Drawing : uint8_t { Nothing, Points, Lines, Triangles };

/// Kind of a primitive. Nothing is shown by those without positions, which are counted, and by
/// modes that glTF does not have.
[[nodiscard]] Drawing drawing_of(const tinygltf::Primitive&, GltfTally&);

/// Options of reading a primitive.
struct PrimitiveRequest {
    const std::vector<double>& morph_weights;
    bool with_tangents;                      ///< they serve normal maps
    const std::vector<uint64_t>& more_sets;  ///< numbers of the TEXCOORD_n for Mesh::more_uv
};

/// Reads attributes and triangles of a primitive that shows some, and applies the morph targets.
/// Directions are as the file has them, the material is left at 0.
[[nodiscard]] Mesh read_primitive(const GltfModel&, const tinygltf::Primitive&,
                                  const PrimitiveRequest&, GltfTally&);

/// Points or lines of a primitive: vertices without triangles, and the order in which they come.
struct StrokeSource {
    SourceMesh vertices;
    std::vector<uint32_t> order;
};
[[nodiscard]] StrokeSource read_stroke(const GltfModel&, const tinygltf::Primitive&,
                                       const std::vector<double>& morph_weights, GltfTally&);

/// Accessor index of an attribute; -1 where the primitive has none of that name.
[[nodiscard]] int attribute(const tinygltf::Primitive&, const std::string& name);

}  // namespace petzval::io
