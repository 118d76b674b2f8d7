// SPDX-License-Identifier: Apache-2.0
// Motion of nodes while the shutter is open.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "io/gltf/animation/clip.h"

namespace petzval::io {

/// The nodes of a file as a tree, as they stand in the middle of the exposure.
struct NodeTree {
    std::span<const int> order;      ///< all of them, each after its parent
    std::span<const int> parent;     ///< of each node; -1: a root
    std::span<const M44d> to_world;  ///< likewise
};

/// Places and shapes of the nodes of a file at time steps that are spread evenly over the time that
/// the shutter is open: 129, fewer where that would take over a gigabyte.
class NodeMotion {
  public:
    /// Nothing moves.
    NodeMotion() = default;
    /// posed: the file's JSON, checked, as it is in the middle.
    NodeMotion(const nlohmann::json& posed, std::span<const GltfClip>, const AnimationChoice&,
               const NodeTree&);

    /// Places of a node in the world at the steps; nullptr for one that stands still.
    [[nodiscard]] const std::vector<M44d>* places(int node) const;
    /// Weights of the morph targets of the mesh that a node shows; nullptr where they stay.
    [[nodiscard]] const std::vector<std::vector<double>>* weights(int node) const;
    /// Values of a number of a camera, by its pointer in the JSON; nullptr where it stays.
    [[nodiscard]] const std::vector<double>* of_camera(const std::string& pointer) const;
    [[nodiscard]] size_t steps() const { return steps_; }
    /// Whether something may move between time steps that they do not show: keys lie closer
    /// together than they, or a node turns by more than half a turn, with those that it hangs on.
    [[nodiscard]] bool unseen() const { return unseen_; }

  private:
    class Player;
    void add_places(const Player&, const NodeTree&, std::span<const int> moving);
    void add_weights(const Player&);
    void add_cameras(const Player&);

    size_t steps_ = 0;
    bool unseen_ = false;
    std::map<int, std::vector<M44d>> places_;
    std::map<int, std::vector<std::vector<double>>> weights_;
    std::map<std::string, std::vector<double>> of_cameras_;
};

/// Kinds of properties that change while the shutter is open and are shown as they are in its
/// middle, in words as "materials". Nodes, morph weights and views of cameras are none of them.
[[nodiscard]] std::set<std::string> held_while_open(std::span<const GltfClip>,
                                                    const AnimationChoice&);

}  // namespace petzval::io
