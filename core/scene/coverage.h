// SPDX-License-Identifier: Apache-2.0
// Coverage of a surface at a point: glTF's alpha modes.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/math.h"

namespace petzval {

struct Scene;

/// Share of the rays towards the point that stop there, [0, 1]: 1 for OPAQUE, 0 or 1 for MASK,
/// alpha for BLEND.
[[nodiscard]] float coverage(const Scene&, uint32_t instance, uint32_t triangle, V2f barycentric);

/// Number in [0, 1) below which a coverage stops a ray with this seed: a pure function, as the
/// traversal may ask twice for one triangle (spatial splits).
[[nodiscard]] inline float coverage_number(uint32_t seed, uint32_t instance, uint32_t triangle) {
    return to_unit_float(hash32(hash32(seed, instance), triangle));
}

/// Smallest weight that a path gives to a BLEND surface that it meets.
inline constexpr float kLeastMetCoverage = 0.25f;
/// Chance that a path meets a BLEND surface, which then counts coverage / chance: what hardly
/// covers anything is seldom worth its light.
[[nodiscard]] inline float chance_met(float coverage) {
    return std::min(coverage / kLeastMetCoverage, 1.f);
}

}  // namespace petzval
