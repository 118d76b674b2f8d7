// SPDX-License-Identifier: Apache-2.0
// Skinned meshes in the pose that the file's nodes stand in.
#pragma once

#include <functional>
#include <vector>

#include "io/gltf/document/model.h"
#include "io/gltf/meshes/source_mesh.h"

namespace tinygltf {
struct Primitive;
}

namespace petzval::io {

/// For each joint of a skin its inverse bind matrix * the joint's place, which place_of(node)
/// tells.
[[nodiscard]] std::vector<M44d> joint_matrices(const GltfModel&, int skin,
                                               const std::function<M44d(int)>& place_of);

/// Whether a primitive names joints and weights.
[[nodiscard]] bool has_joints(const tinygltf::Primitive&);

/// Moves a primitive's vertices to world space by its joints, each vertex by the weighted sum of
/// inverse bind matrix * joint's place (glTF 2.0, section 3.7.3.3; the place of the node that holds
/// the mesh does not count). A mesh that is mirrored as a whole is turned over. Returns false, and
/// changes nothing, where the primitive names no joints.
[[nodiscard]] bool pose_by_skin(const GltfModel&, const std::vector<M44d>& joint_matrices,
                                const tinygltf::Primitive&, SourceMesh&);

}  // namespace petzval::io
