// SPDX-License-Identifier: Apache-2.0
// Definitions of PathTracer, for code that instantiates it with a ray caster of its own.
#pragma once

#include "core/spectrum/colour.h"
#include "integrator/path/layers.h"
#include "integrator/path/path_steps.h"
#include "integrator/path/sun_discs.h"

namespace petzval::integrator {

template <RayCaster Caster, class Watch>
f4 PathTracer<Caster, Watch>::radiance(const PathStart& start, const Bands& bands,
                                       const Sampler& sampler, FilmSample& out,
                                       PathStats& stats) const {
    PathState path = begun(start, bands, sampler, stats);
    watch_.sees({.step = PathStep::Begins, .ray = start.ray});
    for (;;) {
        // Go to the next surface, or leave the scene.
        const std::optional<Hit> hit = next_hit(path);
        if (!hit) {
            watch_.sees({.step = PathStep::LeavesScene, .ray = path.ray});
            add_background(path, out);
            break;
        }
        Arrival at{make_surface(scene_, path.ray.direction, *hit)};
        const Step step = advance_to_surface(path, at);
        if (step == Step::End) break;
        if (step == Step::GoOn) continue;
        const Surface& s = at.surface;
        ++stats.vertices;

        // Draw a light before the textures are read, so that the wait for them and for the sky's
        // tables is one.
        const V3f wo = -path.ray.direction;
        const auto lookups =
            timed(stats, TimedSection::Texture, [&] { return locate_material(scene_, s); });
        const uint32_t number = path.number();
        const Sampler::VertexNumbers u = sampler.at_vertex(number);
        const LightReceiver receiver = receiver_at(s);
        const std::optional<DrawnLight> light = draw_light(path, receiver, u);
        const ShadingInput shading = timed(stats, TimedSection::Texture, [&] {
            return read_material(scene_, s, lookups, wo, bands,
                                 at.boundary ? at.sides : Fillings::in_air(s));
        });

        // Add light that the ray finds.
        const Blend blend = blend_at(scene_, s, path.ray, path.passed());
        const FoundLight found = emitted(path, s, shading);
        path.radiance +=
            watch_.adds(PathStep::Shines, path.throughput * (found.radiance * blend.weight));
        path.chance_finds().lamps += found.by_chance;
        if (!path.surface_seen && blend.stops()) {
            if (start.fills_layers && !out.hit)
                record_layers({s, shading, to_rgb(found.radiance, bands), wo}, start.ray.origin,
                              bands, out);
            out.alpha = 1.f;
        }
        const auto guides = [&](const auto& albedo) {
            if (start.fills_guide && !out.guide.hit)
                record_guide(s, shading.frame.z, albedo(), start.ray.origin, bands, out.guide);
        };
        const bool at_depth = path.depth >= options_.max_depth;
        if (s.material->unlit || (at_depth && !(s.material->transmission > 0))) {
            guides([&] { return s.material->unlit ? f4{} : shading.scatter(wo, bands).albedo(); });
            if (blend.weight == 1.f) [[likely]] {
                watch_.ends(s.material->unlit ? PathStep::Unlit : PathStep::MaxDepth);
                break;
            }
            go_on_behind(path, s, blend, 0.f);
            continue;
        }

        // Add light that is sampled, unless volumes or black surfaces left nothing to go on with.
        if (!(hmax(path.throughput) >= std::numeric_limits<float>::min())) break;
        const CoatedBsdf bsdf = shading.scatter(wo, bands, path.throughput);
        const bool samples_lights =
            options_.technique != Technique::BsdfOnly && bsdf.has_wide_lobe() && !at_depth;
        const uint32_t alpha_seed =
            path.has_cutouts ? sampler.get_bits(Dim::Coverage, 2 * number + 1) : 0;
        const Scattering scattering{at,       receiver,       shading,    bsdf,
                                    at_depth, samples_lights, alpha_seed, blend.weight};
        path.radiance += watch_.adds(PathStep::Scatters, sampled_light(path, scattering, light));

        // Go on behind a BLEND surface, or scatter there.
        if (blend.weight < 1.f) [[unlikely]] {
            const float chance =
                blend.scattering_chance(at_depth ? 0.f : clamp_unit(hmax(bsdf.albedo())));
            if (!blend.scatters(chance)) {
                go_on_behind(path, s, blend, chance);
                continue;
            }
            path.throughput *= blend.weight / chance;
        }
        path.surface_seen = true;
        if (bsdf.has_wide_lobe()) guides([&] { return bsdf.albedo(); });

        // Scatter, and go on with the chance of what is left.
        const std::optional<Onward> onward = scatter(path, scattering, u);
        if (!onward || !survives(path, u.roulette_after)) break;
        leave(path, scattering, *onward);
    }
    return path.radiance;
}

}  // namespace petzval::integrator
