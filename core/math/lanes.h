// SPDX-License-Identifier: Apache-2.0
// Four floats side by side, and a mask over them: what a sample carries through the scene.
#pragma once

#include <cmath>
#include <cstdint>

namespace petzval {

// Explicit typedefs: g++ 12 drops vector_size from a dependent alias template.
typedef float f4 __attribute__((vector_size(16)));
/// Lane mask. All bits of a lane set (-1): on; all clear (0): off.
typedef int32_t m4 __attribute__((vector_size(16)));

[[nodiscard]] inline f4 splat(float a) {
    return f4{a, a, a, a};
}
[[nodiscard]] inline f4 zero_off(m4 on, f4 a) {
    return (f4)((m4)a & on);
}
[[nodiscard]] inline int lane_count(m4 on) {
    return (on[0] != 0) + (on[1] != 0) + (on[2] != 0) + (on[3] != 0);
}
[[nodiscard]] inline f4 min(f4 a, f4 b) {
    return a < b ? a : b;
}
[[nodiscard]] inline f4 max(f4 a, f4 b) {
    return a > b ? a : b;
}
[[nodiscard]] inline f4 sqrt(f4 a) {
    return f4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
[[nodiscard]] inline float hsum(f4 a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}
/// Largest lane, NaN lanes ignored; NaN if all are.
[[nodiscard]] inline float hmax(f4 a) {
    constexpr float least = -__builtin_inff();
    a = a == a ? a : splat(least);
    const float even = a[0] > a[2] ? a[0] : a[2], odd = a[1] > a[3] ? a[1] : a[3];
    const float most = even > odd ? even : odd;
    return most > least ? most : __builtin_nanf("");
}

}  // namespace petzval
