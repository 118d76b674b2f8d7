// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_skin.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "io/error.h"
#include "io/gltf_arrays.h"
#include "io/gltf_bake.h"
#include "io/gltf_primitive.h"

namespace petzval {
namespace {

std::vector<M44d> joint_matrices(const GltfModel& gltf, const GltfNodes& nodes, int skin_index) {
    const tinygltf::Skin& skin = gltf.typed.skins.at(static_cast<size_t>(skin_index));
    std::vector<M44d> matrices(skin.joints.size());
    if (skin.inverseBindMatrices >= 0) {
        const auto inverse_bind = read_matrices(gltf, skin.inverseBindMatrices);
        if (inverse_bind.size() < matrices.size())
            throw InputError(gltf.file, json_path("skins", skin_index, "inverseBindMatrices"),
                             fmt::format("has {} matrices for {} joints", inverse_bind.size(),
                                         matrices.size()));
        std::copy_n(inverse_bind.begin(), matrices.size(), matrices.begin());
    }
    for (size_t i = 0; i < matrices.size(); ++i)
        matrices[i] = matrices[i] * nodes.to_world.at(static_cast<size_t>(skin.joints[i]));
    return matrices;
}

/// Four joints and their weights for every vertex.
struct Influences {
    std::vector<std::array<uint32_t, 4>> joints;
    std::vector<V4f> weights;
};

std::vector<Influences> read_influences(const GltfModel& gltf, const tinygltf::Primitive& primitive,
                                        const std::string& place, size_t vertex_count,
                                        size_t joint_count) {
    std::vector<Influences> sets;
    for (int set = 0;; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set);
        const std::string weights = fmt::format("WEIGHTS_{}", set);
        if (attribute(primitive, joints) < 0 || attribute(primitive, weights) < 0) return sets;
        sets.push_back({read_joints(gltf, attribute(primitive, joints)),
                        read_vec4(gltf, attribute(primitive, weights))});
        check_attribute_count(gltf, place, joints, sets.back().joints.size(), vertex_count);
        check_attribute_count(gltf, place, weights, sets.back().weights.size(), vertex_count);
        for (size_t v = 0; v < vertex_count; ++v)
            for (int k = 0; k < 4; ++k)
                if (sets.back().weights[v][k] != 0.f &&
                    sets.back().joints[v][static_cast<size_t>(k)] >= joint_count)
                    throw InputError(gltf.file, place + "/attributes/" + joints,
                                     fmt::format("vertex {} names a joint beyond the skin's {}", v,
                                                 joint_count));
    }
}

// Weights that do not add up to 1 are scaled; a vertex without any moves with the first joint.
M44d blend(const std::vector<Influences>& sets, const std::vector<M44d>& matrices, size_t vertex) {
    M44d sum(0.0);
    double total = 0;
    for (const Influences& set : sets)
        for (int k = 0; k < 4; ++k) {
            const double weight = set.weights[vertex][k];
            if (weight == 0) continue;
            sum += matrices[set.joints[vertex][static_cast<size_t>(k)]] * weight;
            total += weight;
        }
    return total > 0 ? sum * (1 / total) : matrices.front();
}

}  // namespace

bool pose_by_skin(const GltfModel& gltf, const GltfNodes& nodes, int skin,
                  const tinygltf::Primitive& primitive, const std::string& place, Mesh& mesh) {
    const std::vector<M44d> matrices = joint_matrices(gltf, nodes, skin);
    const auto sets = read_influences(gltf, primitive, place, mesh.positions.size(),
                                      matrices.size());
    if (sets.empty() || matrices.empty()) return false;
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        transform_vertex(mesh, v, blend(sets, matrices, v));
    return true;
}

}  // namespace petzval
