// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/triangles.h"

#include <cstring>

namespace petzval::io {
namespace {

bool has_area(const Mesh& mesh, const std::array<uint32_t, 3>& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const V3d normal = (b - a).cross(c - a);
    return normal.dot(normal) >= std::numeric_limits<float>::min();
}

}  // namespace

std::vector<std::array<uint32_t, 3>> to_triangles(TriangleMode mode,
                                                  const std::vector<uint32_t>& index) {
    std::vector<std::array<uint32_t, 3>> triangles;
    if (mode == TriangleMode::List) {
        triangles.resize(index.size() / 3);
        if (!triangles.empty())
            std::memcpy(triangles.data(), index.data(), triangles.size() * sizeof triangles[0]);
        return triangles;
    }
    if (index.size() < 3) return triangles;
    triangles.resize(index.size() - 2);
    for (size_t i = 0; i < triangles.size(); ++i) {
        if (mode == TriangleMode::Fan)
            triangles[i] = {index[i + 1], index[i + 2], index[0]};
        else
            triangles[i] = {index[i], index[i + 1 + i % 2], index[i + 2 - i % 2]};
    }
    return triangles;
}

size_t remove_zero_area(Mesh& mesh) {
    return std::erase_if(mesh.triangles, [&](const auto& t) { return !has_area(mesh, t); });
}

}  // namespace petzval::io
