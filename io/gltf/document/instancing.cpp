// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/document/instancing.h"

#include <tiny_gltf.h>

#include "io/gltf/document/arrays.h"
#include "io/gltf/document/nodes.h"

namespace petzval::io {

std::optional<GltfInstancing> read_instancing(const JsonCursor& node) {
    const auto extension = node.extension(kInstancing);
    const auto attributes = extension ? extension->find_object("attributes") : std::nullopt;
    if (!attributes) return std::nullopt;
    const auto accessor = [&](const char* name) {
        return attributes->has(name) ? static_cast<int>(attributes->integer(name)) : -1;
    };
    const GltfInstancing found{accessor("TRANSLATION"), accessor("ROTATION"), accessor("SCALE")};
    return found.any() < 0 ? std::nullopt : std::optional(found);
}

InstancePlaces::InstancePlaces(const GltfModel& gltf, const GltfInstancing& from)
    : count_(accessor_of(gltf, from.any()).count) {
    if (from.translation >= 0) translation_ = read_vec3(gltf, from.translation);
    if (from.rotation >= 0) rotation_ = read_vec4(gltf, from.rotation);
    if (from.scale >= 0) scale_ = read_vec3(gltf, from.scale);
}

M44d InstancePlaces::at(size_t i) const {
    M44d matrix;
    if (!scale_.empty()) matrix.setScale(V3d(scale_[i]));
    if (!rotation_.empty()) {
        const V4f& q = rotation_[i];
        matrix = matrix * rotation_matrix({q.x, q.y, q.z, q.w});
    }
    if (!translation_.empty())
        for (int axis = 0; axis < 3; ++axis) matrix[3][axis] = double{translation_[i][axis]};
    return matrix;
}

}  // namespace petzval::io
