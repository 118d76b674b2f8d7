// SPDX-License-Identifier: Apache-2.0
// Triangle meshes as arrays, and their placed copies (instances).
#pragma once

#include <array>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// Value at a point of a triangle; b: weights of the second and third corner.
template <class T>
[[nodiscard]] T interpolate(const std::vector<T>& values, const std::array<uint32_t, 3>& corner,
                            V2f b) {
    return values[corner[0]] * (1.f - b.x - b.y) + values[corner[1]] * b.x +
           values[corner[2]] * b.y;
}

/// One glTF primitive as indexed triangles. Optional arrays are empty or as long as `positions`.
struct Mesh {
    std::vector<V3f> positions;  ///< metres, in the mesh's own space
    std::vector<V3f> normals;    ///< unit; empty: flat shading
    std::vector<V4f> tangents;   ///< unit xyz, w = +-1: bitangent = w * cross(normal, tangent)
    std::array<std::vector<V2f>, 2> uv;              ///< TEXCOORD_0 and TEXCOORD_1
    std::vector<V4f> colours;                        ///< COLOR_0, linear RGBA
    std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front
    uint32_t material = 0;

    /// Texture coordinates at a point of a triangle, b as in interpolate(); 0 where there are none.
    [[nodiscard]] V2f uv_at(uint32_t triangle, V2f b, int uv_set) const {
        const std::vector<V2f>& of_set = uv[static_cast<size_t>(uv_set)];
        return of_set.empty() ? V2f(0.f) : interpolate(of_set, triangles[triangle], b);
    }
};

/// A placed mesh. A mesh that stands once is stored in world space, with the identity here.
struct Instance {
    uint32_t mesh = 0;
    bool identity = true;
    bool flips = false;        ///< the matrix mirrors: front faces appear clockwise
    M44f to_world;             ///< affine
    M44f to_local;             ///< its inverse
    int32_t first_light = -1;  ///< light of triangle 0; -1: the instance does not emit
};

}  // namespace petzval
