// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/ray.h"
#include "core/scene/scene.h"

namespace petzval {

/// Barycentric coordinates, weights of the second and third corner, of the point where a ray's line
/// meets a triangle that it hits, in world space. In double and without approximate instructions:
/// the same bits on every processor.
[[nodiscard]] V2f barycentric(const Scene&, uint32_t instance, uint32_t triangle, const Ray&);

}  // namespace petzval
