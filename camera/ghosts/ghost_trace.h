// SPDX-License-Identifier: Apache-2.0
// Trace of a ghost: light that two surfaces of a lens reflect on its way to the film.
#pragma once

#include "camera/lens/trace.h"

namespace petzval::camera {

/// Two surfaces that reflect light on its way to the film: `first`, then `second`, which lies
/// before it.
struct GhostPair {
    int first = 0, second = 0;
    bool operator==(const GhostPair&) const = default;
};

/// What a ghost's ray does at a surface.
struct GhostStep {
    LensPassage passage;  ///< that the surface is part of
    bool mirrors;
};

namespace ghost_trace {

/// Reflects a ray at one surface: refraction into a medium of the opposite index gives the
/// direction, turned round (Welford 1986, Aberrations of Optical Systems, 4.3).
template <class N, class Observer>
void reflect(const LensPassage& at, const LensIndices<N>& indices, LensRay<N>& ray,
             const Observer& observe) {
    const auto& s = at.lens.surfaces<ScalarOf<N>>()[size_t(at.begin())];
    const int from = at.to_film() ? s.medium_before : s.medium_after;
    const int into = at.to_film() ? s.medium_after : s.medium_before;
    LensIndices<N> mirror;  // of these two media alone
    mirror.of_medium[from] = indices.of_medium[from];
    mirror.of_medium[into] = -indices.of_medium[from];
    static_cast<void>(trace_lens<N>(at, mirror, ray, observe));
    ray.direction = ray.direction * broadcast<N>(-1);
}

}  // namespace ghost_trace

/// Traces a ghost's ray through the whole lens, either way; the surfaces of the pair must change
/// the medium. Returns the lanes that passed. The observer is called with each LensHit and its
/// GhostStep.
template <class N, class Observer>
[[nodiscard]] MaskOf<N> trace_ghost(const Lens& lens, GhostPair pair, Towards towards, Clip clip,
                                    const LensIndices<N>& indices, LensRay<N>& ray,
                                    const Observer& observe) {
    const bool to_film = towards == Towards::Film;
    const Towards back = to_film ? Towards::Scene : Towards::Film;
    const int near = to_film ? pair.first : pair.second, far = to_film ? pair.second : pair.first;
    const auto pass = [&](Towards way, SurfaceRange range) {
        const LensPassage through{lens, way, range, clip};
        return any(trace_lens<N>(through, indices, ray, [&](const auto& hit) {
            observe(hit, {through, false});
        }));
    };
    const auto mirror = [&](Towards way, int surface) {
        const LensPassage at{lens, way, {surface, surface}, clip};
        ghost_trace::reflect<N>(at, indices, ray, [&](const auto& hit) {
            observe(hit, {at, true});
        });
        return any(ray.alive());
    };
    const SurfaceRange before_first{0, pair.first - 1}, behind_second{pair.second + 1, lens.last()},
        between{pair.second + 1, pair.first - 1};
    static_cast<void>(pass(towards, to_film ? before_first : behind_second) &&
                      mirror(towards, near) && pass(back, between) && mirror(back, far) &&
                      pass(towards, to_film ? behind_second : before_first));
    return ray.alive();
}

}  // namespace petzval::camera
