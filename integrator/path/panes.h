// SPDX-License-Identifier: Apache-2.0
// The straight way of light through panes: thin, smooth glass, which bends nothing.
#pragma once

#include <optional>

#include "core/shading/surface.h"
#include "integrator/path/stats.h"

namespace petzval::integrator {

/// End of a shadow ray: a point, or a direction without end.
struct WayToLight {
    Ray ray;  ///< up to the point for ray.t_max < 1 of its direction, or without end
    V3f target;
    bool at_infinity;
    const Material* medium;  ///< volume that the way lies in, or null
    int most_panes;          ///< that light may pass
};

/// Share of light that comes through the panes on a way where nothing else stands (but BLEND
/// surfaces, which count elsewhere), and the chance that a path goes straight through all panes;
/// nothing where a surface lets no light straight through, or there are too many. From surface to
/// surface in order of distance, as what a lane carries decides on the chance at the next:
/// `carried` is what the path would carry there, up to a factor.
template <class Caster>
[[nodiscard]] std::optional<StraightThrough> through_panes(const Scene& scene, const Caster& caster,
                                                           WayToLight way, f4 carried,
                                                           const Bands& bands, PathStats& stats) {
    StraightThrough out{uniform(1.f, bands), 1.f};
    PassedBlends blends;
    blends.all = true;
    V3f from = way.ray.origin;
    for (int n = 0;; ++n) {
        const std::optional<Hit> hit = timed(stats, TimedSection::Traversal,
                                             [&] { return caster.intersect(way.ray, &blends); });
        ++stats.shadow_rays;
        if (!hit) return out;
        const Surface s = make_surface(scene, way.ray.direction, *hit);
        if (n >= way.most_panes || s.material->unlit) return std::nullopt;
        const V3f wo = -unit(way.ray.direction);
        if (way.medium) carried *= transmittance(*way.medium, (s.p - from).length(), bands);
        const ShadingInput shading = read_material(scene, s, wo, bands);
        if (!(hmax(carried) >= std::numeric_limits<float>::min())) return std::nullopt;
        const StraightThrough pane = shading.scatter(wo, bands, carried).straight_through();
        if (!(pane.chance > 0.f)) return std::nullopt;
        out.value *= pane.value;
        out.chance *= pane.chance;
        carried *= pane.value;
        from = s.p;
        way.ray.origin = offset_origin(s.p, s.p_error, s.ng, way.ray.direction);
        if (!way.at_infinity) way.ray.direction = way.target - way.ray.origin;
    }
}

}  // namespace petzval::integrator
