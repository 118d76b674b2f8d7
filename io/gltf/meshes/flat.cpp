// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/flat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/gltf/meshes/matrix.h"

namespace petzval::io {
namespace {

/// Thickness of a sheet: a share of its size, which does not show and leaves a camera some
/// thousand sizes away; and one of where it lies, some times what the rounding of a hit is
/// (core/shading/surface.cpp).
constexpr double kOfSize = 1e-4, kOfPlace = 4e-6;
constexpr double kParallel = 1e-7;  ///< sine between rows that rounding made

std::array<V3d, 3> cofactors(const M44d& m) {
    const V3d x = row(m, 0), y = row(m, 1), z = row(m, 2);
    return {y.cross(z), z.cross(x), x.cross(y)};
}

}  // namespace

int dimensions_left(const M44d& m) {
    if (!is_singular(m)) return 3;
    for (int i = 0; i < 3; ++i) {
        const V3d a = row(m, i), b = row(m, (i + 1) % 3);
        if (a.cross(b).length() > kParallel * a.length() * b.length()) return 2;
    }
    return 1;
}

// The cofactors of a matrix of rank 2 are k times n: n is the normal of the plane onto which it
// flattens, k the direction that it loses. Adding k times n makes the determinant |k|^2 > 0.
M44d thickened(const M44d& flat, const Box3f& of_mesh) {
    const std::array<V3d, 3> cofactor = cofactors(flat);
    const V3d n =
        std::max_element(cofactor.begin(), cofactor.end(), [](const V3d& a, const V3d& b) {
            return a.length2() < b.length2();
        })->normalized();
    const V3d lost = V3d(cofactor[0].dot(n), cofactor[1].dot(n), cofactor[2].dot(n)).normalized();
    const V3d size(of_mesh.max - of_mesh.min);
    const V3d middle = V3d(of_mesh.min) / 2 + V3d(of_mesh.max) / 2;
    double depth = 0, scale = 0, farthest = row(flat, 3).length();
    V3d spread(0.0);
    for (int i = 0; i < 3; ++i) {
        depth += std::fabs(lost[i]) * size[i];
        scale = std::max(scale, row(flat, i).length());
        for (int j = 0; j < 3; ++j) spread[j] += std::fabs(flat[i][j]) * size[i];
        farthest += row(flat, i).length() *
                    double{std::max(std::fabs(of_mesh.min[i]), std::fabs(of_mesh.max[i]))};
    }
    const double thickness = kOfSize * spread.length() + kOfPlace * farthest;
    // A mesh that is flat itself has no depth: any factor keeps it where it is.
    const double factor = std::clamp(thickness / std::max(depth, 1e-300), 1e-9 * scale, scale);
    M44d out = flat;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out[i][j] += factor * lost[i] * n[j];
    const double shift = factor * lost.dot(middle);
    for (int j = 0; j < 3; ++j) out[3][j] -= shift * n[j];
    return out;
}

}  // namespace petzval::io
