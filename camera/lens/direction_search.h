// SPDX-License-Identifier: Apache-2.0
// Search for the direction in which a ray must leave the film to get somewhere: Newton's method on
// traced derivatives, for eight rays at once.
#pragma once

#include "camera/lens/number.h"

namespace petzval::camera {

/// Newton step from a direction, lane by lane.
struct DirectionStep {
    f8 l, m;     ///< direction cosines to add
    m8 reached;  ///< lanes whose ray got far enough for the step to mean something
    m8 there;    ///< lanes whose ray is as near as is asked for
};

/// Directions that were found, lane by lane.
struct FoundDirections {
    f8 l, m;      ///< direction cosines at the film
    m8 found{};   ///< lanes in which the search ended well
    m8 traces{};  ///< needed to find it
};

/// Directions by Newton's method from a guess: half the step where it leads to where rays get lost.
/// Lanes that are found stay where they are while others go on; those that are not wanted are not
/// looked for. most_left: largest step that may be left where a ray is near enough. step_at(l, m):
/// DirectionStep; called last with what is found.
template <class StepAt>
[[nodiscard]] FoundDirections find_directions(m8 wanted, f8 l, f8 m, float most_left,
                                              const StepAt& step_at) {
    // Newton step that floats hardly resolve: a ray to a point far smaller than the lens comes no
    // nearer.
    constexpr float kLeastStep = 1e-6f;
    constexpr int kMostSteps = 12, kMostHalvings = 6;
    FoundDirections out;
    f8 good_l = l, good_m = m, step_l{}, step_m{};
    m8 left = wanted, halvings{};
    for (int i = 0; i < kMostSteps; ++i) {
        const DirectionStep by = step_at(l, m);
        good_l = by.reached ? l : good_l, good_m = by.reached ? m : good_m;
        step_l = by.reached ? by.l : 0.5f * step_l, step_m = by.reached ? by.m : 0.5f * step_m;
        const f8 most = by.there ? splat8(most_left) : splat8(kLeastStep);
        const m8 done = left & by.reached & (step_l * step_l + step_m * step_m < most * most);
        out.found |= done;
        out.traces = done ? m8{} + (i + 1) : out.traces;
        halvings -= ~by.reached;
        left &= ~done & (by.reached | (i > 0 ? halvings <= kMostHalvings : m8{}));
        if (!any(left)) break;
        l = left ? good_l + step_l : l, m = left ? good_m + step_m : m;
    }
    out.l = l, out.m = m;
    return out;
}

}  // namespace petzval::camera
