// SPDX-License-Identifier: Apache-2.0
// Steps of a path from surface to surface. Those that every surface takes are inlined: calls, and
// what they keep in memory for them, took 2 % of the instructions of a sample.
#pragma once

#include "integrator/path/front_at_back.h"
#include "integrator/path/sampled_light.h"
#include "integrator/path/start_volumes.h"

namespace petzval::integrator {

/// Density from which on a scattered direction counts as drawn by a narrow lobe, 1/sr: one of GGX
/// with a roughness below 0.5 or so.
inline constexpr float kNarrowPdf = 1;

/// From here on of the way to a BLEND surface, the ray looks again: with room for rounding. What
/// it did not meet nearer, it does not meet.
inline constexpr float kNearOne = 0.999f;

/// Direction in which a path goes on from a surface.
template <RayCaster Caster, class Watch>
struct PathTracer<Caster, Watch>::Onward {
    BsdfSample drawn;
    V3f direction;  ///< in the world
    bool straight;  ///< through a pane
};

template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline PathState PathTracer<Caster, Watch>::begun(const PathStart& start,
                                                                         const Bands& bands,
                                                                         const Sampler& sampler,
                                                                         PathStats& stats) const {
    const bool has_cutouts = caster_.has_cutouts();
    const Ray& ray = start.ray;
    return {bands,
            sampler,
            stats,
            start.hero_decided,
            start.continue_probability,
            has_cutouts,
            has_cutouts && caster_.has_blends(),
            ray,
            zero_off(start.lanes, uniform(1.f, bands)),
            {ray.origin},
            ray.origin,
            scene_.may_be_in_volume(ray.origin) ? volumes_at(scene_, caster_, ray.origin, ray.time)
                                                : Volumes{}};
}

/// Intersects the next segment with the scene. Its seed stays where the path goes on behind a BLEND
/// surface: what it does not meet, it does not meet a second time.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline std::optional<Hit> PathTracer<Caster, Watch>::next_hit(
    PathState& path) const {
    if (path.has_cutouts)
        path.ray.alpha_seed =
            path.sampler.get_bits(Dim::Coverage, 2 * static_cast<uint32_t>(path.scatterings));
    ++(path.scatterings == 0 ? path.stats.camera_rays : path.stats.bounce_rays);
    return timed(path.stats, TimedSection::Traversal,
                 [&] { return caster_.intersect(path.ray, path.passed()); });
}

/// Takes a path to what it sees, and through the volume on the way: not to what is culled, nor to
/// faces at which nothing changes.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline auto PathTracer<Caster, Watch>::advance_to_surface(PathState& path,
                                                                                 Arrival& at) const
    -> Step {
    Surface& s = at.surface;
    // Skip backs of single-sided surfaces, which glTF culls from view, and lamps that are not
    // to be seen, these behind panes too. Light must not pass them, so only camera rays do; the
    // inside of a volume is never culled.
    if (culled_from_view(s)) {
        std::optional<Surface> front;
        if (!s.front) front = front_at_back(scene_, caster_, path.ray, s, path.passed());
        if (front) {
            s = *front;
        } else if (!path.surface_seen || (path.in_view && s.material->unseen)) {
            path.go_on_from(offset_origin(s.p, s.p_error, s.ng, path.ray.direction));
            watch_.sees({.step = PathStep::Culled, .surface = s});
            return Step::GoOn;
        }
    }
    if (s.material->refracts()) {
        at.boundary = boundary_at(scene_, caster_, path.ray, s, path.volumes);
        if (at.boundary->shading) s = *at.boundary->shading;
    }
    const Material* const medium = path.volumes.filling();
    if (medium)
        path.throughput *= transmittance(*medium, (s.p - path.segment_start).length(), path.bands);
    at.sides = at.boundary ? at.boundary->sides : Fillings{medium, medium};
    watch_.sees(
        {.step = PathStep::Meets, .lanes = path.throughput, .medium = medium, .surface = s});
    if (!at.boundary || !at.boundary->hidden) return Step::Arrived;
    watch_.ends(PathStep::Hidden);
    // Shadow rays stop at the faces of volumes: what the path finds now, they have not found.
    if (path.specular_depth++ == options_.max_specular_depth) {
        ++path.stats.specular_ends;
        watch_.ends(PathStep::MaxClearDepth);
        return Step::End;
    }
    path.chance_finds().bounces += path.last.light_sampled;
    path.last.light_sampled = false;
    path.volumes = at.boundary->behind;
    path.segment_start = s.p;
    path.go_on_from(leave_surface(s, path.ray.direction, true) + at.boundary->clear_onward);
    return Step::GoOn;
}

