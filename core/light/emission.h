// SPDX-License-Identifier: Apache-2.0
// Emitted radiance at a point of a triangle: the same for a ray that hits it and for a light sample
// that picks it.
#pragma once

#include "core/math/math.h"
#include "core/spectrum/bands.h"

namespace petzval {

struct Scene;
struct Illuminant;

/// Emitted radiance, nits, towards every direction on the front side, and on the back side where
/// the material is double-sided; of a beam, along its axis. barycentric: weights of the second and
/// third vertex. Materials with KHR_materials_unlit emit nothing here.
[[nodiscard]] Rgb emitted_radiance(const Scene&, uint32_t instance, uint32_t triangle,
                                   V2f barycentric, bool front);

/// Share of emitted_radiance that comes through the material's clear coat, at a cosine to the
/// triangle; 1 where it has none.
[[nodiscard]] float share_past_coat(const Scene&, uint32_t instance, uint32_t triangle,
                                    V2f barycentric, float cosine);

/// White point of an instance's emission; nullptr: the scene's own.
[[nodiscard]] const Illuminant* white_of(const Scene&, uint32_t instance);

}  // namespace petzval
