// SPDX-License-Identifier: Apache-2.0
// The volumes that a camera ray begins in. Of those that are not closed, the first face that the
// path meets may say it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/scene/volumes.h"
#include "core/shading/surface.h"

namespace petzval::integrator {

/// Closed volumes that hold a point: those whose surface is left more often than entered on the way
/// from there to infinity. A ray may meet an edge twice or slip through a seam, so that of three
/// directions the two that agree decide, or the middle number.
template <class Caster>
[[nodiscard]] Volumes volumes_at(const Scene& scene, const Caster& caster, const V3f& p,
                                 float time = kMiddleOfShutter) {
    struct Count {
        const Material* material;
        std::array<int, 3> times{};
    };
    std::vector<Count> counts;
    // No directions that models are aligned with.
    const V3f directions[3] = {unit(V3f(0.533f, 0.787f, -0.311f)),
                               unit(V3f(-0.423f, 0.271f, 0.865f)),
                               unit(V3f(0.199f, -0.907f, 0.371f))};
    for (size_t i = 0; i < 3; ++i) {
        Ray ray;
        ray.origin = p;
        ray.direction = directions[i];
        ray.time = time;
        for (const Hit& hit : caster.all_hits(ray)) {
            const Surface s = make_surface(scene, ray.direction, hit);
            if (s.material->priority == 0) continue;
            auto at = counts.begin();
            while (at != counts.end() && at->material != s.material) ++at;
            if (at == counts.end()) at = counts.insert(at, {s.material, {}});
            at->times[i] += s.front ? -1 : 1;
        }
    }
    Volumes out;
    for (Count& c : counts) {
        auto& [a, b, d] = c.times;
        out.add(*c.material, std::max(std::min(a, b), std::min(std::max(a, b), d)));
    }
    return out;
}

}  // namespace petzval::integrator
