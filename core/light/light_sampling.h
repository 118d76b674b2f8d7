// SPDX-License-Identifier: Apache-2.0
// Samples each kind of light from a point, with the density of the sample.
#pragma once

#include <optional>

#include "core/light/light_sample.h"
#include "core/math/ray.h"
#include "core/scene/light.h"
#include "core/spectrum/bands.h"

namespace petzval {

struct Scene;

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
/// Emitted radiance at a point of a triangle, the same for a ray that hits it and for a light
/// sample that picks it: nits, towards every direction on the front side, and on the back side
/// where the material is double-sided; of a beam, along its axis. barycentric: weights of the
/// second and third vertex. Materials with KHR_materials_unlit emit nothing here.
[[nodiscard]] Rgb emitted_radiance(const Scene&, uint32_t instance, uint32_t triangle,
                                   V2f barycentric, bool front);

/// Share of emitted_radiance that comes through the material's clear coat, at a cosine to the
/// triangle; 1 where it has none.
[[nodiscard]] float share_past_coat(const Scene&, uint32_t instance, uint32_t triangle,
                                    V2f barycentric, float cosine);

/// Power for choosing among lights, in lumen up to a common factor.
[[nodiscard]] float light_power(const Scene&, const Light&);

}  // namespace petzval
