// SPDX-License-Identifier: Apache-2.0
// Motion while the shutter is open. Time runs from 0, as it opens, to 1, as it has closed. Vertices
// and matrices are known at time steps that are spread evenly from 0 to 1; between them they run in
// straight lines, as Embree has it.
#pragma once

#include <array>
#include <optional>

#include "core/math/ray.h"
#include "core/math/steps.h"
#include "core/scene/scene.h"

namespace petzval {

/// Places of an instance at the steps; nullptr for one that stands still.
[[nodiscard]] inline const std::vector<M44f>* places_of(const Scene& scene, uint32_t instance) {
    if (instance >= scene.motion_of.size() || scene.motion_of[instance] < 0) return nullptr;
    return &scene.motions[static_cast<size_t>(scene.motion_of[instance])].to_world;
}
/// Instance as it stands at a time; places: those of one that moves.
[[nodiscard]] Instance moved_instance(const Instance&, const std::vector<M44f>& places, float time);

/// Calls visit(instance) with an instance as it stands at a time; returns what that returns.
template <class Visit>
decltype(auto) with_instance_at(const Scene& scene, uint32_t instance, float time, Visit&& visit) {
    const Instance& still = scene.instances[instance];
    const auto* const places = still.moves ? places_of(scene, instance) : nullptr;
    if (!places) return visit(still);
    return visit(moved_instance(still, *places, time));
}

/// Whether an instance is mirrored at a time: one that moves may be turned inside out on its way.
[[nodiscard]] inline bool flips_at(const Scene& scene, uint32_t instance, float time) {
    return with_instance_at(scene, instance, time, [](const Instance& i) { return i.flips; });
}

/// Values at the corners of a triangle of a mesh at a time; of: positions or normals.
using CornerValues = std::array<V3f, 3>;
[[nodiscard]] CornerValues moved_corners(const Mesh&, const std::array<uint32_t, 3>& corner,
                                         std::vector<V3f> MeshStep::*of, float time);
/// The same as pointers: into the mesh, or into `moved` where it changes its shape. kStill: it is
/// known not to, which saves the question.
using CornerPointers = std::array<const V3f*, 3>;
template <bool kStill = false>
[[nodiscard]] CornerPointers corners_at(const Mesh& mesh, const std::array<uint32_t, 3>& corner,
                                        const std::vector<V3f>& still,
                                        std::vector<V3f> MeshStep::*of, float time,
                                        CornerValues& moved) {
    if (kStill || mesh.steps.empty())
        return {&still[corner[0]], &still[corner[1]], &still[corner[2]]};
    moved = moved_corners(mesh, corner, of, time);
    return {&moved[0], &moved[1], &moved[2]};
}
template <bool kStill = false>
[[nodiscard]] CornerPointers corner_positions(const Mesh& mesh,
                                              const std::array<uint32_t, 3>& corner, float time,
                                              CornerValues& moved) {
    return corners_at<kStill>(mesh, corner, mesh.positions, &MeshStep::positions, time, moved);
}
template <bool kStill = false>
[[nodiscard]] CornerPointers corner_normals(const Mesh& mesh, const std::array<uint32_t, 3>& corner,
                                            float time, CornerValues& moved) {
    return corners_at<kStill>(mesh, corner, mesh.normals, &MeshStep::normals, time, moved);
}
/// Tangent at a point of a triangle at a time, of a mesh that has some; b as in interpolate().
[[nodiscard]] V4f moved_tangent(const Mesh&, uint32_t triangle, V2f b, float time);
[[nodiscard]] inline V4f tangent_at(const Mesh& mesh, uint32_t triangle, V2f b, float time) {
    if (!mesh.steps.empty()) [[unlikely]]
        return moved_tangent(mesh, triangle, b, time);
    return interpolate(mesh.tangents, mesh.triangles[triangle], b);
}

/// Point of a triangle at a time, in world space; b as in interpolate().
[[nodiscard]] inline V3f point_at(const Scene& scene, uint32_t instance, uint32_t triangle, V2f b,
                                  float time) {
    const auto corner = triangle_corners(scene, instance, triangle, time);
    return corner[0] * (1.f - b.x - b.y) + corner[1] * b.x + corner[2] * b.y;
}

/// Number of steps at which an instance, or the shape of its mesh, is known; 1 where it is still.
[[nodiscard]] size_t step_count(const Scene&, uint32_t instance);

/// A light at the steps; nullptr for one that stands still.
[[nodiscard]] inline const std::vector<Light>* steps_of_light(const Scene& scene, uint32_t light) {
    if (light >= scene.light_motion_of.size() || scene.light_motion_of[light] < 0) return nullptr;
    return &scene.light_motions[static_cast<size_t>(scene.light_motion_of[light])];
}
/// A light that moves, as it is at a time; steps: at least two.
[[nodiscard]] Light moved_light(const std::vector<Light>& steps, float time);
/// A light as it is at a time; `moved` holds it where it moves.
[[nodiscard]] inline const Light& light_at(const Scene& scene, uint32_t light, float time,
                                           std::optional<Light>& moved) {
    const auto* const steps = steps_of_light(scene, light);
    if (!steps) [[likely]]
        return scene.lights[light];
    return moved.emplace(moved_light(*steps, time));
}

/// Whether anything moves while the shutter is open.
[[nodiscard]] bool has_motion(const Scene&);

}  // namespace petzval
