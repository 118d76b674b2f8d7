// SPDX-License-Identifier: Apache-2.0
// Light that a path samples (next-event estimation): one light for each surface, a point on it, and
// what comes from there.
#pragma once

#include "core/sampling/warp.h"
#include "core/scene/motion.h"
#include "integrator/path/found_light.h"
#include "integrator/path/panes.h"

namespace petzval::integrator {

/// The light sampler's view of a hit, without textures: position, normal, whether it transmits.
/// Reflected light lies on the surface's own side, whatever the normal map.
[[nodiscard]] inline LightReceiver receiver_at(const Surface& s) {
    return {s.p, s.side, s.material->lets_light_through()};
}

/// Where a path scatters light, and what it has come with.
template <RayCaster Caster, class Watch>
struct PathTracer<Caster, Watch>::Scattering {
    const Arrival& at;
    const LightReceiver& receiver;
    const ShadingInput& shading;
    const CoatedBsdf& bsdf;
    bool at_depth;        ///< only what is clear goes on
    bool samples_lights;  ///< next-event estimation helps here
    uint32_t alpha_seed;  ///< of shadow rays
    float blend_weight;   ///< of the surface's light
};

/// Light sample, and how likely its light was picked.
template <RayCaster Caster, class Watch>
struct PathTracer<Caster, Watch>::DrawnLight {
    LightSample sample;  ///< meaningless where dark
    bool dark;           ///< the point that was drawn sends nothing
    float pick_probability;
    uint32_t light;
    V2f u;  ///< what drew the point on the light
    /// Where on the sky, whose radiance and density are looked up when they are needed: many draws
    /// point the wrong way, or are shadowed. Nothing for another light.
    std::optional<Sky::Place> sky;
};

template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline auto PathTracer<Caster, Watch>::draw_light(
    const PathState& path, const LightReceiver& receiver, const Sampler::VertexNumbers& u) const
    -> std::optional<DrawnLight> {
    if (options_.technique == Technique::BsdfOnly) return std::nullopt;
    const auto pick = lights_.pick(u.light_point.x, receiver);
    if (!pick) return std::nullopt;
    const V2f u_on_light(left_of_unit(pick->u, pick->probability, u.light_rest), u.light_point.y);
    std::optional<Light> moved;
    const Light& light = light_at(scene_, pick->light, path.ray.time, moved);
    if (std::holds_alternative<SkyLight>(light)) {
        const Sky::Draw drawn = scene_.sky.sample(u_on_light);
        return DrawnLight{{drawn.direction, V3f(0.f), true, f4{}, 0.f, false},
                          false,
                          pick->probability,
                          pick->light,
                          u_on_light,
                          drawn.place};
    }
    const auto sample =
        sample_light(scene_, light, receiver.p, u_on_light, path.bands, path.ray.time);
    return DrawnLight{
        sample.value_or(LightSample{}), !sample, pick->probability, pick->light, u_on_light, {}};
}

/// Light of the lamp that was drawn, if any, as it reaches the camera ray.
template <RayCaster Caster, class Watch>
[[gnu::always_inline]] inline f4 PathTracer<Caster, Watch>::sampled_light(
    const PathState& path, const Scattering& at, const std::optional<DrawnLight>& drawn) const {
    f4 light{};
    if (!at.samples_lights) return light;
    if (drawn) watch_.sees({.step = PathStep::DrawsLight, .light = drawn->light});
    if (drawn)
        light = path.throughput * (at.at.surface.lifted() && !drawn->sample.at_infinity
                                       ? light_on_smooth(path, at, *drawn)
                                       : direct_light(path, at, *drawn));
    light *= at.blend_weight;
    watch_.sampled(lights_, drawn ? std::optional(drawn->light) : std::nullopt, at.receiver, light);
    return light;
}

// Light from a point of a lamp on a smooth surface, which stands above its triangles (Hanika 2021,
// "Hacking the Shadow Terminator"). Seen from the triangle, the point may lie before it, and seen
// from the smooth surface, behind the triangle: rays to the one side leave the one point, those to
// the other side the other, and a point near the triangle's plane is met by both.
template <RayCaster Caster, class Watch>
f4 PathTracer<Caster, Watch>::light_on_smooth(const PathState& path, const Scattering& at,
                                              const DrawnLight& drawn) const {
    const Surface& s = at.at.surface;
    const V3f facing = s.facing();
    f4 sum{};
    if (!drawn.dark && drawn.sample.direction.dot(facing) > 0.f)
        sum += direct_light(path, at, drawn);
    const V3f smooth = s.p + s.lift;
    std::optional<Light> moved;
    const Light& light = light_at(scene_, drawn.light, s.hit.time, moved);
    const auto again = sample_light(scene_, light, smooth, drawn.u, path.bands, s.hit.time);
    if (!again || !(again->direction.dot(facing) < 0.f && again->direction.dot(s.side) > 0.f))
        return sum;
    const DrawnLight from_smooth{*again, false, drawn.pick_probability, drawn.light, drawn.u, {}};
    return sum + direct_light(path, at, from_smooth);
}

template <RayCaster Caster, class Watch>
f4 PathTracer<Caster, Watch>::direct_light(const PathState& path, const Scattering& at,
                                           const DrawnLight& drawn) const {
    if (drawn.dark) return f4{};
    const Surface& s = at.at.surface;
    LightSample light = drawn.sample;
    const BsdfValue value = at.bsdf.eval(at.shading.frame.to_local(light.direction));
    if (value.pdf <= 0.f) return f4{};

    const bool crosses = !(light.direction.dot(s.side) > 0.f);
    const Material* const through = crosses ? at.at.sides.behind : at.at.sides.before;
    WayToLight way{{},
                   light.target,
                   light.at_infinity,
                   through,
                   options_.max_specular_depth - path.specular_depth};
    way.ray.origin = leave_surface(s, light.direction, crosses);
    if (at.at.boundary) way.ray.origin += at.at.boundary->clear(crosses);
    if (light.at_infinity) {
        way.ray.direction = light.direction;
    } else {
        way.ray.direction = light.target - way.ray.origin;
        way.ray.t_max = kOneMinus;  // the target stands clear of the light
    }
    way.ray.alpha_seed = at.alpha_seed;
    way.ray.time = s.hit.time;
    ++path.stats.shadow_rays;
    const Passage passage =
        timed(path.stats, TimedSection::Traversal, [&] { return caster_.passage(way.ray); });
    watch_.sees({.step = PathStep::ShadowRay, .number = passage.left, .ray = way.ray});
    if (!(passage.left > 0.f)) return f4{};
    float chance = value.pdf;
    f4 left = uniform(passage.left, path.bands);
    if (passage.panes) {
        const auto panes = through_panes(scene_, caster_, way, path.throughput * value.f_cos,
                                         path.bands, path.stats);
        if (!panes) return f4{};
        left *= panes->value;
        chance *= panes->chance;
    }
    if (drawn.sky) {
        const Sky::Found found = scene_.sky.find(*drawn.sky);
        if (!(found.pdf > 0.f)) return f4{};  // drawn at the very rim of a texel's tent
        light.radiance = uplift_radiance(found.radiance, path.bands);
        light.pdf = found.pdf;
    }
    if (through && !light.at_infinity)
        light.radiance *= transmittance(*through, (light.target - s.p).length(), path.bands);
    const float light_pdf = drawn.pick_probability * light.pdf;
    const float weight = light.delta || options_.technique == Technique::LightOnly
                             ? 1.f
                             : power_heuristic(light_pdf, chance);
    return value.f_cos * light.radiance * left * (weight / light_pdf);
}

}  // namespace petzval::integrator
