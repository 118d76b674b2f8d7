// SPDX-License-Identifier: Apache-2.0
// Light of suns with a disc, which a path's ray finds behind the scene. Few scenes have one.
#pragma once

#include "core/light/sun_disc.h"
#include "core/scene/motion.h"
#include "integrator/path/found_light.h"

namespace petzval::integrator {

template <RayCaster Caster, class Watch>
auto PathTracer<Caster, Watch>::sun_discs(const PathState& path) const -> FoundLight {
    const Vertex& last = path.last;
    FoundLight out;
    for (const uint32_t light : scene_.sun_discs) {
        std::optional<Light> moved;
        const auto& sun = std::get<SunLight>(light_at(scene_, light, path.ray.time, moved));
        if ((path.in_view && sun.unseen) || !is_in_disc(sun, path.ray.direction)) continue;
        const f4 radiance = scene_.uplift_radiance(disc_radiance(sun), path.bands, sun.illuminant);
        out.by_chance += !path.in_view && !last.light_sampled;
        const float light_pdf =
            last.light_sampled ? lights_.probability(light, last.receiver) * disc_pdf(sun) : 0.f;
        if (options_.technique == Technique::LightOnly && light_pdf > 0.f) continue;
        out.radiance += radiance * (light_pdf > 0.f ? power_heuristic(last.pdf, light_pdf) : 1.f);
    }
    return out;
}

}  // namespace petzval::integrator
