// SPDX-License-Identifier: Apache-2.0
// Boundary between volumes: the face that a ray meets, with those that lie on top of it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/scene/volumes.h"
#include "core/shading/surface.h"

namespace petzval {

/// What a path crosses at a hit, where the hit's material refracts.
struct Boundary {
    Surface surface;   ///< whose material shades the boundary
    Volumes behind;    ///< what the path is in where it goes through
    Fillings sides{};  ///< of the surface
    /// What moves rays that leave the surface clear of all its faces; 0 where there is only one.
    V3f clear_back{0.f}, clear_onward{0.f};

    [[nodiscard]] V3f clear(bool onward) const { return onward ? clear_onward : clear_back; }

    /// Whether nothing changes here: a volume of higher priority fills both sides.
    [[nodiscard]] bool hidden() const {
        return sides.before == sides.behind && !surface.material->emits();
    }
};

namespace boundary_detail {

using Triangle = std::array<V3f, 3>;

// Whether the point of a surface lies on an edge of its triangle, up to rounding.
inline bool is_on_edge(const Surface& s, const Triangle& t) {
    const V2f u = s.hit.barycentric;
    const std::array<float, 3> weight{1 - u.x - u.y, u.x, u.y};
    const float twice_area = (t[1] - t[0]).cross(t[2] - t[0]).length();
    for (size_t i = 0; i < 3; ++i) {  // the edge across from corner i
        const float edge_m = (t[(i + 1) % 3] - t[(i + 2) % 3]).length();
        if (weight[i] * twice_area <= 4 * s.p_error.length() * edge_m) return true;
    }
    return false;
}

// Whether two faces at the same point are one crossing of one surface: the point lies on an edge or
// a corner that they share.
inline bool are_neighbours(const Scene& scene, const Surface& a, const Surface& b) {
    if (a.material != b.material || a.front != b.front) return false;
    const Triangle of_a = triangle_corners(scene, a.hit.instance, a.hit.triangle);
    const Triangle of_b = triangle_corners(scene, b.hit.instance, b.hit.triangle);
    if (!is_on_edge(a, of_a) && !is_on_edge(b, of_b)) return false;
    for (const V3f& p : of_a)
        for (const V3f& q : of_b)
            if ((p - q).length() <= 4e-6f * (p.length() + q.length())) return true;
    return false;
}

// Adds the faces of closed volumes along the normal of the first one, from `back` before it to
// `onward` behind it, in metres.
template <class Caster>
void add_coincident(const Scene& scene, const Caster& caster, float back_m, float onward_m,
                    std::vector<Surface>& faces) {
    const V3f onward = -faces.front().facing();
    Ray probe;
    probe.origin = faces.front().p - onward * back_m;
    probe.direction = onward;
    probe.t_max = back_m + onward_m;
    for (const Hit& hit : caster.all_hits(probe)) {
        const Surface face = make_surface(scene, onward, hit);
        if (face.material->priority == 0) continue;
        const auto is_known = [&](const Surface& f) {
            return (f.hit.instance == hit.instance && f.hit.triangle == hit.triangle) ||
                   are_neighbours(scene, f, face);
        };
        if (std::none_of(faces.begin(), faces.end(), is_known)) faces.push_back(face);
    }
}

}  // namespace boundary_detail

/// Boundary at a hit of a ray on a material that refracts; corrects `volumes`, what the path came
/// in, by the sides on which it arrives. Faces of closed volumes that lie within rounding of each
/// other are one boundary, shaded by the one of the highest priority that changes what fills space.
template <class Caster>
[[nodiscard]] Boundary boundary_at(const Scene& scene, const Caster& caster, const Ray& ray,
                                   const Surface& s, Volumes& volumes) {
    Boundary out{s, volumes, {}};
    const Material& m = *s.material;
    volumes.correct(m, s.front);
    if (m.priority == 0) {
        out.behind = volumes;
        out.behind.cross(m, s.front);
        const Material* const outside = volumes.closed_filling();
        out.sides = s.front ? Fillings{outside, &m} : Fillings{&m, outside};
        return out;
    }
    if (!scene.volumes_meet) {
        out.behind = volumes;
        out.behind.cross(m, s.front);
        out.sides = {volumes.filling(), out.behind.filling()};
        return out;
    }
    std::vector<Surface> faces{s};
    // Twice the error of a point, and what Embree's t may be off by. What lies before the ray's
    // origin, the path has crossed already.
    const V3f way = s.p - ray.origin;
    const float onward_m = 2 * abs(s.ng).dot(s.p_error) + rounding_bound(8) * way.length();
    const float back_m = std::min(onward_m, std::fabs(way.dot(s.ng)));
    boundary_detail::add_coincident(scene, caster, back_m, onward_m, faces);
    for (const Surface& f : faces) volumes.correct(*f.material, f.front);
    out.behind = volumes;
    for (const Surface& f : faces) out.behind.cross(*f.material, f.front);
    out.sides = {volumes.filling(), out.behind.filling()};
    if (faces.size() == 1) return out;
    out.clear_back = s.facing() * back_m;
    out.clear_onward = -s.facing() * onward_m;
    const Surface* shading = nullptr;
    for (const Surface& f : faces) {
        const bool changes = f.material == out.sides.before || f.material == out.sides.behind;
        if (changes && (!shading || f.material->priority > shading->material->priority))
            shading = &f;
    }
    if (shading) out.surface = *shading;
    return out;
}

}  // namespace petzval
