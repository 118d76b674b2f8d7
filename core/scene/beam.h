// SPDX-License-Identifier: Apache-2.0
// Directions that a spot light shines in.
#pragma once

#include <algorithm>

#include "core/math/math.h"

namespace petzval {

/// The two cones of a spot light: KHR_lights_punctual, "Inner and Outer Cone Angles".
struct Beam {
    V3f direction;  ///< unit, the way the light shines
    float cos_inner, cos_outer;

    /// Difference of the cosines, as it is used: narrow cones are widened.
    [[nodiscard]] float width() const { return std::max(0.001f, cos_inner - cos_outer); }
    /// Share of the intensity along the axis in a direction, given its cosine to the axis.
    [[nodiscard]] float falloff(float cosine) const {
        return sqr(std::clamp((cosine - cos_outer) / width(), 0.f, 1.f));
    }
};

}  // namespace petzval
