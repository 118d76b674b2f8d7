// SPDX-License-Identifier: Apache-2.0
// What a point of a triangle gives off, and how much of it is there: the same answer for a ray that
// hits it and for a light sample that picks it.
#pragma once

#include "core/scene.h"

namespace petzval {

// A point of a triangle is named as the traversal does it: barycentric holds the weights of the
// second and third vertex.

/// Texture coordinates; (0, 0) where the mesh has none.
[[nodiscard]] V2f uv_at(const Mesh&, uint32_t triangle, V2f barycentric, int uv_set);

/// Nits towards every direction of the front side, and of the back side where the material is
/// double-sided. Materials with KHR_materials_unlit emit nothing here.
[[nodiscard]] Rgb emitted_radiance(const Scene&, uint32_t instance, uint32_t triangle,
                                   V2f barycentric, bool front);

/// Share of the point that is covered, [0, 1]: 1 for OPAQUE, 0 or 1 for MASK, alpha for BLEND.
[[nodiscard]] float coverage(const Scene&, uint32_t instance, uint32_t triangle, V2f barycentric);

}  // namespace petzval
