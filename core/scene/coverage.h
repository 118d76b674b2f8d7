// SPDX-License-Identifier: Apache-2.0
// Coverage of a surface at a point: glTF's alpha modes.
#pragma once

#include <cstdint>

#include "core/math/math.h"

namespace petzval {

struct Scene;

/// Share of the rays towards the point that stop there, [0, 1]: 1 for OPAQUE, 0 or 1 for MASK,
/// alpha for BLEND.
[[nodiscard]] float coverage(const Scene&, uint32_t instance, uint32_t triangle, V2f barycentric);

}  // namespace petzval
