// SPDX-License-Identifier: Apache-2.0
#include "core/shading/surface.h"

#include <algorithm>

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
V3f way_to_smooth(const Mesh& mesh, const std::array<uint32_t, 3>& corner, V2f u, const V3f& p,
                  const V3f& n, bool front) {
    constexpr float all = 0.766f, none = 0.643f;  // cosines of 40 and 50 degrees
    const float weight[3] = {1.f - u.x - u.y, u.x, u.y};
    const V3f triangle = n * (1.f / std::sqrt(n.dot(n)));
    V3f sum(0.f);
    for (size_t i = 0; i < 3; ++i) {
        const V3f& normal = mesh.normals[corner[i]];
        const float above = (p - mesh.positions[corner[i]]).dot(normal);
        if (front ? !(above < 0.f) : !(above > 0.f)) continue;
        const float share = clamp_unit((normal.dot(triangle) - none) / (all - none));
        sum -= normal * (above * weight[i] * share);
    }
    return sum;
}

}  // namespace

Surface make_surface(const Scene& scene, const V3f& direction, const Hit& hit) {
    Surface s;
    s.hit = hit;
    s.instance = &scene.instances[hit.instance];
    s.mesh = &scene.meshes[s.instance->mesh];
    s.material = &scene.materials[s.mesh->material];
    const auto& corner = s.mesh->triangles[hit.triangle];
    const V3f& a = s.mesh->positions[corner[0]];
    const V3f& b = s.mesh->positions[corner[1]];
    const V3f& c = s.mesh->positions[corner[2]];
    const V2f u = hit.barycentric;
    const float w = 1.f - u.x - u.y;
    s.p = a * w + b * u.x + c * u.y;
    // Seven roundings from the corners to p; Embree's own coordinates add as many again.
    s.p_error = (abs(a) * std::fabs(w) + abs(b) * u.x + abs(c) * u.y) * rounding_bound(14);
    V3f n = (b - a).cross(c - a);
    const V3f p_of_mesh = s.p, n_of_mesh = n;
    const bool smooth = !s.mesh->normals.empty();
    V3f ns = smooth ? interpolate(s.mesh->normals, corner, u) : n;
    if (!s.instance->identity) {
        const M44f& m = s.instance->to_world;
        const V3f magnitude = abs_transform(s.p, m);
        M44f linear = m;
        for (int j = 0; j < 3; ++j) linear[3][j] = 0;
        s.p_error = abs_transform(s.p_error, linear) + magnitude * rounding_bound(8);
        V3f moved;
        m.multVecMatrix(s.p, moved);
        s.p = moved;
        n = transform_normal(n, s.instance->to_local);
        ns = smooth ? transform_normal(ns, s.instance->to_local) : n;
    }
    s.ng = unit(n);
    const float length2 = ns.dot(ns);
    s.ns = length2 > 0.f ? ns * (1.f / std::sqrt(length2)) : s.ng;
    if (s.ns.dot(s.ng) < 0.f) s.ns = -s.ns;
    s.front = direction.dot(s.ng) < 0.f;
    s.side = s.facing();
    s.lift = V3f(0.f);
    if (smooth && !s.material->lets_light_through() && s.ns.dot(s.ng) < kSameNormal) {
        const V3f towards = s.front ? s.ns : -s.ns;
        if (direction.dot(towards) < 0.f)
            s.lift = way_to_smooth(*s.mesh, corner, u, p_of_mesh, n_of_mesh, s.front);
        if (s.lifted()) {
            s.side = towards;
            if (!s.instance->identity) s.lift = transform_direction(s.lift, s.instance->to_world);
        }
    }
    for (int i = 0; i < 2; ++i)
        if (!s.mesh->uv[i].empty()) s.uv[i] = interpolate(s.mesh->uv[i], corner, u);
    return s;
}

}  // namespace petzval
