// SPDX-License-Identifier: Apache-2.0
// Scenes that move while the shutter is open, and where their corners are by another way.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace petzval::test {

/// Turned by Euler angles, stretched, and moved to a place.
[[nodiscard]] inline M44f turned(const V3f& angles, const V3f& at, const V3f& scale = V3f(1.f)) {
    M44f m, stretch;
    m.setEulerAngles(angles);
    stretch.setScale(scale);
    m = stretch * m;
    for (int k = 0; k < 3; ++k) m[3][k] = at[k];
    return m;
}

/// Values of a function of time at evenly spread steps, the first at 0 and the last at 1.
template <class Function>
[[nodiscard]] auto at_steps(size_t count, Function of_time) {
    std::vector<decltype(of_time(0.f))> out;
    for (size_t i = 0; i < count; ++i)
        out.push_back(of_time(static_cast<float>(i) / static_cast<float>(count - 1)));
    return out;
}

/// Makes an instance of a mesh that is in the scene move; its place in the middle is that of the
/// middle step, or the mean of the two middle ones.
inline void place_moving(Scene& scene, uint32_t mesh, std::vector<M44f> steps) {
    const M44f &a = steps[(steps.size() - 1) / 2], &b = steps[steps.size() / 2];
    Instance instance;
    instance.mesh = mesh;
    instance.identity = false;
    instance.moves = true;
    instance.to_world = (a + b) * 0.5f;
    instance.to_local = linear_part(instance.to_world.inverse());
    instance.flips = instance.to_world.determinant() < 0;
    scene.motion_of.resize(scene.instances.size() + 1, -1);
    scene.motion_of.back() = static_cast<int32_t>(scene.motions.size());
    scene.motions.push_back({std::move(steps)});
    scene.instances.push_back(instance);
}
/// The same of a new mesh with a material of its own.
inline void place_moving(Scene& scene, Mesh mesh, const Material& material,
                         std::vector<M44f> steps) {
    mesh.material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
    place_moving(scene, static_cast<uint32_t>(scene.meshes.size() - 1), std::move(steps));
}

/// Gives a mesh shapes at steps: moved(position, time) for every vertex. Normals, where it has
/// some, turn by turned_normal(normal, time).
template <class Moved, class Turned>
void deform(Mesh& mesh, size_t count, Moved moved, Turned turned_normal) {
    const std::vector<V3f> positions = mesh.positions, normals = mesh.normals;
    const auto shape_at = [&](float time) {
        MeshStep step;
        for (const V3f& p : positions) step.positions.push_back(moved(p, time));
        for (const V3f& n : normals) step.normals.push_back(turned_normal(n, time));
        step.tangents = mesh.tangents;
        return step;
    };
    mesh.steps = at_steps(count, shape_at);
    const MeshStep middle = shape_at(0.5f);
    mesh.positions = middle.positions;
    mesh.normals = middle.normals;
}
template <class Moved>
void deform(Mesh& mesh, size_t count, Moved moved) {
    deform(mesh, count, moved, [](const V3f& n, float) { return n; });
}

/// The step before a time, and the share of the way to the next, in double.
[[nodiscard]] inline std::pair<size_t, double> place_of_time(double time, size_t count) {
    const double at = time * static_cast<double>(count - 1);
    size_t before = 0;
    while (before + 2 < count && static_cast<double>(before + 1) <= at) ++before;
    return {before, at - static_cast<double>(before)};
}

/// Matrix of an instance at a time, in double.
[[nodiscard]] inline M44d matrix_at(const Scene& scene, uint32_t instance, double time) {
    const Instance& placed = scene.instances[instance];
    if (placed.identity) return {};
    if (instance >= scene.motion_of.size() || scene.motion_of[instance] < 0)
        return M44d(placed.to_world);
    const auto& steps = scene.motions[static_cast<size_t>(scene.motion_of[instance])].to_world;
    const auto [before, share] = place_of_time(time, steps.size());
    return M44d(steps[before]) * (1 - share) + M44d(steps[before + 1]) * share;
}

/// Corners of a triangle in the world at a time, in double.
[[nodiscard]] inline std::array<V3d, 3> corners_at(const Scene& scene, uint32_t instance,
                                                   uint32_t triangle, double time) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const M44d m = matrix_at(scene, instance, time);
    std::array<V3d, 3> out;
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t corner = mesh.triangles[triangle][k];
        V3d p(mesh.positions[corner]);
        if (!mesh.steps.empty()) {
            const auto [before, share] = place_of_time(time, mesh.steps.size());
            p = V3d(mesh.steps[before].positions[corner]) * (1 - share) +
                V3d(mesh.steps[before + 1].positions[corner]) * share;
        }
        out[k] = p * m;
    }
    return out;
}

}  // namespace petzval::test
