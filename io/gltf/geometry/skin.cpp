// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/geometry/skin.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

#include "io/gltf/document/arrays.h"
#include "io/gltf/geometry/primitive.h"
#include "io/gltf/meshes/bake.h"

namespace petzval::io {
namespace {

/// Four joints and their weights for every vertex.
struct Influences {
    std::vector<std::array<uint32_t, 4>> joints;
    std::vector<V4f> weights;
};

std::vector<Influences> read_influences(const GltfModel& gltf,
                                        const tinygltf::Primitive& primitive) {
    std::vector<Influences> sets;
    for (int set = 0;; ++set) {
        const int joints = attribute(primitive, fmt::format("JOINTS_{}", set));
        const int weights = attribute(primitive, fmt::format("WEIGHTS_{}", set));
        if (joints < 0 || weights < 0) return sets;
        sets.push_back({read_joints(gltf, joints), read_vec4(gltf, weights)});
    }
}

// Weighted mean of the joint matrices. Weights that do not add up to 1 are scaled; a vertex without
// any moves with the first joint.
M44d blend(const std::vector<Influences>& sets, const std::vector<M44d>& matrices, size_t vertex) {
    M44d sum(0.0);
    double total = 0;
    for (const Influences& set : sets)
        for (int k = 0; k < 4; ++k) {
            const double weight = set.weights[vertex][k];
            if (!(std::fabs(weight) > 0)) continue;  // not a number: none
            sum += matrices[set.joints[vertex][static_cast<size_t>(k)]] * weight;
            total += weight;
        }
    return total > 0 ? sum * (1 / total) : matrices.front();
}

}  // namespace

std::vector<M44d> joint_matrices(const GltfModel& gltf, int skin_index,
                                 const std::function<M44d(int)>& place_of) {
    const tinygltf::Skin& skin = gltf.typed.skins.at(static_cast<size_t>(skin_index));
    std::vector<M44d> matrices(skin.joints.size());
    if (skin.inverseBindMatrices >= 0) {
        const auto inverse_bind = read_matrices(gltf, skin.inverseBindMatrices);
        std::copy_n(inverse_bind.begin(), matrices.size(), matrices.begin());
    }
    for (size_t i = 0; i < matrices.size(); ++i)
        matrices[i] = matrices[i] * place_of(skin.joints[i]);
    return matrices;
}

bool has_joints(const tinygltf::Primitive& primitive) {
    return attribute(primitive, "JOINTS_0") >= 0 && attribute(primitive, "WEIGHTS_0") >= 0;
}

bool pose_by_skin(const GltfModel& gltf, const std::vector<M44d>& matrices,
                  const tinygltf::Primitive& primitive, SourceMesh& source) {
    if (!has_joints(primitive)) return false;
    const auto sets = read_influences(gltf, primitive);
    Mesh& mesh = source.mesh;
    std::vector<bool> mirrored(mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const VertexTransform transform(blend(sets, matrices, source.in_file(v)));
        transform.apply(mesh, v);
        mirrored[v] = transform.mirrors();
    }
    const auto is_mirrored = [&](const std::array<uint32_t, 3>& t) {
        return mirrored[t[0]] && mirrored[t[1]] && mirrored[t[2]];
    };
    if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_mirrored)) turn_over(mesh);
    return true;
}

}  // namespace petzval::io
