// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/meshopt_filters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace petzval::io {
namespace {

/// Replaces each N values of type T by f(values).
template <class T, size_t N, class F>
void each(std::span<uint8_t> elements, F f) {
    std::array<T, N> values;
    for (size_t at = 0; at + sizeof values <= elements.size(); at += sizeof values) {
        std::memcpy(values.data(), &elements[at], sizeof values);
        f(values);
        std::memcpy(&elements[at], values.data(), sizeof values);
    }
}

/// The nearest integer, of which the low bits are kept: what valid data cannot reach is
/// unspecified.
template <class T>
T to_integer(float value) {
    return static_cast<T>(std::lrintf(value));
}

template <class T>
void octahedral(std::span<uint8_t> elements) {
    each<T, 4>(elements, [](std::array<T, 4>& v) {
        float x = v[0], y = v[1];
        const float z = v[2] - (std::fabs(x) + std::fabs(y));
        const float behind = std::min(z, 0.f);
        x += std::copysign(behind, -x);
        y += std::copysign(behind, -y);
        const float length = std::sqrt(x * x + (y * y + z * z));
        if (length == 0.f) return;
        const float scale = float(std::numeric_limits<T>::max()) / length;
        v[0] = to_integer<T>(x * scale);
        v[1] = to_integer<T>(y * scale);
        v[2] = to_integer<T>(z * scale);
    });
}

/// T: unsigned, of the size of a component.
template <class T>
void color(std::span<uint8_t> elements) {
    using Signed = std::make_signed_t<T>;
    each<T, 4>(elements, [](std::array<T, 4>& v) {
        const int greatest = (1 << std::bit_width(v[3])) - 1;
        if (greatest == 0) return;
        const int y = v[0], co = Signed(v[1]), cg = Signed(v[2]);
        const int alpha = v[3] & greatest >> 1;
        const float scale = float(std::numeric_limits<T>::max()) / float(greatest);
        const std::array<int, 4> rgba = {y + co - cg, y + cg, y - co - cg,
                                         alpha << 1 | (alpha & 1)};
        for (size_t k = 0; k < 4; ++k) v[k] = to_integer<T>(float(rgba[k]) * scale);
    });
}

}  // namespace

void filter_octahedral_8(std::span<uint8_t> elements) {
    octahedral<int8_t>(elements);
}

void filter_octahedral_16(std::span<uint8_t> elements) {
    octahedral<int16_t>(elements);
}

void filter_quaternion(std::span<uint8_t> elements) {
    each<int16_t, 4>(elements, [](std::array<int16_t, 4>& q) {
        constexpr float root_half = 0.70710678f;  // the most that a smaller component can be
        const float scale = root_half / static_cast<float>(q[3] | 3);
        const float x = q[0] * scale, y = q[1] * scale, z = q[2] * scale;
        const float w = std::sqrt(std::max(1.f - (x * x + (y * y + z * z)), 0.f));
        const size_t greatest = q[3] & 3;
        const std::array<float, 4> from_greatest = {w, x, y, z};
        for (size_t k = 0; k < 4; ++k)
            q[(greatest + k) % 4] = to_integer<int16_t>(from_greatest[k] * 32767.f);
    });
}

void filter_exponential(std::span<uint8_t> elements) {
    each<int32_t, 1>(elements, [](std::array<int32_t, 1>& v) {
        const int exponent = v[0] >> 24;
        const int mantissa = int32_t(uint32_t(v[0]) << 8) >> 8;
        const float value = std::ldexp(static_cast<float>(mantissa), exponent);
        std::memcpy(v.data(), &value, sizeof value);
    });
}

void filter_color_8(std::span<uint8_t> elements) {
    color<uint8_t>(elements);
}

void filter_color_16(std::span<uint8_t> elements) {
    color<uint16_t>(elements);
}

}  // namespace petzval::io
