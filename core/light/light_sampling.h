// SPDX-License-Identifier: Apache-2.0
// Samples each kind of light from a point, with the density of the sample.
#pragma once

#include <optional>

#include "core/math/ray.h"
#include "core/scene/light.h"
#include "core/spectrum/bands.h"

namespace petzval {

struct Scene;

/// Light that arrives at a point, before anything in between is known.
struct LightSample {
    V3f direction{0.f};  ///< unit, from the point to the light
    V3f target{0.f};     ///< end of a shadow ray, clear of the light; meaningless when at_infinity
    bool at_infinity = false;
    f4 radiance{};       ///< for a delta light: the irradiance on a surface that faces it
    float pdf = 0;       ///< 1/sr; 1 for a delta light
    bool delta = false;  ///< a BSDF sample can never find this light
};

/// Draws a direction from p to the light at a time; u in [0, 1)^2. Nothing where no light can
/// arrive. A light that has a position is as light_at() has it.
[[nodiscard]] std::optional<LightSample> sample_light(const Scene&, const Light&, const V3f& p,
                                                      V2f u, const Bands&,
                                                      float time = kMiddleOfShutter);
/// Density, 1/sr, with which sample_light draws the direction from p to a point of a triangle light
/// that was hit: the squared distance, and the cosine at the light (its absolute value counts). It
/// is uniform in solid angle where the triangle is wide as p sees it, and by area elsewhere.
[[nodiscard]] float triangle_light_pdf(const Scene&, const TriangleLight&, const V3f& p,
                                       float distance_squared, float cosine,
                                       float time = kMiddleOfShutter);
/// Power for choosing among lights, in lumen up to a common factor.
[[nodiscard]] float light_power(const Scene&, const Light&);

}  // namespace petzval
