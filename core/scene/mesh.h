// SPDX-License-Identifier: Apache-2.0
// Triangle meshes as arrays, and their placed copies (instances).
#pragma once

#include <array>
#include <utility>
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

/// Vertices of a mesh at a time step; arrays are as long as those of the mesh.
struct MeshStep {
    std::vector<V3f> positions, normals;
    std::vector<V4f> tangents;
};

/// One glTF primitive as indexed triangles. Optional arrays are empty or as long as `positions`.
struct Mesh {
    std::vector<V3f> positions;  ///< metres, in the mesh's own space
    std::vector<V3f> normals;    ///< unit; empty: flat shading
    std::vector<V4f> tangents;   ///< unit xyz, w = +-1: bitangent = w * cross(normal, tangent)
    std::array<std::vector<V2f>, 2> uv;              ///< TEXCOORD_0 and TEXCOORD_1
    std::vector<std::vector<V2f>> more_uv;           ///< those that few materials use: sets from 2
    std::vector<V4f> colours;                        ///< COLOR_0, linear RGBA
    std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front
    uint32_t material = 0;
    /// Shapes while the shutter is open (core/scene/motion.h), two at least; empty: it keeps its
    /// shape. The arrays above are as in the middle.
    std::vector<MeshStep> steps;
    /// Instance from which on each has two colours of its own: for vertices of even number, and of
    /// odd number. kByVertex: `colours` are those of the vertices.
    uint32_t colours_from = kByVertex;
    static constexpr uint32_t kByVertex = ~0u;

    /// Texture coordinates of a set of a TextureSlot; empty where there are none.
    [[nodiscard]] const std::vector<V2f>& uv_of(int uv_set) const {
        const auto set = static_cast<size_t>(uv_set);
        return set < uv.size() ? uv[set] : more_uv[set - uv.size()];
    }
    [[nodiscard]] std::vector<V2f>& uv_of(int uv_set) {
        return const_cast<std::vector<V2f>&>(std::as_const(*this).uv_of(uv_set));
    }
    /// Texture coordinates at a point of a triangle, b as in interpolate(); 0 where there are none.
    [[nodiscard]] V2f uv_at(uint32_t triangle, V2f b, int uv_set) const {
        const std::vector<V2f>& of_set = uv_of(uv_set);
        return of_set.empty() ? V2f(0.f) : interpolate(of_set, triangles[triangle], b);
    }
    /// Colour at a point of a triangle of an instance, where there are colours; b as above.
    [[nodiscard]] V4f colour_at(uint32_t instance, uint32_t triangle, V2f b) const {
        return interpolate(colours, colours_of(instance, triangle), b);
    }
    /// Alpha of that colour: exactly that of the corners where they agree, as it may be a cutoff.
    [[nodiscard]] float alpha_at(uint32_t instance, uint32_t triangle, V2f b) const {
        const auto [i, j, k] = colours_of(instance, triangle);
        const float alpha = colours[i].w;
        return alpha + (colours[j].w - alpha) * b.x + (colours[k].w - alpha) * b.y;
    }

  private:
    [[nodiscard]] std::array<uint32_t, 3> colours_of(uint32_t instance, uint32_t triangle) const {
        std::array<uint32_t, 3> corner = triangles[triangle];
        if (colours_from != kByVertex)
            for (uint32_t& c : corner) c = 2 * (instance - colours_from) + c % 2;
        return corner;
    }
};

/// A placed mesh. A mesh that stands once is stored in world space, with the identity here.
struct Instance {
    uint32_t mesh = 0;
    bool identity = true;
    bool flips = false;  ///< the matrix mirrors: front faces appear clockwise
    /// While the shutter is open the instance moves, or its mesh changes its shape; the matrices
    /// are as in the middle.
    bool moves = false;
    int32_t first_light = -1;  ///< light of triangle 0; -1: the instance does not emit
    M44f to_world;             ///< affine
    M33f to_local;             ///< linear part of its inverse
};
static_assert(sizeof(Instance) <= 112);  // there may be millions

}  // namespace petzval
