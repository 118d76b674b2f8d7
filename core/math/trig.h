// SPDX-License-Identifier: Apache-2.0
// Sine, cosine and arctangent of angles in turns (1 = 360 degrees): short polynomials in place of
// the C library's functions, for speed and so that pixels do not depend on the library's version.
#pragma once

#include "core/math/lanes.h"
#include "core/math/math.h"

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

/// atan2(y, x) in turns, [-0.5, 0.5], lane by lane; 0 for (0, 0). Odd polynomial fitted by Remez
/// exchange; absolute error below 1e-7 turns.
[[nodiscard]] inline f4 atan2_turns(f4 y, f4 x) {
    const m4 sign = m4{} + std::numeric_limits<int32_t>::min();
    const f4 ax = (f4)((m4)x & ~sign), ay = (f4)((m4)y & ~sign);
    const f4 larger = max(ax, ay), smaller = min(ay, ax);
    const f4 a = smaller / (larger > 0.f ? larger : splat(1.f));
    const f4 t = a * a;
    f4 p = t * -0.000746958084f + 0.00385988986f;
    p = p * t - 0.00946755357f;
    p = p * t + 0.0157790872f;
    p = p * t - 0.0223126969f;
    p = p * t + 0.0317828027f;
    p = p * t - 0.0530495109f;
    p = (p * t + 0.159154927f) * a;
    p = ay > ax ? 0.25f - p : p;
    p = x < 0.f ? 0.5f - p : p;
    return (f4)(((m4)p & ~sign) | ((m4)y & sign));
}
[[nodiscard]] inline float atan2_turns(float y, float x) {
    return atan2_turns(splat(y), splat(x))[0];
}

}  // namespace petzval
