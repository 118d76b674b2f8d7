// SPDX-License-Identifier: Apache-2.0
// Definitions of PathTracer, for code that instantiates it with a ray caster of its own.
#pragma once

#include "core/light/light_sampling.h"
#include "core/light/sun_disc.h"
#include "core/sampling/warp.h"
#include "core/scene/motion.h"
#include "core/shading/surface.h"
#include "core/spectrum/colour.h"
#include "integrator/path/blend.h"
#include "integrator/path/boundary.h"
#include "integrator/path/front_at_back.h"
#include "integrator/path/layers.h"
#include "integrator/path/panes.h"
#include "integrator/path/path.h"
#include "integrator/path/start_volumes.h"

namespace petzval {

/// Last scattering of a path: the ray's origin, and the densities that weigh what the ray finds.
template <RayCaster Caster>
struct PathTracer<Caster>::Vertex {
    V3f p;
    float pdf = 0;               ///< of the BSDF's direction, 1/sr
    bool light_sampled = false;  ///< next-event estimation could have found what the ray finds
    LightReceiver receiver{};
};

/// The light sampler's view of a hit, without textures: position, normal, whether it transmits.
/// Reflected light lies on the surface's own side, whatever the normal map.
[[nodiscard]] inline LightReceiver receiver_at(const Surface& s) {
    return {s.p, s.side, s.material->lets_light_through()};
}

/// Where a path scatters light, and what it has come with.
template <RayCaster Caster>
struct PathTracer<Caster>::Scattering {
    const Surface& surface;
    const Frame& frame;
    const CoatedBsdf& bsdf;
    f4 throughput;
    const Bands& bands;
    uint32_t alpha_seed;       ///< of shadow rays
    Fillings sides;            ///< volumes before and behind the surface, or null
    const Boundary* boundary;  ///< null where the surface does not refract
    int clear_depth_left;
    PathStats& stats;
};

/// Light sample, and how likely its light was picked.
template <RayCaster Caster>
struct PathTracer<Caster>::DrawnLight {
    LightSample sample;  ///< meaningless where dark
    bool dark;           ///< the point that was drawn sends nothing
    float pick_probability;
    uint32_t light;
    V2f u;  ///< what drew the point on the light
    /// Where on the sky, whose radiance and density are looked up when they are needed: many draws
    /// point the wrong way, or are shadowed. Nothing for another light.
    std::optional<Sky::Place> sky;
};

/// Density from which on a scattered direction counts as drawn by a narrow lobe, 1/sr: one of GGX
/// with a roughness below 0.5 or so.
inline constexpr float kNarrowPdf = 1;

/// From here on of the way to a BLEND surface, the ray looks again: with room for rounding. What
/// it did not meet nearer, it does not meet.
inline constexpr float kNearOne = 0.999f;

/// Weight of a sample drawn with density a where b might have drawn it too. Veach 1997, "Robust
/// Monte Carlo Methods for Light Transport Simulation", equation 9.13 with beta = 2.
[[nodiscard]] inline float power_heuristic(float a, float b) {
    if (a <= 0.f) return 0.f;
    const float ratio = b / a;  // the densities may overflow when squared, their ratio hardly can
    return 1.f / (1.f + ratio * ratio);
}

template <RayCaster Caster>
f4 PathTracer<Caster>::visible_background(const Ray& ray, const Bands& bands,
                                          FilmSample& out) const {
    if (options_.transparent) return f4{};
    out.alpha = 1.f;
    if (options_.visible_background) return uplift_radiance(*options_.visible_background, bands);
    return uplift_radiance(scene_.sky.radiance(ray.direction), bands);
}

template <RayCaster Caster>
f4 PathTracer<Caster>::escaped(const Ray& ray, const Bands& bands, const Vertex& last,
                               ChanceFinds& by_chance) const {
    if (scene_.sky.black()) return f4{};
    const Sky::Found found = scene_.sky.find(ray.direction);
    const f4 radiance = uplift_radiance(found.radiance, bands);
    by_chance.lamps += !last.light_sampled && scene_.sky.is_sun(found.radiance);
    if (!last.light_sampled || !(found.pdf > 0.f)) return radiance;
    const auto sky_light = static_cast<uint32_t>(scene_.sky_light);
    const float light_pdf = lights_.probability(sky_light, last.receiver) * found.pdf;
    if (options_.technique == Technique::LightOnly && light_pdf > 0.f) return f4{};
    return radiance * power_heuristic(last.pdf, light_pdf);
}

// Light of the discs of suns that a ray leads to.
template <RayCaster Caster>
f4 PathTracer<Caster>::sun_discs(const Ray& ray, const Bands& bands, const Vertex& last,
                                 bool in_view, ChanceFinds& by_chance) const {
    f4 sum{};
    for (const uint32_t light : scene_.sun_discs) {
        std::optional<Light> moved;
        const auto& sun = std::get<SunLight>(light_at(scene_, light, ray.time, moved));
        if ((in_view && sun.unseen) || !is_in_disc(sun, ray.direction)) continue;
        const f4 radiance =
            uplift_radiance(disc_radiance(sun), bands, scene_.illuminant(sun.illuminant));
        by_chance.lamps += !in_view && !last.light_sampled;
        const float light_pdf =
            last.light_sampled ? lights_.probability(light, last.receiver) * disc_pdf(sun) : 0.f;
        if (options_.technique == Technique::LightOnly && light_pdf > 0.f) continue;
        sum += radiance * (light_pdf > 0.f ? power_heuristic(last.pdf, light_pdf) : 1.f);
    }
    return sum;
}

template <RayCaster Caster>
f4 PathTracer<Caster>::emitted(const Surface& s, Rgb rgb, const Bands& bands,
                               const Vertex& last) const {
    if (!s.material->emits()) return f4{};
    if (!(hmax(rgb.v) > 0.f)) return f4{};
    const f4 radiance = uplift_radiance(rgb, bands, scene_.illuminant(s.material->illuminant));
    if (!last.light_sampled || s.instance->first_light < 0) return radiance;
    const uint32_t light = static_cast<uint32_t>(s.instance->first_light) + s.hit.triangle;
    const V3f along = s.p - last.p;
    const float distance_squared = along.dot(along);
    const float cosine = s.ng.dot(along) / std::sqrt(distance_squared);
    const float light_pdf = lights_.probability(light, last.receiver) *
                            triangle_light_pdf(scene_, {s.hit.instance, s.hit.triangle}, last.p,
                                               distance_squared, std::fabs(cosine), s.hit.time);
    if (options_.technique == Technique::LightOnly && light_pdf > 0.f) return f4{};
    return radiance * power_heuristic(last.pdf, light_pdf);
}

template <RayCaster Caster>
auto PathTracer<Caster>::draw_light(const LightReceiver& receiver, const Sampler::VertexNumbers& u,
                                    const Bands& bands, float time) const
    -> std::optional<DrawnLight> {
    const auto pick = lights_.pick(u.light_point.x, receiver);
    if (!pick) return std::nullopt;
    const V2f u_on_light(left_of_unit(pick->u, pick->probability, u.light_rest), u.light_point.y);
    std::optional<Light> moved;
    const Light& light = light_at(scene_, pick->light, time, moved);
    if (std::holds_alternative<SkyLight>(light)) {
        const Sky::Draw drawn = scene_.sky.sample(u_on_light);
        return DrawnLight{{drawn.direction, V3f(0.f), true, f4{}, 0.f, false},
                          false,
                          pick->probability,
                          pick->light,
                          u_on_light,
                          drawn.place};
    }
    const auto sample = sample_light(scene_, light, receiver.p, u_on_light, bands, time);
    return DrawnLight{
        sample.value_or(LightSample{}), !sample, pick->probability, pick->light, u_on_light, {}};
}

// Light from a point of a lamp on a smooth surface. Seen from the triangle, the point may lie
// before it, and seen from the smooth surface, behind the triangle: rays to the one side leave the
// one point, those to the other side the other, and a point near the triangle's plane is met by
// both.
template <RayCaster Caster>
f4 PathTracer<Caster>::light_on_smooth(const Scattering& at, const DrawnLight& drawn) const {
    const Surface& s = at.surface;
    const V3f facing = s.facing();
    f4 sum{};
    if (!drawn.dark && drawn.sample.direction.dot(facing) > 0.f) sum += direct_light(at, drawn);
    const V3f smooth = s.p + s.lift;
    std::optional<Light> moved;
    const Light& light = light_at(scene_, drawn.light, s.hit.time, moved);
    const auto again = sample_light(scene_, light, smooth, drawn.u, at.bands, s.hit.time);
    if (!again || !(again->direction.dot(facing) < 0.f && again->direction.dot(s.side) > 0.f))
        return sum;
    const DrawnLight from_smooth{*again, false, drawn.pick_probability, drawn.light, drawn.u, {}};
    return sum + direct_light(at, from_smooth);
}

template <RayCaster Caster>
f4 PathTracer<Caster>::direct_light(const Scattering& at, const DrawnLight& drawn) const {
    if (drawn.dark) return f4{};
    const Surface& s = at.surface;
    LightSample light = drawn.sample;
    const BsdfValue value = at.bsdf.eval(at.frame.to_local(light.direction));
    if (value.pdf <= 0.f) return f4{};

    const bool crosses = !(light.direction.dot(s.side) > 0.f);
    WayToLight way{{}, light.target, light.at_infinity};
    way.ray.origin = leave_surface(s, light.direction, crosses);
    if (at.boundary) way.ray.origin += at.boundary->clear(crosses);
    if (light.at_infinity) {
        way.ray.direction = light.direction;
    } else {
        way.ray.direction = light.target - way.ray.origin;
        way.ray.t_max = kOneMinus;  // the target stands clear of the light
    }
    way.ray.alpha_seed = at.alpha_seed;
    way.ray.time = s.hit.time;
    ++at.stats.shadow_rays;
    const Passage passage = [&] {
        const SectionTimer timer(at.stats, TimedSection::Traversal);
        return caster_.passage(way.ray);
    }();
    if (!(passage.left > 0.f)) return f4{};
    const Material* through = crosses ? at.sides.behind : at.sides.before;
    float chance = value.pdf;
    f4 left = uniform(passage.left, at.bands);
    if (passage.panes) {
        const auto panes = through_panes(scene_, caster_, way, at.throughput * value.f_cos, through,
                                         at.clear_depth_left, at.bands, at.stats);
        if (!panes) return f4{};
        left *= panes->value;
        chance *= panes->chance;
    }
    if (drawn.sky) {
        const Sky::Found found = scene_.sky.find(*drawn.sky);
        if (!(found.pdf > 0.f)) return f4{};  // drawn at the very rim of a texel's tent
        light.radiance = uplift_radiance(found.radiance, at.bands);
        light.pdf = found.pdf;
    }
    if (through && !light.at_infinity)
        light.radiance *= transmittance(*through, (light.target - s.p).length(), at.bands);
    const float light_pdf = drawn.pick_probability * light.pdf;
    const float weight = light.delta || options_.technique == Technique::LightOnly
                             ? 1.f
                             : power_heuristic(light_pdf, chance);
    return value.f_cos * light.radiance * left * (weight / light_pdf);
}

template <RayCaster Caster>
f4 PathTracer<Caster>::radiance(const Ray& camera_ray, const Bands& bands, const Sampler& sampler,
                                bool aovs, FilmSample& out, PathStats& stats, m4 lanes, bool led,
                                float rest) const {
    f4 sum{}, throughput = zero_off(lanes, uniform(1.f, bands));
    Ray ray = camera_ray;
    Vertex last{camera_ray.origin};
    V3f from = camera_ray.origin;  // of the segment: `last`, or a pane that it has passed since
    Volumes volumes = start_volumes(scene_, caster_, camera_ray.origin, camera_ray.time);
    bool seen = false;    // the camera ray has found a surface that shows itself
    bool in_view = true;  // the camera ray has passed nothing but panes and BLEND surfaces
    PassedBlends blends;  // passed on the segment
    const bool has_cutouts = caster_.has_cutouts();
    const PassedBlends* const passed = has_cutouts && caster_.has_blends() ? &blends : nullptr;
    uint32_t passed_before = 0;  // in all
    ChanceFinds* by_chance = &stats.mirrored;

    for (int vertex = 0, depth = 0, clear_depth = 0;;) {
        const auto number = static_cast<uint32_t>(vertex) + passed_before;
        // Intersect the ray with the scene. Its seed stays where it goes on behind a BLEND surface:
        // what it does not meet, it does not meet a second time.
        if (has_cutouts)
            ray.alpha_seed = sampler.get_bits(Dim::Coverage, 2 * static_cast<uint32_t>(vertex));
        ++(vertex == 0 ? stats.camera_rays : stats.bounce_rays);
        const std::optional<Hit> hit = [&] {
            const SectionTimer timer(stats, TimedSection::Traversal);
            return caster_.intersect(ray, passed);
        }();
        // Add light from behind the scene where the ray leaves it.
        if (!hit) {
            sum += throughput * (seen ? escaped(ray, bands, last, *by_chance)
                                      : visible_background(ray, bands, out));
            if (!scene_.sun_discs.empty() && (seen || !options_.transparent))
                sum += throughput * sun_discs(ray, bands, last, in_view, *by_chance);
            break;
        }
        Surface s = make_surface(scene_, ray.direction, *hit);
        // Skip backs of single-sided surfaces, which glTF culls from view, and lamps that are not
        // to be seen, these behind panes too. Light must not pass them, so only camera rays do; the
        // inside of a volume is never culled.
        if (culled_from_view(s)) {
            if (const auto front = front_at_back(scene_, caster_, ray, s, passed)) {
                s = *front;
            } else if (!seen || (in_view && s.material->unseen)) {
                ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
                blends.t_min = 0.f;
                continue;
            }
        }
        std::optional<Boundary> boundary;
        if (s.material->refracts()) {
            boundary = boundary_at(scene_, caster_, ray, s, volumes);
            if (boundary->shading) s = *boundary->shading;
        }
        const Material* const medium = volumes.filling();
        if (medium) throughput *= transmittance(*medium, (s.p - from).length(), bands);
        // Go on where nothing changes. Shadow rays do not pass the faces of volumes, so that what
        // the path finds now, they have not found.
        if (boundary && boundary->hidden) {
            if (clear_depth++ == options_.max_clear_depth) {
                ++stats.clear_ends;
                break;
            }
            by_chance->bounces += last.light_sampled;
            last.light_sampled = false;
            volumes = boundary->behind;
            from = s.p;
            ray.origin = leave_surface(s, ray.direction, true) + boundary->clear_onward;
            blends.t_min = 0.f;
            continue;
        }
        const Fillings sides = boundary ? boundary->sides : Fillings{medium, medium};
        ++stats.vertices;
        const V3f wo = -ray.direction;
        const MaterialLookups lookups = [&] {
            const SectionTimer timer(stats, TimedSection::Texture);
            return locate_material(scene_, s);
        }();
        // Sample one light, before the textures are read, so that the wait for them and for the
        // sky's tables is one.
        const Sampler::VertexNumbers u = sampler.at_vertex(number);
        const LightReceiver receiver = receiver_at(s);
        std::optional<DrawnLight> light;
        if (options_.technique != Technique::BsdfOnly)
            light = draw_light(receiver, u, bands, ray.time);
        const ShadingInput shading = [&] {
            const SectionTimer timer(stats, TimedSection::Texture);
            return read_material(scene_, s, lookups, wo, bands,
                                 boundary ? sides : Fillings::in_air(s));
        }();
        // Add light that the ray finds.
        const Blend blend = blend_at(scene_, s, ray, passed);
        const bool shows = s.front || s.material->double_sided;
        f4 glow = emitted(s, shading.emitted, bands, last);
        if (s.material->unlit && shows)
            glow +=
                uplift_radiance(shading.unlit, bands, scene_.illuminant(s.material->illuminant));
        sum += throughput * (glow * blend.weight);
        by_chance->lamps += vertex > 0 && !last.light_sampled && s.instance->first_light >= 0;
        if (!seen && blend.stops()) {
            if (aovs && !out.hit)
                record_layers(s, shading, to_rgb(glow, bands), camera_ray.origin, wo, bands, out);
            out.alpha = 1.f;
        }
        const auto go_on_behind = [&](float scattering_chance) {
            throughput *= (1.f - blend.weight) / (1.f - scattering_chance);
            from = s.p;
            blends.t_min = kNearOne * (s.p - ray.origin).dot(ray.direction);
            blends.add({s.hit.instance, s.hit.triangle, 1.f - blend.alpha});
            ++passed_before;
        };
        const bool at_depth = depth >= options_.max_depth;
        if (s.material->unlit || (at_depth && !(s.material->transmission > 0))) {
            if (blend.weight == 1.f) [[likely]]
                break;
            go_on_behind(0.f);
            continue;
        }

        // Add direct light, unless volumes or black surfaces left nothing to go on with.
        if (!(hmax(throughput) >= std::numeric_limits<float>::min())) break;
        const CoatedBsdf bsdf = shading.scatter(wo, bands, throughput);
        const bool light_sampled =
            options_.technique != Technique::BsdfOnly && bsdf.has_wide_lobe() && !at_depth;
        f4 direct{};
        if (light_sampled && light) {
            const uint32_t alpha_seed =
                has_cutouts ? sampler.get_bits(Dim::Coverage, 2 * number + 1) : 0;
            const Scattering at{s,
                                shading.frame,
                                bsdf,
                                throughput,
                                bands,
                                alpha_seed,
                                sides,
                                boundary ? &*boundary : nullptr,
                                options_.max_clear_depth - clear_depth,
                                stats};
            direct =
                throughput * (s.lifted() && !light->sample.at_infinity ? light_on_smooth(at, *light)
                                                                       : direct_light(at, *light));
        }
        direct *= blend.weight;
        sum += direct;
        if (light_sampled && stats.light_records)
            stats.light_records->push_back(lights_.record(
                light ? std::optional(light->light) : std::nullopt, receiver, hsum(direct)));

        // Go on behind a BLEND surface, or scatter there.
        if (blend.weight < 1.f) [[unlikely]] {
            const float chance =
                blend.scattering_chance(at_depth ? 0.f : clamp_unit(hmax(bsdf.albedo())));
            if (!blend.scatters(chance)) {
                go_on_behind(chance);
                continue;
            }
            throughput *= blend.weight / chance;
        }
        seen = true;

        // Sample the BSDF for the next direction.
        const auto next = bsdf.sample(u.bsdf_lobe, u.bsdf, led);
        if (!next) break;
        const bool is_clear = next->delta && bsdf.is_clear();
        if (is_clear && clear_depth == options_.max_clear_depth) {
            ++stats.clear_ends;
            break;
        }
        if (!is_clear && at_depth) break;
        ++(is_clear ? clear_depth : depth);
        // What is scattered far and wide, ordinary rays find as well. A narrow lobe may be the
        // highlight that the ray was sent for.
        if (rest < 1.f && !next->delta && next->pdf < kNarrowPdf) {
            if (sampler.get1(Dim::TargetRest) >= rest) break;
            throughput *= 1.f / rest;
            rest = 1.f;
        }
        const V3f direction = shading.frame.to_world(next->wi);
        // No ray that is not a number goes on: the film counts the sample and names its pixel.
        if (!std::isfinite(direction.x + direction.y + direction.z))
            return splat(std::numeric_limits<float>::quiet_NaN());
        // Shadow rays go on through panes: what a path finds behind one, they find as well.
        const bool straight = is_clear && next->transmitted && shading.bsdf.thin;
        if (!next->delta)
            by_chance = &stats.caustic;
        else if (!straight || !last.light_sampled)
            ++by_chance->bounces;
        throughput *= next->weight;
        led |= next->transmitted && shading.bsdf.disperses;
        if (next->transmitted && boundary) volumes = boundary->behind;

        // Russian roulette, by what the path has lost.
        ++vertex;
        if (vertex > options_.roulette_depth) {
            const float most = std::sqrt(hmax(throughput)), survival = most < 1.f ? most : 1.f;
            if (u.roulette_after >= survival) break;
            throughput *= 1.f / survival;
        }
        // Continue the path.
        if (straight) {
            from = s.p;
            last.pdf *= bsdf.straight_through().chance;
            ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
            blends.t_min = 0.f;
            continue;
        }
        in_view = false;
        from = s.leaving_point(direction);
        last = {from, next->pdf, light_sampled && !next->delta, receiver};
        ray.origin = leave_surface(s, direction, next->transmitted);
        if (boundary) ray.origin += boundary->clear(next->transmitted);
        ray.direction = unit(direction);
        blends.clear();
    }
    return sum;
}

}  // namespace petzval
