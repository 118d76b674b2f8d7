// SPDX-License-Identifier: Apache-2.0
// The node tree of a glTF file, flattened.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "io/gltf/document/instancing.h"
#include "io/gltf/document/model.h"
#include "io/gltf/meshes/matrix.h"

namespace petzval::io {

/// A node: indices of its mesh, skin and so on; -1 for none.
struct GltfNode {
    int mesh = -1, skin = -1, camera = -1;
    std::vector<double> weights;  ///< of morph targets; empty: those of the mesh
    std::vector<int> children;
    bool visible = true;  ///< KHR_node_visibility, of the node itself
};

struct GltfNodes {
    std::vector<GltfNode> node;  ///< every node of the file
    std::vector<M44d> to_world;  ///< of every node of the file
    std::vector<int> parent;     ///< of every node of the file; -1: a root
    std::vector<int> order;      ///< every node of the file, each after its parent
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

}  // namespace petzval::io
