// SPDX-License-Identifier: Apache-2.0
// Nodes, scenes and skins: glTF 2.0, sections 3.5 and 3.7.3.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/base/json_parse.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"

namespace petzval::io {
namespace {

/// Greatest depth of the node tree, so that code may recurse. Deep rigs have about a hundred
/// levels.
constexpr int max_tree_depth = 1024;

/// Count of instances whose product with their bytes fits.
constexpr uint64_t kMostCounted = uint64_t(1) << 40;

class NodeCheck {
  public:
    explicit NodeCheck(GltfCheck& check)
        : check_(check),
          nodes_(check.root.objects("nodes")),
          meshes_(check.root.objects("meshes")),
          parent_(nodes_.size()),
          children_(nodes_.size()) {
        for (const JsonCursor& mesh : meshes_) targets_.push_back(morph_target_count(mesh.value()));
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
        (void)node.numbers("matrix", 16);
        check_properties(node, schema::kNodeRows);
        (void)node.index("camera", check_.count("cameras"), "camera");
        const auto mesh = node.index("mesh", meshes_.size(), "mesh");
        (void)node.index("skin", check_.count("skins"), "skin");
        if (mesh) (void)node.numbers("weights", targets_[*mesh]);
        if (const auto light = node.extension("KHR_lights_punctual"))
            (void)light->required_index("light", lights_, "light");
        if (const auto light = node.extension("EXT_lights_ies"))
            (void)light->required_index("light", profiles_, "light");
        if (const auto many = node.extension("EXT_mesh_gpu_instancing"))
            check_instancing(node, *many, mesh);
        (void)area_extras(node);
        link_children(index);
    }

    void check_instancing(const JsonCursor& node, const JsonCursor& many,
                          const std::optional<size_t>& mesh) {
        if (!mesh) check_.warn(many, "has no meaning on a node without a mesh");
        const auto attributes = many.find_object("attributes");
        std::optional<uint64_t> count;
        bool stored = false;
        for (const auto& [name, type] :
             {std::pair{"TRANSLATION", "VEC3"}, std::pair{"ROTATION", "VEC4"},
              std::pair{"SCALE", "VEC3"}}) {
            if (!attributes || !attributes->has(name)) continue;
            const GltfAccessor& accessor = check_.accessors[attributes->required_index(
                name, check_.accessors.size(), "accessor")];
            const std::string component = component_name(format_of(accessor));
            const bool turns = std::string_view(name) == "ROTATION";
            if (accessor.type != type ||
                (component != "float" &&
                 !(turns && (component == "int8n" || component == "int16n"))))
                attributes->fail(name, "is {} of {}, not {} of floats{}", printable(accessor.type),
                                 component, type, turns ? ", or of normalized int8 or int16" : "");
            if (count.value_or(accessor.count) != accessor.count)
                attributes->fail(name, "has {} elements, but another attribute has {}",
                                 accessor.count, *count);
            count = accessor.count;
            stored |= !accessor.bytes.empty();
        }
        if (!count) {
            check_.warn(many,
                        "has none of TRANSLATION, ROTATION and SCALE; the node is shown once");
            return;
        }
        // Those that are stored are as many as the file is long; the loader asks the machine.
        if (!stored) check_.budget.ask(std::min(*count, kMostCounted) * kInstanceBytes, node);
        warn_of_own(*attributes);
    }

    void warn_of_own(const JsonCursor& attributes) {
        for (const auto& [name, unused] : attributes.value().items())
            if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE")
                check_.warn(attributes,
                            printable(name) + " is an attribute of the file's own; it is ignored");
    }

    void link_children(size_t index) {
        children_[index] = nodes_[index].indices("children", nodes_.size(), "node");
        for (size_t child : children_[index]) {
            if (parent_[child])
                nodes_[index].fail("children", "node {} is a child of node {} already", child,
                                   *parent_[child]);
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
        (void)scene_extras(scene);
        for (size_t node : scene.indices("nodes", nodes_.size(), "node"))
            if (parent_[node])
                check_.source.warnings.add(
                    scene.path_of("nodes"),
                    "node {} is not a root, but a child of node {}; it is shown once", node,
                    *parent_[node]);
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
        skin.fail("inverseBindMatrices", "has {} matrices for {} joints", matrices.count, joints);
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

}  // namespace petzval::io
