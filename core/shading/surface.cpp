// SPDX-License-Identifier: Apache-2.0
#include "core/shading/surface.h"

#include <algorithm>

#include "core/scene/motion.h"

namespace petzval {
namespace {

V3f abs_transform(const V3f& p, const M44f& m) {
    V3f sum;
    for (int j = 0; j < 3; ++j)
        sum[j] = std::fabs(p.x * m[0][j]) + std::fabs(p.y * m[1][j]) + std::fabs(p.z * m[2][j]) +
                 std::fabs(m[3][j]);
    return sum;
}

// Unnormalised normal in world space, by the inverse transpose; to_local is the inverse.
V3f transform_normal(const V3f& n, const M33f& to_local) {
    return {n.x * to_local[0][0] + n.y * to_local[0][1] + n.z * to_local[0][2],
            n.x * to_local[1][0] + n.y * to_local[1][1] + n.z * to_local[1][2],
            n.x * to_local[2][0] + n.y * to_local[2][1] + n.z * to_local[2][2]};
}

// Way from a point of a triangle to the smooth surface that its corners' normals mean, in the
// mesh's own space: the mean of the point's projections on the tangent planes of the corners, where
// those lie above it. Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4.
// Normals far from the triangle's are those of a hard edge that was smoothed by mistake, and mean
// no surface. n: the triangle's, any length.
V3f way_to_smooth(const CornerPointers& positions, const CornerPointers& normals, V2f u,
                  const V3f& p, const V3f& n, bool front) {
    constexpr float all = 0.766f, none = 0.643f;  // cosines of 40 and 50 degrees
    const float weight[3] = {1.f - u.x - u.y, u.x, u.y};
    const V3f triangle = n * (1.f / std::sqrt(n.dot(n)));
    V3f sum(0.f);
    for (size_t i = 0; i < 3; ++i) {
        const V3f& normal = *normals[i];
        const float above = (p - *positions[i]).dot(normal);
        if (front ? !(above < 0.f) : !(above > 0.f)) continue;
        const float share = clamp_unit((normal.dot(triangle) - none) / (all - none));
        sum -= normal * (above * weight[i] * share);
    }
    return sum;
}

// Bound on how far rounding of what moves carries a point of a triangle, in each axis: it grows
// with the steps' own coordinates, between which the point may be near 0.
V3f motion_error(const Scene& scene, const Hit& hit) {
    const Instance& instance = scene.instances[hit.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    V3f reach(0.f);
    const auto extend = [&](const std::vector<V3f>& positions) {
        for (const uint32_t corner : mesh.triangles[hit.triangle])
            for (int k = 0; k < 3; ++k)
                reach[k] = std::max(reach[k], std::fabs(positions[corner][k]));
    };
    extend(mesh.positions);
    if (!mesh.steps.empty()) {
        const size_t before = step_place(hit.time, mesh.steps.size()).before;
        extend(mesh.steps[before].positions);
        extend(mesh.steps[before + 1].positions);
    }
    if (instance.identity) return reach * rounding_bound(6);
    const auto* const places = places_of(scene, hit.instance);
    if (!places) return abs_transform(reach, instance.to_world) * rounding_bound(6);
    const size_t before = step_place(hit.time, places->size()).before;
    return (abs_transform(reach, (*places)[before]) + abs_transform(reach, (*places)[before + 1])) *
           rounding_bound(8);
}

// Geometry of a hit of a mesh that is placed so. kStill: neither it nor its mesh moves.
template <bool kStill>
[[gnu::always_inline]] inline Surface surface_of(const Scene& scene, const Instance& placement,
                                                 const V3f& direction, const Hit& hit) {
    Surface s;
    s.hit = hit;
    s.instance = &scene.instances[hit.instance];
    s.mesh = &scene.meshes[s.instance->mesh];
    s.material = &scene.materials[s.mesh->material];
    const auto& corner = s.mesh->triangles[hit.triangle];
    CornerValues moved_positions, moved_normals;
    const auto positions = corner_positions<kStill>(*s.mesh, corner, hit.time, moved_positions);
    const V3f &a = *positions[0], &b = *positions[1], &c = *positions[2];
    const V2f u = hit.barycentric;
    const float w = 1.f - u.x - u.y;
    s.p = a * w + b * u.x + c * u.y;
    // Seven roundings from the corners to p; Embree's own coordinates add as many again.
    s.p_error = (abs(a) * std::fabs(w) + abs(b) * u.x + abs(c) * u.y) * rounding_bound(14);
    V3f n = (b - a).cross(c - a);
    const bool smooth = !s.mesh->normals.empty();
    CornerPointers normals;
    V3f ns = n;
    if (smooth) {
        normals = corner_normals<kStill>(*s.mesh, corner, hit.time, moved_normals);
        ns = *normals[0] * w + *normals[1] * u.x + *normals[2] * u.y;
    }
    const V3f p_of_mesh = s.p, n_of_mesh = n;
    if (!placement.identity) {
        const M44f& m = placement.to_world;
        const V3f magnitude = abs_transform(s.p, m);
        M44f linear = m;
        for (int j = 0; j < 3; ++j) linear[3][j] = 0;
        s.p_error = abs_transform(s.p_error, linear) + magnitude * rounding_bound(8);
        V3f moved;
        m.multVecMatrix(s.p, moved);
        s.p = moved;
        n = transform_normal(n, placement.to_local);
        ns = smooth ? transform_normal(ns, placement.to_local) : n;
    }
    s.ng = unit(n);
    if constexpr (!kStill) {
        s.p_error += motion_error(scene, hit);
        if (!is_finite(s.ng)) s.ng = -unit(direction);  // without an area at this moment
    }
    const float length2 = ns.dot(ns);
    s.ns = length2 > 0.f ? ns * (1.f / std::sqrt(length2)) : s.ng;
    if (s.ns.dot(s.ng) < 0.f) s.ns = -s.ns;
    s.front = direction.dot(s.ng) < 0.f;
    s.side = s.facing();
    s.lift = V3f(0.f);
    if (smooth && !s.material->lets_light_through() && s.ns.dot(s.ng) < kSameNormal) {
        const V3f towards = s.front ? s.ns : -s.ns;
        if (direction.dot(towards) < 0.f)
            s.lift = way_to_smooth(positions, normals, u, p_of_mesh, n_of_mesh, s.front);
        if (s.lifted()) {
            s.side = towards;
            if (!placement.identity) s.lift = transform_direction(s.lift, placement.to_world);
        }
    }
    for (int i = 0; i < 2; ++i)
        if (!s.mesh->uv[i].empty()) s.uv[i] = interpolate(s.mesh->uv[i], corner, u);
    return s;
}

}  // namespace

Surface make_surface(const Scene& scene, const V3f& direction, const Hit& hit) {
    if (const Instance& still = scene.instances[hit.instance]; !still.moves) [[likely]]
        return surface_of<true>(scene, still, direction, hit);
    return with_instance_at(scene, hit.instance, hit.time, [&](const Instance& placement) {
        return surface_of<false>(scene, placement, direction, hit);
    });
}

}  // namespace petzval
