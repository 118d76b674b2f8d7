// SPDX-License-Identifier: Apache-2.0
// Records that light choice, light sampling and paths exchange.
#pragma once

#include "core/math/lanes.h"
#include "core/math/math.h"

namespace petzval {

/// Surface point for which a light is chosen.
struct LightReceiver {
    V3f p;
    V3f normal;       ///< unit, of the triangle, on the path's side
    bool both_sides;  ///< light from behind counts too: the surface transmits
};

/// Light that arrives at a point, before anything in between is known.
struct LightSample {
    V3f direction{0.f};  ///< unit, from the point to the light
    V3f target{0.f};     ///< end of a shadow ray, clear of the light; meaningless when at_infinity
    bool at_infinity = false;
    f4 radiance{};       ///< for a delta light: the irradiance on a surface that faces it
    float pdf = 0;       ///< 1/sr; 1 for a delta light
    bool delta = false;  ///< a BSDF sample can never find this light
};

}  // namespace petzval
