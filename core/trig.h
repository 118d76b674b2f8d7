// SPDX-License-Identifier: Apache-2.0
// Angles in turns (1 = 360 degrees): short polynomials in place of the C library's functions, for
// speed and so that pixels do not depend on the library's version.
#pragma once

#include "core/math.h"

namespace petzval {

struct SinCos {
    float sine, cosine;
};

/// Sine and cosine of an angle of a quarter turn * x, |x| <= 1/2. The polynomials are fitted by
/// Remez exchange; relative error below 1.5e-7.
[[nodiscard]] inline SinCos sincos_of_eighth(float x) {
    const float t = x * x;
    const float s = ((-0.00460165789f * t + 0.0796800328f) * t - 0.645963460f) * t + 1.57079632f;
    const float c = ((-0.0203985818f * t + 0.253594947f) * t - 1.23369666f) * t + 0.999999967f;
    return {x * s, c};
}

/// Sine and cosine of an angle in turns, |turns| < 2^20. Absolute error below 2e-7 within a turn.
[[nodiscard]] inline SinCos sincos_turns(float turns) {
    const float quarters = std::floor(4.f * turns + 0.5f);
    const auto quadrant = static_cast<int32_t>(quarters);
    const SinCos a = sincos_of_eighth(4.f * turns - quarters);
    const bool swap = (quadrant & 1) != 0;
    const float sine = swap ? a.cosine : a.sine, cosine = swap ? a.sine : a.cosine;
    return {(quadrant & 2) != 0 ? -sine : sine, ((quadrant + 1) & 2) != 0 ? -cosine : cosine};
}

/// atan2(y, x) in turns, [-0.5, 0.5]; 0 for (0, 0). Odd polynomial fitted by Remez exchange;
/// absolute error below 1e-7 turns.
[[nodiscard]] inline float atan2_turns(float y, float x) {
    const float ax = std::fabs(x), ay = std::fabs(y);
    const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
    const float a = smaller / (larger > 0.f ? larger : 1.f);
    const float t = a * a;
    float p = -0.000746958084f;
    p = p * t + 0.00385988986f;
    p = p * t - 0.00946755357f;
    p = p * t + 0.0157790872f;
    p = p * t - 0.0223126969f;
    p = p * t + 0.0317828027f;
    p = p * t - 0.0530495109f;
    p = (p * t + 0.159154927f) * a;
    p = ay > ax ? 0.25f - p : p;
    p = x < 0.f ? 0.5f - p : p;
    return std::copysign(p, y);
}

}  // namespace petzval
