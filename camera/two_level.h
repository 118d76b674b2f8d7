// SPDX-License-Identifier: Apache-2.0
// All lanes along one ray, and now and then what that leaves out.
#pragma once

#include "camera/camera.h"
#include "camera/chroma.h"

namespace petzval {

/// Of the numbers that Dim::LensLane has for a sample: the first picks the lane that is solved for.
inline constexpr uint32_t kSplitDraw = 1;

/// With probability p the shared estimate plus (split - shared) / p, else the shared estimate
/// alone: its mean is that of the split one for any p > 0. draw(Chroma) gives the sample of Shared
/// or Split, both from the point's numbers, so that the difference is small. So that paths with
/// nearly the same ray also decide alike on their way, split ones carry all lanes, though only
/// their own weigh.
template <class Draw>
[[nodiscard]] CameraSample two_level(const FilmPoint& point, m4 on, const Draw& draw) {
    const float p = point.split_probability;
    const bool with_difference = p >= 1 || point.sampler.get1(Dim::LensLane, kSplitDraw) < p;
    if (!with_difference) return draw(Chroma::Shared);
    CameraSample out = draw(Chroma::Split);
    for (int k = 0; k < out.count; ++k) {
        CameraPath& path = out.path[static_cast<size_t>(k)];
        path.lanes = on;
        path.weight *= 1 / p;
    }
    if (p >= 1) return out;
    const CameraSample shared = draw(Chroma::Shared);
    for (int k = 0; k < shared.count; ++k) {
        CameraPath& path = out.path[static_cast<size_t>(out.count++)];
        path = shared.path[static_cast<size_t>(k)];
        path.weight *= 1 - 1 / p;
    }
    out.lanes += shared.lanes;
    return out;
}

}  // namespace petzval
