// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open. Time runs from 0, as it opens, to 1, as it has closed. What
// moves is known at time steps that are spread evenly from 0 to 1; between them vertices and
// matrices run in straight lines, as Embree has it.
#pragma once

#include <algorithm>
#include <array>

#include "core/math/ray.h"
#include "core/scene/scene.h"

namespace petzval {

/// Place of a time among `count` steps, at least two: the step before it, and the share of the way
/// to the next one.
struct StepPlace {
    size_t before;
    float share;
};
[[nodiscard]] inline StepPlace step_place(float time, size_t count) {
    const float at = std::clamp(time, 0.f, 1.f) * static_cast<float>(count - 1);
    const auto before = std::min(static_cast<size_t>(at), count - 2);
    return {before, at - static_cast<float>(before)};
}

/// Instance as it stands at a time, one that moves.
[[nodiscard]] Instance moved_instance(const Scene&, uint32_t instance, float time);

/// Whether an instance is mirrored at a time: one that moves may be turned inside out on its way.
[[nodiscard]] bool flips_at(const Scene&, uint32_t instance, float time);

/// Calls visit(instance) with an instance as it stands at a time; returns what that returns.
template <class Visit>
decltype(auto) with_instance_at(const Scene& scene, uint32_t instance, float time, Visit&& visit) {
    const Instance& still = scene.instances[instance];
    if (!still.moves) return visit(still);
    return visit(moved_instance(scene, instance, time));
}

/// Values at the corners of a triangle of a mesh at a time; of: positions or normals.
using CornerValues = std::array<V3f, 3>;
[[nodiscard]] CornerValues moved_corners(const Mesh&, const std::array<uint32_t, 3>& corner,
                                         std::vector<V3f> MeshStep::*of, float time);
[[nodiscard]] inline CornerValues corner_positions(const Mesh& mesh,
                                                   const std::array<uint32_t, 3>& corner,
                                                   float time) {
    const auto& p = mesh.positions;
    if (mesh.steps.empty()) return {p[corner[0]], p[corner[1]], p[corner[2]]};
    return moved_corners(mesh, corner, &MeshStep::positions, time);
}
[[nodiscard]] inline CornerValues corner_normals(const Mesh& mesh,
                                                 const std::array<uint32_t, 3>& corner,
                                                 float time) {
    const auto& n = mesh.normals;
    if (mesh.steps.empty()) return {n[corner[0]], n[corner[1]], n[corner[2]]};
    return moved_corners(mesh, corner, &MeshStep::normals, time);
}
/// Tangent at a point of a triangle at a time, of a mesh that has some; b as in interpolate().
[[nodiscard]] V4f tangent_at(const Mesh&, uint32_t triangle, V2f b, float time);

/// Whether a triangle is elsewhere at other times.
[[nodiscard]] inline bool is_moving(const Scene& scene, uint32_t instance) {
    const Instance& i = scene.instances[instance];
    return i.moves || !scene.meshes[i.mesh].steps.empty();
}
/// Number of steps at which an instance, or the shape of its mesh, is known; 1 where it is still.
[[nodiscard]] size_t step_count(const Scene&, uint32_t instance);

/// Time of one of `count` steps, at least two.
[[nodiscard]] inline float step_time(size_t step, size_t count) {
    return static_cast<float>(step) / static_cast<float>(count - 1);
}

/// A light as it is at a time; `moved` holds it where it moves.
[[nodiscard]] const Light& light_at(const Scene&, uint32_t light, float time, Light& moved);

/// Whether anything moves while the shutter is open.
[[nodiscard]] bool has_motion(const Scene&);

}  // namespace petzval
