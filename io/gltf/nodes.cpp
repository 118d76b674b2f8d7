// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/nodes.h"

#include <tiny_gltf.h>

namespace petzval {
namespace {

// Rotation by a unit quaternion (x, y, z, w); rows are the images of the axes.
M44d rotation_matrix(const std::vector<double>& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (norm == 0) return {};
    const double x = q[0] / norm, y = q[1] / norm, z = q[2] / norm, w = q[3] / norm;
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + w * z),
            2 * (x * z - w * y),
            0,
            2 * (x * y - w * z),
            1 - 2 * (x * x + z * z),
            2 * (y * z + w * x),
            0,
            2 * (x * z + w * y),
            2 * (y * z - w * x),
            1 - 2 * (x * x + y * y),
            0,
            0,
            0,
            0,
            1};
}

std::vector<int> all_roots(const tinygltf::Model& model) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (int child : node.children) is_child.at(static_cast<size_t>(child)) = true;
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

// Visits nodes depth first with a stack of its own: a file may nest its nodes deeper than the
// program's stack goes.
template <class Visit>
void depth_first(const tinygltf::Model& model, const std::vector<int>& roots, Visit&& visit) {
    std::vector<int> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const int index = stack.back();
        stack.pop_back();
        const tinygltf::Node& node = model.nodes.at(static_cast<size_t>(index));
        visit(index, node);
        stack.insert(stack.end(), node.children.rbegin(), node.children.rend());
    }
}

}  // namespace

M44d node_matrix(const tinygltf::Node& node) {
    if (const auto& m = node.matrix; m.size() == 16)
        return {m[0], m[1], m[2],  m[3],  m[4],  m[5],  m[6],  m[7],
                m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]};
    M44d matrix;
    if (const auto& s = node.scale; s.size() == 3) matrix.setScale(V3d(s[0], s[1], s[2]));
    if (node.rotation.size() == 4) matrix = matrix * rotation_matrix(node.rotation);
    if (const auto& t = node.translation; t.size() == 3)
        for (int axis = 0; axis < 3; ++axis) matrix[3][axis] = t[static_cast<size_t>(axis)];
    return matrix;
}

GltfNodes flatten_nodes(const GltfModel& gltf) {
    const tinygltf::Model& model = gltf.typed;
    GltfNodes nodes;
    nodes.to_world.resize(model.nodes.size());
    for (size_t i = 0; i < model.nodes.size(); ++i) nodes.to_world[i] = node_matrix(model.nodes[i]);
    // Skins may name joints anywhere in the file, so every node gets its place.
    const std::vector<int> roots = all_roots(model);
    depth_first(model, roots, [&](int index, const tinygltf::Node& node) {
        const M44d& parent = nodes.to_world[static_cast<size_t>(index)];
        for (int child : node.children) {
            M44d& matrix = nodes.to_world[static_cast<size_t>(child)];
            matrix = matrix * parent;
        }
    });

    const std::vector<int>* drawn = &roots;
    if (!model.scenes.empty())
        drawn = &model.scenes.at(static_cast<size_t>(std::max(model.defaultScene, 0))).nodes;
    std::vector<bool> seen(model.nodes.size(), false);  // a scene may list a child beside its root
    depth_first(model, *drawn, [&](int index, const tinygltf::Node&) {
        if (!seen[static_cast<size_t>(index)]) nodes.in_scene.push_back(index);
        seen[static_cast<size_t>(index)] = true;
    });
    return nodes;
}

double relative_determinant(const M44d& m) {
    const V3d x = row(m, 0), y = row(m, 1), z = row(m, 2);
    const double lengths = x.length() * y.length() * z.length();
    return lengths > 0 ? x.cross(y).dot(z) / lengths : 0;
}

}  // namespace petzval
