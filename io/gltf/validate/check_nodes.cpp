// SPDX-License-Identifier: Apache-2.0
// Nodes, scenes and skins: glTF 2.0, sections 3.5 and 3.7.3.
#include <fmt/format.h>

#include <algorithm>

#include "io/gltf/validate/check.h"

namespace petzval {
namespace {

/// Greatest depth of the node tree, so that code may recurse. Deep rigs have about a hundred
/// levels.
constexpr int max_tree_depth = 1024;

void check_transform(const JsonCursor& node) {
    (void)node.numbers("matrix", 16);
    (void)node.numbers("translation", 3);
    (void)node.numbers("scale", 3);
    (void)node.numbers("rotation", 4);
}

size_t target_count(const std::vector<JsonCursor>& meshes, size_t mesh) {
    size_t most = 0;
    for (const JsonCursor& primitive : meshes[mesh].objects("primitives"))
        most = std::max(most, primitive.length("targets"));
    return most;
}

class NodeCheck {
  public:
    explicit NodeCheck(GltfCheck& check)
        : check_(check),
          nodes_(check.root.objects("nodes")),
          meshes_(check.root.objects("meshes")),
          parent_(nodes_.size()),
          children_(nodes_.size()) {
        for (size_t m = 0; m < meshes_.size(); ++m) targets_.push_back(target_count(meshes_, m));
        if (const auto lights = check.root.extension("KHR_lights_punctual"))
            lights_ = lights->length("lights");
        if (const auto lights = check.root.extension("EXT_lights_ies"))
            profiles_ = lights->length("lights");
    }

    void run() {
        for (size_t n = 0; n < nodes_.size(); ++n) check_node(n);
        check_forest();
        for (const JsonCursor& scene : check_.root.objects("scenes")) check_scene(scene);
        (void)check_.root.index("scene", check_.count("scenes"), "scene");
    }

  private:
    void check_node(size_t index) {
        const JsonCursor& node = nodes_[index];
        check_transform(node);
        (void)node.index("camera", check_.count("cameras"), "camera");
        const auto mesh = node.index("mesh", meshes_.size(), "mesh");
        (void)node.index("skin", check_.count("skins"), "skin");
        if (mesh) (void)node.numbers("weights", targets_[*mesh]);
        if (const auto light = node.extension("KHR_lights_punctual"))
            (void)light->required_index("light", lights_, "light");
        if (const auto light = node.extension("EXT_lights_ies")) check_profile_light(*light);
        link_children(index);
    }

    void check_profile_light(const JsonCursor& light) {
        constexpr Range not_negative = {0, std::numeric_limits<float>::max()};
        (void)light.required_index("light", profiles_, "light");
        (void)light.number_or("multiplier", 1, not_negative);
        (void)light.numbers("color", 3, not_negative);
    }

    void link_children(size_t index) {
        children_[index] = nodes_[index].indices("children", nodes_.size(), "node");
        for (size_t child : children_[index]) {
            if (parent_[child])
                nodes_[index].fail("children", fmt::format("node {} is a child of node {} already",
                                                           child, *parent_[child]));
            parent_[child] = index;
        }
    }

    /// Checks depth and that nodes form trees: with at most one parent each, nodes that no root
    /// leads to go round in a circle.
    void check_forest() const {
        std::vector<int> depth(nodes_.size(), 0);  // 0: not reached
        std::vector<size_t> open;
        for (size_t n = 0; n < nodes_.size(); ++n) {
            if (parent_[n]) continue;
            depth[n] = 1;
            open.push_back(n);
        }
        while (!open.empty()) {
            const size_t node = open.back();
            open.pop_back();
            if (depth[node] > max_tree_depth)
                nodes_[node].fail(fmt::format("lies more than {} nodes deep", max_tree_depth));
            for (size_t child : children_[node]) {
                depth[child] = depth[node] + 1;
                open.push_back(child);
            }
        }
        for (size_t n = 0; n < nodes_.size(); ++n)
            if (depth[n] == 0) nodes_[n].fail("is its own ancestor; the node tree has a cycle");
    }

    void check_scene(const JsonCursor& scene) const {
        for (size_t node : scene.indices("nodes", nodes_.size(), "node"))
            if (parent_[node])
                check_.source.warnings.push_back(
                    fmt::format("{}/nodes: node {} is not a root, but a child of node {}; it is "
                                "shown once",
                                scene.path(), node, *parent_[node]));
    }

    GltfCheck& check_;
    const std::vector<JsonCursor> nodes_, meshes_;
    std::vector<std::optional<size_t>> parent_;
    std::vector<std::vector<size_t>> children_;
    std::vector<size_t> targets_;  ///< morph targets of each mesh
    size_t lights_ = 0, profiles_ = 0;
};

void check_inverse_bind_matrices(const GltfCheck& check, const JsonCursor& skin, size_t joints) {
    const auto index = skin.index("inverseBindMatrices", check.accessors.size(), "accessor");
    if (!index) return;
    const GltfAccessor& matrices = check.accessors[*index];
    if (matrices.type != "MAT4" || matrices.component_type != 5126)
        skin.fail("inverseBindMatrices", "must be MAT4 of floats");
    if (matrices.count < joints)
        skin.fail("inverseBindMatrices",
                  fmt::format("has {} matrices for {} joints", matrices.count, joints));
}

}  // namespace

void check_skins(const GltfCheck& check) {
    const size_t nodes = check.count("nodes");
    for (const JsonCursor& skin : check.root.objects("skins")) {
        skin.require("joints");
        const size_t joints = skin.indices("joints", nodes, "node").size();
        if (joints == 0) skin.fail("joints", "must name at least one node");
        (void)skin.index("skeleton", nodes, "node");
        check_inverse_bind_matrices(check, skin, joints);
    }
}

void check_nodes(GltfCheck& check) {
    NodeCheck(check).run();
}

}  // namespace petzval
