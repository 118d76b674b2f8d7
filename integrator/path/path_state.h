// SPDX-License-Identifier: Apache-2.0
// A path under way: what it carries from surface to surface, and where it arrives.
#pragma once

#include <optional>

#include "core/light/light_tree.h"
#include "core/sampling/sampler.h"
#include "core/scene/coverage.h"
#include "core/scene/volumes.h"
#include "core/shading/surface.h"
#include "integrator/path/boundary.h"
#include "integrator/path/stats.h"

namespace petzval::integrator {

/// Last scattering of a path: the ray's origin, and the densities that weigh what the ray finds.
struct Vertex {
    V3f p;
    float pdf = 0;               ///< of the BSDF's direction, 1/sr
    bool light_sampled = false;  ///< next-event estimation could have found what the ray finds
    LightReceiver receiver{};
};

struct PathState {
    const Bands& bands;
    const Sampler& sampler;
    PathStats& stats;
    bool hero_decided;           ///< the ray depends on which lane is the hero
    float continue_probability;  ///< of the next wide scattering
    bool has_cutouts;            ///< of the scene: some surfaces stop only a part of the rays
    bool weighs_blends;          ///< and of these BLEND ones count by their coverage

    Ray ray;  ///< the segment that is next
    f4 throughput;
    Vertex last;
    V3f segment_start;           ///< last.p, or a pane that the path has passed since
    Volumes volumes;             ///< that the segment lies in
    f4 radiance{};               ///< found so far
    PassedBlends blends{};       ///< passed on the segment
    uint32_t blends_passed = 0;  ///< on the whole path
    int scatterings = 0;         ///< of any kind
    int depth = 0;               ///< but at clear glass
    int specular_depth = 0;      ///< at clear glass, and hidden faces that were passed
    bool surface_seen = false;   ///< the camera ray has found a surface that shows itself
    bool in_view = true;         ///< the camera ray has passed nothing but panes and BLEND surfaces
    bool was_rough = false;      ///< some surface was not smooth

    /// BLEND surfaces that the next segment leaves out; nullptr where none is weighed.
    [[nodiscard]] const PassedBlends* passed() const { return weighs_blends ? &blends : nullptr; }
    /// Number of the next surface, for the sampler.
    [[nodiscard]] uint32_t number() const {
        return static_cast<uint32_t>(scatterings) + blends_passed;
    }
    /// Counts of lamps that are found by chance, of paths like this one.
    [[nodiscard]] ChanceFinds& chance_finds() const {
        return was_rough ? stats.caustic : stats.mirrored;
    }
    /// Goes on in the same direction from another place.
    void go_on_from(const V3f& origin) {
        ray.origin = origin;
        blends.t_min = 0.f;
    }
};

/// Where a path arrives.
struct Arrival {
    Surface surface;
    std::optional<Boundary> boundary{};  ///< of surfaces that refract
    Fillings sides{};                    ///< volumes before and behind the surface, or null
};

/// BLEND surface that a path meets: its light counts by its coverage, and chance decides whether
/// the path is scattered there or goes on behind. Any other surface covers all.
struct Blend {
    float alpha = 1;   ///< coverage at the hit
    float weight = 1;  ///< of the surface's light: alpha / chance that the path met it
    float number = 0;  ///< in [0, chance to be met), from the ray's alpha_seed

    /// Whether a ray that is stopped with the chance of alpha stops: layers and the alpha of a
    /// picture are of such. Where a path scatters, it would have stopped.
    [[nodiscard]] bool stops() const { return number < alpha; }
    /// Chance that a path that met the surface scatters there: by the light that does, where as
    /// much arrives from everywhere. Then no path gains weight. reflects: share of light that the
    /// surface scatters, 0 to 1.
    [[nodiscard]] float scattering_chance(float reflects) const {
        const float scattered = weight * reflects;
        return scattered > 0.f ? scattered / (1.f - weight + scattered) : 0.f;
    }
    /// Whether it does, by the number that let the path meet it.
    [[nodiscard]] bool scatters(float chance) const { return number < chance * chance_met(alpha); }
};

/// How a ray that was cast with `passed` meets a surface.
[[nodiscard]] inline Blend blend_at(const Scene& scene, const Surface& s, const Ray& ray,
                                    const PassedBlends* passed) {
    if (!passed) [[likely]]
        return {};
    if (passed->full() || !s.material->weighed()) return {};
    const Hit& h = s.hit;
    const float alpha = coverage(scene, h.instance, h.triangle, h.barycentric);
    return {alpha, alpha / chance_met(alpha),
            coverage_number(ray.alpha_seed, h.instance, h.triangle)};
}

}  // namespace petzval::integrator
