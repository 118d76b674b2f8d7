// SPDX-License-Identifier: Apache-2.0
// What a path does where it meets a BLEND surface: the surface's light counts by its coverage, and
// chance decides whether the path is scattered there or goes on behind.
#pragma once

#include "core/scene/coverage.h"
#include "core/shading/surface.h"

namespace petzval {

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

}  // namespace petzval
