// SPDX-License-Identifier: Apache-2.0
// Constants of photometry and of sRGB: the luminous efficacy, and the decoding of values.
#pragma once

#include "core/spectrum/bands.h"

namespace petzval {

/// K_m, the largest luminous efficacy of photopic vision, lm/W, near 555 nm: it follows from the
/// 683 lm/W at 540 THz that define the candela (CIE 015:2018). The one number between photometric
/// and radiometric: luminance in nits = 683.002 * integral of ybar(nm) * radiance, W/(m2 sr nm).
inline constexpr float kLuminousEfficacy_lm_per_w = 683.002f;

/// Linear value of an sRGB-encoded one in [0, 1]: IEC 61966-2-1:1999, equation 5 and 6.
[[nodiscard]] inline float srgb_to_linear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace petzval
