// SPDX-License-Identifier: Apache-2.0
// The node tree of a glTF file, flattened.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "io/gltf/instancing.h"
#include "io/gltf/model.h"

namespace petzval {

/// What a node holds, as indices; -1 for nothing.
struct GltfNode {
    int mesh = -1, skin = -1, camera = -1;
    std::vector<double> weights;  ///< of morph targets; empty: those of the mesh
    std::vector<int> children;
    bool visible = true;  ///< KHR_node_visibility, of the node itself
};

struct GltfNodes {
    std::vector<GltfNode> node;  ///< every node of the file
    std::vector<M44d> to_world;  ///< of every node of the file
    int scene = -1;              ///< the one that is shown; -1: the file has none
    std::vector<int> in_scene;   ///< visible nodes of it, depth first, in the file's order
    /// The same with the hidden ones: KHR_node_visibility hides no cameras.
    std::vector<int> all_in_scene;
    std::map<int, GltfInstancing> instancing;  ///< by node, where it shows its mesh many times
};

/// World matrices of all nodes, and the nodes of a scene: the one of that name or number, else the
/// default one; without one, of the first; without any, of all roots. Nodes are read from the JSON:
/// tinygltf would take a kilobyte for each. Throws ArgumentError where there is no such scene.
[[nodiscard]] GltfNodes flatten_nodes(const GltfModel&, const std::optional<std::string>& scene);

/// Rotation by a quaternion (x, y, z, w) of any length; none for the length 0. Rows are the images
/// of the axes.
[[nodiscard]] M44d rotation_matrix(const std::array<double, 4>&);

/// Determinant of the upper 3x3 part over the product of its rows' lengths: -1 to 1, 0 where the
/// matrix flattens space.
[[nodiscard]] double relative_determinant(const M44d&);
/// Whether a matrix flattens space.
[[nodiscard]] inline bool is_singular(const M44d& m) {
    return !(std::fabs(relative_determinant(m)) > 1e-14);  // a 0 that is rounded
}
/// Row of a matrix: the image of an axis (0 to 2), or of the origin (3).
[[nodiscard]] inline V3d row(const M44d& m, int axis) {
    return {m[axis][0], m[axis][1], m[axis][2]};
}

}  // namespace petzval
