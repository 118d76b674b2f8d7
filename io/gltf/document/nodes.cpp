// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/document/nodes.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/base/named.h"
#include "io/gltf/animation/node_place.h"

namespace petzval::io {
namespace {

int index_or_none(const JsonCursor& node, const char* key) {
    return node.has(key) ? static_cast<int>(node.integer(key)) : -1;
}

std::vector<double> numbers(const JsonCursor& node, const char* key) {
    return node.numbers(key, node.length(key));
}

bool is_visible(const JsonCursor& node) {
    const auto extension = node.extension("KHR_node_visibility");
    return !extension || extension->value().value("visible", true);
}

GltfNode read_node(const JsonCursor& node_json) {
    GltfNode node{.mesh = index_or_none(node_json, "mesh"),
                  .skin = index_or_none(node_json, "skin"),
                  .camera = index_or_none(node_json, "camera"),
                  .weights = numbers(node_json, "weights"),
                  .children = {},
                  .visible = is_visible(node_json)};
    for (const double child : numbers(node_json, "children"))
        node.children.push_back(static_cast<int>(child));
    return node;
}

std::vector<int> all_roots(const std::vector<GltfNode>& nodes) {
    std::vector<bool> is_child(nodes.size(), false);
    for (const GltfNode& node : nodes)
        for (int child : node.children) is_child.at(static_cast<size_t>(child)) = true;
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

// Visits nodes depth first with a stack of its own: a file may nest its nodes deeper than the
// program's stack goes.
template <class Visit>
void depth_first(const std::vector<GltfNode>& nodes, const std::vector<int>& roots, Visit&& visit) {
    std::vector<int> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        const GltfNode& node = nodes.at(static_cast<size_t>(index));
        visit(index, node);
        stack.insert(stack.end(), node.children.rbegin(), node.children.rend());
    }
}

int find_scene(const GltfModel& gltf, const std::string& wanted) {
    std::vector<std::string> names;
    for (const auto& scene : gltf.typed.scenes) names.push_back(scene.name);
    const auto number = find_named(wanted, names);
    if (!number)
        throw ArgumentError(
            gltf.file, "", no_such("scene", wanted, names, "the file has none, leave out ⟨scene⟩"));
    return static_cast<int>(*number);
}

}  // namespace

GltfNodes flatten_nodes(const GltfModel& gltf, const std::optional<std::string>& scene) {
    const tinygltf::Model& model = gltf.typed;
    const JsonCursor root(gltf.source.json, gltf.file);
    GltfNodes nodes;
    nodes.node.reserve(root.length("nodes"));
    nodes.to_world.reserve(root.length("nodes"));
    for (const JsonCursor& json : root.objects("nodes")) {
        nodes.node.push_back(read_node(json));
        nodes.to_world.push_back(stored_matrix(json.value()));
        if (const auto many = read_instancing(json))
            nodes.instancing.emplace(static_cast<int>(nodes.node.size()) - 1, *many);
    }
    nodes.parent.assign(nodes.node.size(), -1);
    // Skins may name joints anywhere in the file, so every node gets its place.
    const std::vector<int> roots = all_roots(nodes.node);
    depth_first(nodes.node, roots, [&](int index, const GltfNode& node) {
        const M44d& parent = nodes.to_world[static_cast<size_t>(index)];
        nodes.order.push_back(index);
        for (int child : node.children) {
            M44d& matrix = nodes.to_world[static_cast<size_t>(child)];
            matrix = matrix * parent;
            nodes.parent[static_cast<size_t>(child)] = index;
        }
    });

    const std::vector<int>* drawn = &roots;
    if (scene)
        nodes.scene = find_scene(gltf, *scene);
    else if (!model.scenes.empty())
        nodes.scene = std::max(model.defaultScene, 0);
    if (nodes.scene >= 0) drawn = &model.scenes.at(static_cast<size_t>(nodes.scene)).nodes;
    std::vector<bool> seen(nodes.node.size(), false);  // a scene may list a child beside its root
    std::vector<bool> hidden(nodes.node.size(), false);
    depth_first(nodes.node, roots, [&](int index, const GltfNode& node) {
        const bool hides = hidden[static_cast<size_t>(index)] || !node.visible;
        hidden[static_cast<size_t>(index)] = hides;
        for (int child : node.children) hidden[static_cast<size_t>(child)] = hides;
    });
    depth_first(nodes.node, *drawn, [&](int index, const GltfNode&) {
        if (!seen[static_cast<size_t>(index)]) {
            nodes.all_in_scene.push_back(index);
            if (!hidden[static_cast<size_t>(index)]) nodes.in_scene.push_back(index);
        }
        seen[static_cast<size_t>(index)] = true;
    });
    return nodes;
}

}  // namespace petzval::io
