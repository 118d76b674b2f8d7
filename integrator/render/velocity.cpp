// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/velocity.h"

#include "core/scene/motion.h"

namespace petzval::integrator {

V3f Velocity::at(const Hit& hit, const V2f& film_px) const {
    const auto seen = [&](const Scene& scene, const camera::Shutter* shutter) {
        const V3f p = point_at(scene, hit.instance, hit.triangle, hit.barycentric, hit.time);
        return shutter ? shutter->seen_from_middle(p, hit.time) : V3d(p);
    };
    // What is out of focus lies at another place of the film than the sample's.
    const auto now = projection_.place_of(seen(scene_, shutter_.get()), V2d(film_px));
    if (!now) return V3f(0.f);
    const auto then = projection_.place_of(seen(next_, next_shutter_.get()), *now);
    if (!then) return V3f(0.f);
    return {static_cast<float>(then->x - now->x), static_cast<float>(then->y - now->y), 0.f};
}

}  // namespace petzval::integrator
