// SPDX-License-Identifier: Apache-2.0
// Places at which the meshes of a glTF scene stand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/gltf/animation/node_motion.h"
#include "io/gltf/document/instancing.h"
#include "io/gltf/document/model.h"
#include "io/gltf/document/nodes.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/validate/budget.h"

namespace petzval::io {

/// Memory that is taken for each of many places: it is asked for before it is.
class PlaceMemory {
  public:
    /// All that can be had. file: for messages; it must outlive this.
    explicit PlaceMemory(const std::string& file);
    /// Counts these bytes for each of `places` times `parts`, at each of so many time steps. Throws
    /// InputError where that is more than there is. where: a JSON path.
    void ask(double bytes, size_t places, size_t parts, const std::string& where, size_t steps = 1);

  private:
    const std::string& file_;
    double there_bytes_, asked_bytes_ = 0;
};

/// Nodes that show the same mesh in the same shape.
struct Placement {
    int mesh = -1, skin = -1;
    std::vector<double> morph_weights;
    std::vector<int> nodes;
    size_t places = 0;    ///< more than nodes where instancing repeats it
    bool moves = false;   ///< some of the nodes do, while the shutter is open
    bool morphs = false;  ///< its one node's weights change meanwhile
};

/// Places of the meshes of nodes, as the file has them.
class Places {
  public:
    Places(const GltfModel& gltf, const GltfNodes& nodes) : gltf_(gltf), nodes_(nodes) {}

    [[nodiscard]] const M44d& of_node(int node) const {
        return nodes_.to_world[static_cast<size_t>(node)];
    }
    /// Number of a node's places.
    [[nodiscard]] size_t count(int node);
    /// Calls visit(matrix) for each place of a node.
    template <class Visit>
    void each(int node, Visit visit) {
        each_with_own(node, [&](const M44d& to_world, const M44d&) { visit(to_world); });
    }
    /// Calls visit(matrix, own) likewise, with the place in the node's own space beside it.
    template <class Visit>
    void each_with_own(int node, Visit visit) {
        const InstancePlaces* const many = instances_of(node);
        if (!many) return visit(of_node(node), M44d());
        for (size_t i = 0; i < many->count(); ++i) {
            const M44d own = many->at(i);
            visit(own * of_node(node), own);
        }
    }
    /// Whether there is anything to see at a place.
    [[nodiscard]] static bool shows(const M44d& to_world);

  private:
    [[nodiscard]] const InstancePlaces* instances_of(int node);

    const GltfModel& gltf_;
    const GltfNodes& nodes_;
    int read_node_ = -1;
    std::optional<InstancePlaces> read_;  ///< of that node: its primitives ask one after the other
};

/// Matrix of a place of a node: that of the middle, or of another time where nothing shows then;
/// own: as each_with_own() has it.
[[nodiscard]] M44d shown_place(const NodeMotion&, int node, const M44d& to_world, const M44d& own);

/// Placements of all meshes of the scene, without places where nothing shows: those are counted.
/// Throws InputError where a node is out of the range of a float, and where its places would take
/// more memory than there is.
[[nodiscard]] std::vector<Placement> find_placements(const GltfModel&, const GltfNodes&,
                                                     const NodeMotion&, Places&, GltfTally&);

}  // namespace petzval::io
