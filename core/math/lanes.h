// SPDX-License-Identifier: Apache-2.0
// Four floats side by side, and a mask over them: what a sample carries through the scene. Eight
// of them, and four doubles, for what is traced through a lens.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace petzval {

// Explicit typedefs: g++ 12 drops vector_size from a dependent alias template.
typedef float f4 __attribute__((vector_size(16)));
/// Lane mask. All bits of a lane set (-1): on; all clear (0): off.
typedef int32_t m4 __attribute__((vector_size(16)));
/// Four doubles, and a mask over them.
typedef double d4 __attribute__((vector_size(32)));
typedef int64_t l4 __attribute__((vector_size(32)));
/// Eight floats, a mask over them, and eight words.
typedef float f8 __attribute__((vector_size(32)));
typedef int32_t m8 __attribute__((vector_size(32)));
typedef uint32_t u32x8 __attribute__((vector_size(32)));

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
/// Lane k of each as number k, and the other way round.
[[nodiscard]] inline std::array<f4, 4> transposed(const std::array<f4, 4>& a) {
    const f4 low = __builtin_shufflevector(a[0], a[1], 0, 4, 1, 5),
             low_too = __builtin_shufflevector(a[2], a[3], 0, 4, 1, 5),
             high = __builtin_shufflevector(a[0], a[1], 2, 6, 3, 7),
             high_too = __builtin_shufflevector(a[2], a[3], 2, 6, 3, 7);
    return {__builtin_shufflevector(low, low_too, 0, 1, 4, 5),
            __builtin_shufflevector(low, low_too, 2, 3, 6, 7),
            __builtin_shufflevector(high, high_too, 0, 1, 4, 5),
            __builtin_shufflevector(high, high_too, 2, 3, 6, 7)};
}
/// Four lanes and four more.
[[nodiscard]] inline f8 joined(f4 low, f4 high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
[[nodiscard]] inline f8 splat8(float a) {
    return f8{a, a, a, a, a, a, a, a};
}
[[nodiscard]] inline f8 max(f8 a, f8 b) {
    return a > b ? a : b;
}
[[nodiscard]] inline f8 abs(f8 a) {
    return (f8)((m8)a & 0x7fffffff);
}
[[nodiscard]] inline f8 sqrt(f8 a) {
    f8 root;
    for (int i = 0; i < 8; ++i) root[i] = std::sqrt(a[i]);
    return root;
}
/// Sum of the lanes, always in this order.
[[nodiscard]] inline float hsum(f8 a) {
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
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
