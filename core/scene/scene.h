// SPDX-License-Identifier: Apache-2.0
// Scene: all that can be seen, as immutable arrays that name each other by index.
#pragma once

#include <algorithm>
#include <vector>

#include "core/math/ray.h"
#include "core/scene/light.h"
#include "core/scene/light_profile.h"
#include "core/scene/material.h"
#include "core/scene/mesh.h"
#include "core/scene/sky.h"
#include "core/scene/texture.h"
#include "core/spectrum/illuminant.h"
#include "core/spectrum/metal.h"

namespace petzval {

/// Places of an instance at time steps (core/scene/motion.h), two at least.
struct InstanceMotion {
    std::vector<M44f> to_world;
};

/// Scene in metres, y up, right-handed, as in glTF. io fills the arrays down to `sky`, then calls
/// finish_scene once; nothing changes afterwards.
struct Scene {
    std::vector<Image> images;
    std::vector<Material> materials;  ///< at least one where there is a mesh
    std::vector<Metal> metals;
    std::vector<MeasuredReflectance> reflectances;
    std::vector<Illuminant> illuminants;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<InstanceMotion> motions;
    std::vector<int32_t> motion_of;  ///< index into motions by instance; empty: nothing moves
    std::vector<LightProfile> profiles;
    std::vector<Light> lights;  ///< punctual lights of the file; finish_scene adds the others
    /// A light at time steps, two at least and all of its kind; and index into them by light, -1
    /// for one that is still. Lights beyond the list are still too.
    std::vector<std::vector<Light>> light_motions;
    std::vector<int32_t> light_motion_of;
    int32_t sky_light = -1;           ///< the sky's among them, by finish_scene; -1: even or black
    std::vector<uint32_t> sun_discs;  ///< suns with a disc among them, by finish_scene
    Sky sky;

    Box3f bounds;  ///< of all instances, in world space; empty where there are none
    /// Boxes about the bodies of all closed volumes, or one about them all. By rank_volumes, as is:
    std::vector<Box3f> volume_boxes;
    bool volumes_meet = false;  ///< some of them may overlap or touch

    /// Whether a point may lie in a closed volume, by the boxes.
    [[nodiscard]] bool may_be_in_volume(const V3f& p) const {
        return std::any_of(volume_boxes.begin(), volume_boxes.end(),
                           [&](const Box3f& box) { return box.intersects(p); });
    }
    /// Illuminant of an index; nullptr for -1, which means the scene's own white.
    [[nodiscard]] const Illuminant* illuminant(int32_t index) const {
        return index < 0 ? nullptr : &illuminants[static_cast<size_t>(index)];
    }
    /// Radiance of a source whose white is the illuminant of an index; -1: the scene's own white.
    [[nodiscard]] f4 uplift_radiance(Rgb c, const Bands& bands, int32_t white) const {
        if (white < 0) return petzval::uplift_radiance(c, bands);
        return petzval::uplift_radiance(c, bands, illuminant(white));
    }
};

/// Computes the bounds, ranks the volumes, marks the texture slots that share their place, and
/// appends a light for every triangle of an emissive instance and for the sky where it is not
/// black.
void finish_scene(Scene&);

/// Whether an instance lights the scene: its material emits, and is not one that only shows itself.
[[nodiscard]] bool emits(const Scene&, const Instance&);

/// Boxes about the triangles of each mesh, in its own space; empty where it is stored in the world.
[[nodiscard]] std::vector<Box3f> mesh_boxes(const Scene&);
/// Box that holds all that is moved by the matrix out of a box, rounding included.
[[nodiscard]] Box3f placed_box(const Box3f&, const M44f& to_world);

/// Position of a mesh in the world, as an instance places it.
[[nodiscard]] inline V3f placed(const Instance& instance, const V3f& position) {
    return instance.identity ? position : position * instance.to_world;
}
/// Corners of a triangle of an instance that moves, as triangle_corners() has them.
[[nodiscard]] std::array<V3f, 3> moved_triangle_corners(const Scene&, uint32_t instance,
                                                        uint32_t triangle, float time);
/// Three world-space corners of a triangle at a time.
[[nodiscard]] inline std::array<V3f, 3> triangle_corners(const Scene& scene, uint32_t instance,
                                                         uint32_t triangle,
                                                         float time = kMiddleOfShutter) {
    const Instance& still = scene.instances[instance];
    if (still.moves) [[unlikely]]
        return moved_triangle_corners(scene, instance, triangle, time);
    const Mesh& mesh = scene.meshes[still.mesh];
    const auto& corner = mesh.triangles[triangle];
    return {placed(still, mesh.positions[corner[0]]), placed(still, mesh.positions[corner[1]]),
            placed(still, mesh.positions[corner[2]])};
}
/// Area of a triangle of three corners.
[[nodiscard]] inline float triangle_area(const std::array<V3f, 3>& corner) {
    return 0.5f * (corner[1] - corner[0]).cross(corner[2] - corner[0]).length();
}

}  // namespace petzval
