// SPDX-License-Identifier: Apache-2.0
// Points and lines of a glTF file, drawn as small spheres and cylinders.
#pragma once

#include <map>
#include <vector>

#include "core/scene/scene.h"
#include "io/gltf/geometry/primitive.h"
#include "io/gltf/materials/materials.h"

namespace petzval::io {

/// Shapes of points and lines: vertices as spheres, pairs of them as cylinders between spheres.
struct StrokeShapes {
    std::vector<uint32_t> spheres;
    std::vector<std::array<uint32_t, 2>> cylinders;
};

/// Points: each vertex once. Drops what is not finite and returns how much through `broken`.
[[nodiscard]] StrokeShapes shapes_of(const StrokeSource&, int gltf_mode, uint64_t& broken);

/// Gathers spheres and cylinders of a radius. All of a material are instances of one sphere and one
/// cylinder: an instance takes far less than its own triangles would.
class Strokes {
  public:
    explicit Strokes(float radius_m) : radius_m_(radius_m) {}

    /// Adds the shapes between vertices that are moved by the matrix.
    void add(uint32_t material, const Mesh& vertices, const StrokeShapes&, const M44d& to_world);
    /// Moves all into the scene, with that material's sets of texture coordinates, all 0.
    void finish(Scene&, const GltfMaterials&);

  private:
    struct Group {
        std::vector<Instance> instances;
        std::vector<V4f> colours;  ///< two for each; empty as long as none has any
    };
    void add(Group&, const M44d& to_world, const Mesh& vertices, uint32_t from, uint32_t to) const;

    float radius_m_;
    std::map<uint32_t, std::array<Group, 2>> by_material_;  ///< spheres and cylinders
};

}  // namespace petzval::io
