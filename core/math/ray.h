// SPDX-License-Identifier: Apache-2.0
// A ray and what it hits: the records that bvh, camera and integrator exchange.
#pragma once

#include "core/math/math.h"
#include "core/math/steps.h"

namespace petzval {

struct Ray {
    V3f origin;
    V3f direction;  ///< unit length for rays that measure distance; t counts in its length
    float t_max = kInfinity;
    /// Seed of BLEND coverage: the same seed and triangle give the same answer.
    uint32_t alpha_seed = 0;
    float time = kMiddleOfShutter;  ///< core/math/steps.h
};

/// A triangle hit, as the traversal reports it; Surface (core/shading/surface.h) has the rest.
struct Hit {
    V2f barycentric;  ///< weights of the second and third vertex
    uint32_t instance, triangle;
    float time = kMiddleOfShutter;  ///< of the ray
};

}  // namespace petzval
