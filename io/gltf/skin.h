// SPDX-License-Identifier: Apache-2.0
// Skinned meshes in the pose that the file's nodes stand in.
#pragma once

#include "core/scene/mesh.h"
#include "io/gltf/model.h"
#include "io/gltf/nodes.h"

namespace tinygltf {
struct Primitive;
}

namespace petzval {

/// Moves a primitive's vertices to world space by its joints, each vertex by the weighted sum of
/// inverse bind matrix * joint's place (glTF 2.0, section 3.7.3.3; the place of the node that holds
/// the mesh does not count). Returns false, and changes nothing, where the primitive names no
/// joints.
[[nodiscard]] bool pose_by_skin(const GltfModel&, const GltfNodes&, int skin,
                                const tinygltf::Primitive&, Mesh&);

}  // namespace petzval
