// SPDX-License-Identifier: Apache-2.0
// Light that a path's ray finds: of the sky, of suns and of what glows. It is weighed against the
// light samples that could have found it (multiple importance sampling).
#pragma once

#include "integrator/path/path.h"

namespace petzval::integrator {

/// Weight of a sample drawn with density a where b might have drawn it too. Veach 1997, "Robust
/// Monte Carlo Methods for Light Transport Simulation", equation 9.13 with beta = 2.
[[nodiscard]] inline float power_heuristic(float a, float b) {
    if (a <= 0.f) return 0.f;
    const float ratio = b / a;  // the densities may overflow when squared, their ratio hardly can
    return 1.f / (1.f + ratio * ratio);
}

template <RayCaster Caster, class Watch>
struct PathTracer<Caster, Watch>::FoundLight {
    f4 radiance{};
    uint64_t by_chance = 0;  ///< lamps that no light sample could have found
};

/// Adds the light from behind the scene, where a ray leaves it.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline void PathTracer<Caster, Watch>::add_background(
    PathState& path, FilmSample& out) const {
    if (path.surface_seen) {
        const FoundLight sky = sky_light(path);
        path.radiance += watch_.adds(PathStep::Sky, path.throughput * sky.radiance);
        path.chance_finds().lamps += sky.by_chance;
    } else {
        path.radiance +=
            watch_.adds(PathStep::Sky, path.throughput * visible_background(path, out));
    }
    if (scene_.sun_discs.empty() || (!path.surface_seen && options_.transparent)) return;
    const FoundLight suns = sun_discs(path);
    path.radiance += watch_.adds(PathStep::Sky, path.throughput * suns.radiance);
    path.chance_finds().lamps += suns.by_chance;
}

template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline f4 PathTracer<Caster, Watch>::visible_background(
    const PathState& path, FilmSample& out) const {
    if (options_.transparent) return f4{};
    out.alpha = 1.f;
    return uplift_radiance(options_.visible_background ? *options_.visible_background
                                                       : scene_.sky.radiance(path.ray.direction),
                           path.bands);
}

template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline auto PathTracer<Caster, Watch>::sky_light(const PathState& path) const
    -> FoundLight {
    if (scene_.sky.black()) return {};
    const Vertex& last = path.last;
    const Sky::Found found = scene_.sky.find(path.ray.direction);
    FoundLight out{uplift_radiance(found.radiance, path.bands)};
    out.by_chance = !last.light_sampled && scene_.sky.is_sun(found.radiance);
    if (!last.light_sampled || !(found.pdf > 0.f)) return out;
    const auto sky = static_cast<uint32_t>(scene_.sky_light);
    const float light_pdf = lights_.probability(sky, last.receiver) * found.pdf;
    if (options_.technique == Technique::LightOnly && light_pdf > 0.f) return {};
    out.radiance = out.radiance * power_heuristic(last.pdf, light_pdf);
    return out;
}

/// Light that a surface sends along the ray; of a lamp weighed, of an unlit one as it is.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline auto PathTracer<Caster, Watch>::emitted(
    const PathState& path, const Surface& s, const ShadingInput& shading) const -> FoundLight {
    const Vertex& last = path.last;
    const Material& m = *s.material;
    const bool is_lamp = s.instance->first_light >= 0;
    FoundLight out;
    out.by_chance = path.scatterings > 0 && !last.light_sampled && is_lamp;
    if (m.unlit && (s.front || m.double_sided))
        out.radiance = scene_.uplift_radiance(shading.unlit, path.bands, m.illuminant);
    if (!m.emits() || !(hmax(shading.emitted.v) > 0.f)) return out;
    const f4 glow = scene_.uplift_radiance(shading.emitted, path.bands, m.illuminant);
    if (!last.light_sampled || !is_lamp) {
        out.radiance += glow;
        return out;
    }
    const uint32_t light = static_cast<uint32_t>(s.instance->first_light) + s.hit.triangle;
    const V3f along = s.p - last.p;
    const float distance_squared = along.dot(along);
    const float cosine = s.ng.dot(along) / std::sqrt(distance_squared);
    const float light_pdf = lights_.probability(light, last.receiver) *
                            triangle_light_pdf(scene_, {s.hit.instance, s.hit.triangle}, last.p,
                                               distance_squared, std::fabs(cosine), s.hit.time);
    if (options_.technique == Technique::LightOnly && light_pdf > 0.f) return out;
    out.radiance += glow * power_heuristic(last.pdf, light_pdf);
    return out;
}

}  // namespace petzval::integrator
