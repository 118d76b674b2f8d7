// SPDX-License-Identifier: Apache-2.0
// Boundary between volumes: the face that a ray meets, with those that lie on top of it.
#pragma once

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

// Adds the faces of closed volumes along the normal of the first one, from `back` before it to
// `onward` behind it, in metres. Neighbours that share an edge with one of them are left out: an
// object is crossed once a side.
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
        bool known = false;
        for (const Surface& f : faces)
            known |= f.hit.instance == hit.instance && f.front == face.front;
        if (!known) faces.push_back(face);
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
    if (!scene.may_nest()) {
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
