// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/bake.h"

#include <utility>

#include "io/gltf/meshes/matrix.h"

namespace petzval::io {
namespace {

V3d transform_direction(const M44d& m, const V3d& v) {
    return row(m, 0) * v.x + row(m, 1) * v.y + row(m, 2) * v.z;
}

V3f unit_or_same(const V3d& moved, const V3f& before) {
    const double length = std::sqrt(moved.dot(moved));
    return length > 0 ? V3f(moved / length) : before;
}

// The rows of the inverse transpose are the cofactors over the determinant; only its sign matters
// for directions that are scaled to unit length.
M44d inverse_transpose(const M44d& m, double sign) {
    const V3d x = row(m, 0), y = row(m, 1), z = row(m, 2);
    const V3d a = y.cross(z) * sign, b = z.cross(x) * sign, c = x.cross(y) * sign;
    return {a.x, a.y, a.z, 0, b.x, b.y, b.z, 0, c.x, c.y, c.z, 0, 0, 0, 0, 1};
}

}  // namespace

VertexTransform::VertexTransform(const M44d& to_world)
    : matrix_(to_world), mirrors_(relative_determinant(to_world) < 0) {
    normal_matrix_ = inverse_transpose(matrix_, mirrors_ ? -1 : 1);
}

void VertexTransform::apply(Mesh& mesh, size_t i) const {
    V3f& position = mesh.positions[i];
    position = V3f(transform_direction(matrix_, V3d(position)) + row(matrix_, 3));
    if (!mesh.normals.empty()) {
        V3f& normal = mesh.normals[i];
        normal = unit_or_same(transform_direction(normal_matrix_, V3d(normal)), normal);
    }
    if (!mesh.tangents.empty()) {
        V4f& tangent = mesh.tangents[i];
        const V3f before(tangent.x, tangent.y, tangent.z);
        const V3f after = unit_or_same(transform_direction(matrix_, V3d(before)), before);
        tangent = {after.x, after.y, after.z, mirrors_ ? -tangent.w : tangent.w};
    }
}

void turn_over(Mesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void bake(Mesh& mesh, const M44d& to_world) {
    if (to_world == M44d()) return;
    const VertexTransform transform(to_world);
    for (size_t i = 0; i < mesh.positions.size(); ++i) transform.apply(mesh, i);
    if (transform.mirrors()) turn_over(mesh);
}

}  // namespace petzval::io