/// Passes a BLEND surface, which scatters the path with a chance.
inline void go_on_behind(PathState& path, const Surface& s, const Blend& blend,
                         float scattering_chance) {
    path.throughput *= (1.f - blend.weight) / (1.f - scattering_chance);
    path.segment_start = s.p;
    path.blends.t_min = kNearOne * (s.p - path.ray.origin).dot(path.ray.direction);
    path.blends.add({s.hit.instance, s.hit.triangle, 1.f - blend.alpha});
    ++path.blends_passed;
}

/// Samples the BSDF for the next direction; nothing where the path ends.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline auto PathTracer<Caster, Watch>::scatter(
    PathState& path, const Scattering& at, const Sampler::VertexNumbers& u) const
    -> std::optional<Onward> {
    // Solid glass mirrors little, and a ray may have been sent to an image in it. Small numbers,
    // with which clear glass mirrors, are drawn more often.
    const bool may_be_image = path.continue_probability < 1.f && path.scatterings == 0 &&
                              at.bsdf.is_clear() && !at.shading.bsdf.thin;
    auto next =
        at.bsdf.sample(may_be_image ? sqr(u.bsdf_lobe) : u.bsdf_lobe, u.bsdf, path.hero_decided);
    if (!next) return watch_.ends(PathStep::Absorbed);
    if (may_be_image) next->weight *= 2.f * u.bsdf_lobe;
    const bool is_clear = next->delta && at.bsdf.is_clear();
    if (is_clear && path.specular_depth == options_.max_specular_depth) {
        ++path.stats.specular_ends;
        return watch_.ends(PathStep::MaxClearDepth);
    }
    if (!is_clear && at.at_depth) return watch_.ends(PathStep::MaxDepth);
    ++(is_clear ? path.specular_depth : path.depth);
    // What is scattered far and wide, ordinary rays find as well. A narrow lobe may be the
    // highlight that the ray was sent for.
    if (path.continue_probability < 1.f && !next->delta && next->pdf < kNarrowPdf) {
        if (path.sampler.get1(Dim::TargetRest) >= path.continue_probability)
            return watch_.ends(PathStep::LeftToOthers);
        path.throughput *= 1.f / path.continue_probability;
        path.continue_probability = 1.f;
    }
    const V3f direction = at.shading.frame.to_world(next->wi);
    // No ray that is not a number goes on: the film counts the sample and names its pixel.
    if (!std::isfinite(direction.x + direction.y + direction.z)) {
        path.radiance = splat(std::numeric_limits<float>::quiet_NaN());
        return watch_.ends(PathStep::NotFinite);
    }
    // Shadow rays go on through panes: what a path finds behind one, they find as well.
    const bool straight = is_clear && next->transmitted && at.shading.bsdf.thin;
    if (!next->delta)
        path.was_rough = true;
    else if (!straight || !path.last.light_sampled)
        ++path.chance_finds().bounces;
    path.throughput *= next->weight;
    path.hero_decided |= next->transmitted && at.shading.bsdf.disperses;
    if (next->transmitted && at.at.boundary) path.volumes = at.at.boundary->behind;
    ++path.scatterings;
    watch_.sees({.step = PathStep::GoesOn, .drawn = *next, .straight = straight});
    return Onward{*next, direction, straight};
}

/// Plays Russian roulette, by what the path has lost; u in [0, 1). Returns whether it goes on.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline bool PathTracer<Caster, Watch>::survives(PathState& path,
                                                                       float u) const {
    if (path.scatterings <= options_.roulette_depth) return true;
    const float most = std::sqrt(hmax(path.throughput)), survival = most < 1.f ? most : 1.f;
    watch_.sees({.step = PathStep::Roulette, .number = survival});
    if (u >= survival) return false;
    path.throughput *= 1.f / survival;
    return true;
}

/// Sets the ray to the segment behind a surface.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline void PathTracer<Caster, Watch>::leave(PathState& path,
                                                                    const Scattering& at,
                                                                    const Onward& onward) {
    const Surface& s = at.at.surface;
    if (onward.straight) {
        path.segment_start = s.p;
        path.last.pdf *= at.bsdf.straight_through().chance;
        path.go_on_from(offset_origin(s.p, s.p_error, s.ng, path.ray.direction));
        return;
    }
    const BsdfSample& drawn = onward.drawn;
    path.in_view = false;
    path.segment_start = s.leaving_point(onward.direction);
    path.last = {path.segment_start, drawn.pdf, at.samples_lights && !drawn.delta, at.receiver};
    path.ray.origin = leave_surface(s, onward.direction, drawn.transmitted);
    if (at.at.boundary) path.ray.origin += at.at.boundary->clear(drawn.transmitted);
    path.ray.direction = unit(onward.direction);
    path.blends.clear();
}

}  // namespace petzval::integrator
