// SPDX-License-Identifier: Apache-2.0
// Vectors (Imath's), frames, and the offset that keeps a ray from hitting the surface it leaves.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace petzval {

using V2f = Imath::V2f;
using V3f = Imath::V3f;
using V4f = Imath::V4f;
using V2d = Imath::V2d;
using V3d = Imath::V3d;
using V2i = Imath::V2i;
using M33f = Imath::M33f;
/// Imath's convention: row vectors, point * matrix; the translation is the last row.
using M44f = Imath::M44f;
using M44d = Imath::M44d;
using Box3f = Imath::Box3f;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kDegree_rad = kPi / 180.f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Largest float below 1: the top of every half-open unit interval.
inline constexpr float kOneMinus = 0x1.fffffep-1f;

[[nodiscard]] inline float sqr(float a) {
    return a * a;
}
[[nodiscard]] inline float lerp(float a, float b, float t) {
    return a + (b - a) * t;
}
[[nodiscard]] inline float safe_sqrt(float a) {
    return std::sqrt(a > 0.f ? a : 0.f);
}
/// a within [0, 1]; 0 where a is not a number.
[[nodiscard]] inline float clamp_unit(float a) {
    a = a > 0.f ? a : 0.f;
    return a < 1.f ? a : 1.f;
}
/// Whether every component of a vector is finite.
template <class Vector>
[[nodiscard]] bool is_finite(const Vector& v) {
    for (unsigned k = 0; k < Vector::dimensions(); ++k)
        if (!std::isfinite(v[static_cast<int>(k)])) return false;
    return true;
}
/// Unit vector along v; v must not be zero.
[[nodiscard]] inline V3f unit(const V3f& v) {
    return v * (1.f / std::sqrt(v.dot(v)));
}
[[nodiscard]] inline V3f abs(const V3f& v) {
    return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}
/// Upper left 3x3 part of a matrix: how it moves directions.
template <class T>
[[nodiscard]] Imath::Matrix33<T> linear_part(const Imath::Matrix44<T>& m) {
    return {m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2]};
}
[[nodiscard]] inline V3f reflect(const V3f& w, const V3f& about) {
    return about * (2.f * w.dot(about)) - w;
}

[[nodiscard]] inline V3f transform_direction(const V3f& v, const M44f& m) {
    V3f out;
    m.multDirMatrix(v, out);
    return out;
}

/// Orthonormal right-handed frame; z is the normal where a surface is meant.
struct Frame {
    V3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    /// Frame about a unit z. Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    [[nodiscard]] static Frame about(const V3f& z) {
        const float sign = std::copysign(1.f, z.z);
        const float a = -1.f / (sign + z.z);
        const float b = z.x * z.y * a;
        return {
            {1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
    }
    /// Frame about a unit z whose x is the part of `along` across z; any frame where there is none.
    [[nodiscard]] static Frame about(const V3f& z, const V3f& along) {
        const V3f across = along - z * along.dot(z);
        if (!(across.dot(across) > 1e-12f)) return about(z);
        const V3f x = unit(across);
        return {x, z.cross(x), z};
    }
    [[nodiscard]] V3f to_local(const V3f& w) const { return {w.dot(x), w.dot(y), w.dot(z)}; }
    [[nodiscard]] V3f to_world(const V3f& w) const { return x * w.x + y * w.y + z * w.z; }
};

/// Bound on the relative error of n float operations: Higham 2002, "Accuracy and Stability of
/// Numerical Algorithms", equation 3.1.
[[nodiscard]] constexpr float rounding_bound(int n) {
    constexpr float half_ulp = std::numeric_limits<float>::epsilon() / 2;
    return n * half_ulp / (1 - n * half_ulp);
}

/// The neighbouring float above a (up) or below: std::nextafter without the call. a must be finite.
[[nodiscard]] inline float neighbour(float a, bool up) {
    const auto bits = std::bit_cast<int32_t>(a);
    const int32_t outwards = (bits >= 0) == up ? 1 : -1;
    // Either zero counts as one of the side that is wanted.
    return std::bit_cast<float>(a == 0.f ? (up ? 1 : std::numeric_limits<int32_t>::min() + 1)
                                         : bits + outwards);
}

/// Origin of a ray that leaves p towards w: outside the box of half-widths p_error about p,
/// measured along the geometric normal. Pharr et al. 2023, "Physically Based Rendering", 6.8.6.
[[nodiscard]] inline V3f offset_origin(const V3f& p, const V3f& p_error, const V3f& normal,
                                       const V3f& w) {
    const float distance = abs(normal).dot(p_error);
    const V3f offset = w.dot(normal) < 0.f ? normal * -distance : normal * distance;
    V3f moved = p + offset;
    for (int i = 0; i < 3; ++i) {  // rounding must not carry the point back
        const float next = neighbour(moved[i], offset[i] > 0.f);
        moved[i] = offset[i] != 0.f ? next : moved[i];
    }
    return moved;
}

/// Finaliser of MurmurHash3 (Appleby 2011, public domain): a bijection of 32 bits that mixes well.
/// Word: uint32_t, or several of them side by side.
template <class Word>
[[nodiscard]] constexpr Word hash_words(Word a) {
    a ^= a >> 16;
    a *= 0x85ebca6bu;
    a ^= a >> 13;
    a *= 0xc2b2ae35u;
    return a ^ (a >> 16);
}
[[nodiscard]] constexpr uint32_t hash32(uint32_t a) {
    return hash_words(a);
}
[[nodiscard]] constexpr uint32_t hash32(uint32_t a, uint32_t b) {
    return hash32(a ^ (hash32(b + 0x9e3779b9u)));
}
/// Upper 24 bits of a word as a float in [0, 1).
[[nodiscard]] constexpr float to_unit_float(uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

}  // namespace petzval
