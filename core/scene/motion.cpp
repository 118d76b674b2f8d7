// SPDX-License-Identifier: Apache-2.0
#include "core/scene/motion.h"

#include <algorithm>
#include <type_traits>

namespace petzval {
namespace {

V3f between(const V3f& a, const V3f& b, float share) {
    return a * (1.f - share) + b * share;
}

V3f direction_between(const V3f& a, const V3f& b, float share) {
    const V3f sum = between(a, b, share);
    const float length2 = sum.dot(sum);
    return length2 > 0.f ? sum / std::sqrt(length2) : a;
}

struct Between {
    float share;

    template <class L>
    Light operator()(const L& a, const L& b) const {
        L out = a;
        if constexpr (requires { out.position; })
            out.position = between(a.position, b.position, share);
        if constexpr (requires { out.direction; })
            out.direction = direction_between(a.direction, b.direction, share);
        if constexpr (std::is_same_v<L, ProfileLight>) {
            out.x = direction_between(a.x, b.x, share);
            out.y = direction_between(a.y, b.y, share);
            out.f = direction_between(a.f, b.f, share);
        }
        return out;
    }
    template <class A, class B>
    requires(!std::is_same_v<A, B>) Light operator()(const A& a, const B&) const {
        return a;  // the steps of a light are of one kind
    }
};

}  // namespace

Instance moved_instance(const Instance& still, const std::vector<M44f>& places, float time) {
    Instance out = still;
    const auto at = step_place(time, places.size());
    const M44f &a = places[at.before], &b = places[at.before + 1];
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            out.to_world[i][j] = a[i][j] * (1.f - at.share) + b[i][j] * at.share;
    const auto linear = linear_part(M44d(out.to_world));
    out.to_local = M33f(linear.inverse());
    out.flips = linear.determinant() < 0;
    return out;
}

CornerValues moved_corners(const Mesh& mesh, const std::array<uint32_t, 3>& corner,
                           std::vector<V3f> MeshStep::*of, float time) {
    const auto at = step_place(time, mesh.steps.size());
    const std::vector<V3f>&a = mesh.steps[at.before].*of, &b = mesh.steps[at.before + 1].*of;
    CornerValues out;
    for (size_t i = 0; i < 3; ++i) out[i] = between(a[corner[i]], b[corner[i]], at.share);
    return out;
}

V4f moved_tangent(const Mesh& mesh, uint32_t triangle, V2f b, float time) {
    const auto& corner = mesh.triangles[triangle];
    const auto at = step_place(time, mesh.steps.size());
    return interpolate(mesh.steps[at.before].tangents, corner, b) * (1.f - at.share) +
           interpolate(mesh.steps[at.before + 1].tangents, corner, b) * at.share;
}

std::array<V3f, 3> moved_triangle_corners(const Scene& scene, uint32_t instance, uint32_t triangle,
                                          float time) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    return with_instance_at(scene, instance, time, [&](const Instance& placement) {
        CornerValues moved;
        const auto at = corner_positions(mesh, mesh.triangles[triangle], time, moved);
        return std::array<V3f, 3>{placed(placement, *at[0]), placed(placement, *at[1]),
                                  placed(placement, *at[2])};
    });
}

size_t step_count(const Scene& scene, uint32_t instance) {
    const size_t shapes = scene.meshes[scene.instances[instance].mesh].steps.size();
    const auto* const places = places_of(scene, instance);
    return std::max({size_t{1}, shapes, places ? places->size() : 0});
}

Light moved_light(const std::vector<Light>& steps, float time) {
    const auto at = step_place(time, steps.size());
    return std::visit(Between{at.share}, steps[at.before], steps[at.before + 1]);
}

bool has_motion(const Scene& scene) {
    return !scene.motions.empty() || !scene.light_motions.empty() ||
           std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const Mesh& mesh) { return !mesh.steps.empty(); });
}

}  // namespace petzval
