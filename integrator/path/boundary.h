// SPDX-License-Identifier: Apache-2.0
// Boundary between volumes: the face that a ray meets, with those that lie on top of it.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/scene/volumes.h"
#include "core/shading/surface.h"

namespace petzval::integrator {

/// What a path crosses at a hit, where the hit's material refracts.
struct Boundary {
    std::optional<Surface>
        shading;     ///< face that shades it; nothing where it is the one that was met
    Volumes behind;  ///< what the path is in where it goes through
    Fillings sides{};
    bool hidden = false;  ///< nothing changes here: a volume of higher priority fills both sides
    /// What moves rays that leave the surface clear of all its faces; 0 where there is only one.
    V3f clear_back{0.f}, clear_onward{0.f};

    [[nodiscard]] V3f clear(bool onward) const { return onward ? clear_onward : clear_back; }
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
    const Triangle of_a = triangle_corners(scene, a.hit.instance, a.hit.triangle, a.hit.time);
    const Triangle of_b = triangle_corners(scene, b.hit.instance, b.hit.triangle, b.hit.time);
    if (!is_on_edge(a, of_a) && !is_on_edge(b, of_b)) return false;
    for (const V3f& p : of_a)
        for (const V3f& q : of_b)
            if ((p - q).length() <= 4e-6f * (p.length() + q.length())) return true;
    return false;
}

// Faces of closed volumes beside one that was met, along its normal, from `back` before it to
// `onward` behind it, in metres.
template <class Caster>
std::vector<Surface> faces_beside(const Scene& scene, const Caster& caster, const Surface& s,
                                  float back_m, float onward_m) {
    Ray probe;
    probe.direction = -s.facing();
    probe.origin = s.p - probe.direction * back_m;
    probe.t_max = back_m + onward_m;
    probe.time = s.hit.time;
    std::vector<Surface> faces;
    for (const Hit& hit : caster.all_hits(probe)) {
        if (hit.instance == s.hit.instance && hit.triangle == s.hit.triangle) continue;
        const Surface face = make_surface(scene, probe.direction, hit);
        const auto is_known = [&](const Surface& f) { return are_neighbours(scene, f, face); };
        if (face.material->priority > 0 && !is_known(s) &&
            std::none_of(faces.begin(), faces.end(), is_known))
            faces.push_back(face);
    }
    return faces;
}

}  // namespace boundary_detail

/// Boundary at a hit of a ray on a material that refracts; corrects `volumes`, what the path came
/// in, by the sides on which it arrives. Faces of closed volumes that lie within rounding of each
/// other are one boundary, shaded by the one of the highest priority that changes what fills space.
template <class Caster>
[[nodiscard]] Boundary boundary_at(const Scene& scene, const Caster& caster, const Ray& ray,
                                   const Surface& s, Volumes& volumes) {
    Boundary out;
    const Material& m = *s.material;
    volumes.correct(m, s.front);
    if (m.priority == 0) {
        out.behind = volumes;
        out.behind.cross(m, s.front);
        const Material* const outside = volumes.closed_filling();
        out.sides = s.front ? Fillings{outside, &m} : Fillings{&m, outside};
        return out;
    }
    float back_m = 0, onward_m = 0;
    std::vector<Surface> beside;
    if (scene.volumes_meet) {
        // Twice the error of a point, and what Embree's t may be off by. What lies before the ray's
        // origin, the path has crossed already.
        const V3f way = s.p - ray.origin;
        onward_m = 2 * abs(s.ng).dot(s.p_error) + rounding_bound(8) * way.length();
        back_m = std::min(onward_m, std::fabs(way.dot(s.ng)));
        beside = boundary_detail::faces_beside(scene, caster, s, back_m, onward_m);
    }
    for (const Surface& f : beside) volumes.correct(*f.material, f.front);
    out.behind = volumes;
    out.behind.cross(m, s.front);
    for (const Surface& f : beside) out.behind.cross(*f.material, f.front);
    out.sides = {volumes.filling(), out.behind.filling()};
    const auto emits = [](const Surface& f) { return f.material->emits(); };
    out.hidden = out.sides.before == out.sides.behind && !m.emits() &&
                 std::none_of(beside.begin(), beside.end(), emits);
    if (beside.empty()) return out;
    out.clear_back = s.facing() * back_m;
    out.clear_onward = -s.facing() * onward_m;
    const auto changes = [&](const Material* of) {
        return of == out.sides.before || of == out.sides.behind;
    };
    const Surface* shading = changes(&m) ? &s : nullptr;
    for (const Surface& f : beside)
        if (changes(f.material) && (!shading || f.material->priority > shading->material->priority))
            shading = &f;
    if (shading && shading != &s) out.shading = *shading;
    return out;
}

}  // namespace petzval::integrator
