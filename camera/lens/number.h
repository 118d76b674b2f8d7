// SPDX-License-Identifier: Apache-2.0
// Number types of a ray through a lens: one float, four or eight floats, four doubles, and any of
// these with two derivatives. One trace serves them all.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/math/lanes.h"

namespace petzval::camera {

/// Types that go with a number. Scalar: of constants. Value: the number without derivatives. Mask:
/// the result of comparing. Code: an integer for each lane.
template <class N>
struct NumberTraits;
template <class S, class V, class M, class C, int n>
struct TraitsOf {
    using Scalar = S;
    using Value = V;
    using Mask = M;
    using Code = C;
    static constexpr int lanes = n;
};
template <>
struct NumberTraits<float> : TraitsOf<float, float, bool, int32_t, 1> {};
template <>
struct NumberTraits<f4> : TraitsOf<float, f4, m4, m4, 4> {};
template <>
struct NumberTraits<f8> : TraitsOf<float, f8, m8, m8, 8> {};
template <>
struct NumberTraits<d4> : TraitsOf<double, d4, l4, l4, 4> {};
template <class N>
using ScalarOf = typename NumberTraits<N>::Scalar;
template <class N>
using ValueOf = typename NumberTraits<N>::Value;
template <class N>
using MaskOf = typename NumberTraits<N>::Mask;
template <class N>
using CodeOf = typename NumberTraits<N>::Code;

/// One number in all lanes.
template <class V>
[[nodiscard]] V broadcast(ScalarOf<V> a) {
    return V{} + a;
}

using petzval::sqrt;  // of lanes: built-in vectors have no namespace to be found by

template <std::floating_point S>
[[nodiscard]] S sqrt(S a) {
    return std::sqrt(a);
}
[[nodiscard]] inline d4 sqrt(d4 a) {
    return d4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

[[nodiscard]] inline bool all(bool on) {
    return on;
}
[[nodiscard]] inline bool all(m4 on) {
    return __builtin_ia32_movmskps((f4)on) == 15;
}
[[nodiscard]] inline bool all(m8 on) {
    return __builtin_ia32_movmskps256((f8)on) == 255;
}
// Of l4, and of the long long that clang makes of a comparison of doubles.
template <class Mask>
requires(sizeof(Mask) == sizeof(d4) && sizeof(Mask{}[0]) == sizeof(double))
    [[nodiscard]] bool all(Mask on) {
    return __builtin_ia32_movmskpd256((d4)on) == 15;
}
template <class Mask>
[[nodiscard]] bool any(Mask on) {
    return !all(!on);
}

template <class V>
[[nodiscard]] auto lane(const V& a, int i) {
    if constexpr (std::is_arithmetic_v<V>)
        return a;
    else
        return a[i];
}

/// a where on, b elsewhere.
template <class Mask, class V>
[[nodiscard]] V select(Mask on, V a, V b) {
    return on ? a : b;
}

/// Number with its derivatives by two parameters; with them the trace gives exact Jacobians.
/// Comparing and choosing look at the value.
template <class V>
struct Dual {
    V value{}, du{}, dv{};

    friend Dual operator-(Dual a) { return {-a.value, -a.du, -a.dv}; }
    friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.du + b.du, a.dv + b.dv}; }
    friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.du - b.du, a.dv - b.dv}; }
    friend Dual operator*(Dual a, Dual b) {
        return {a.value * b.value, a.du * b.value + a.value * b.du,
                a.dv * b.value + a.value * b.dv};
    }
    friend Dual operator/(Dual a, Dual b) {
        const V by = 1 / b.value, quotient = a.value * by;
        return {quotient, (a.du - quotient * b.du) * by, (a.dv - quotient * b.dv) * by};
    }
};

/// Operand without a derivative: V, or a constant for all lanes.
template <class C, class V>
concept ConstantFor = std::same_as<C, V> || std::is_arithmetic_v<C>;

/// Constant in the type that V's operators take.
template <class V, ConstantFor<V> C>
[[nodiscard]] auto fit(C c) {
    if constexpr (std::same_as<C, V>)
        return c;
    else
        return static_cast<ScalarOf<V>>(c);
}

template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator+(Dual<V> a, C c) {
    return {a.value + fit<V>(c), a.du, a.dv};
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator+(C c, Dual<V> a) {
    return a + c;
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator-(Dual<V> a, C c) {
    return {a.value - fit<V>(c), a.du, a.dv};
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator-(C c, Dual<V> a) {
    return {fit<V>(c) - a.value, -a.du, -a.dv};
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator*(Dual<V> a, C c) {
    return {a.value * fit<V>(c), a.du * fit<V>(c), a.dv * fit<V>(c)};
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator*(C c, Dual<V> a) {
    return a * c;
}
template <class V>
[[nodiscard]] Dual<V> operator/(Dual<V> a, V c) {
    const V by = 1 / c;
    return {a.value * by, a.du * by, a.dv * by};
}
template <class V, ConstantFor<V> C>
[[nodiscard]] Dual<V> operator/(C c, Dual<V> a) {
    const V by = 1 / a.value, quotient = fit<V>(c) * by;
    return {quotient, -quotient * by * a.du, -quotient * by * a.dv};
}

/// Square root; its derivative at 0, infinite, is given as 0.
template <class V>
[[nodiscard]] Dual<V> sqrt(Dual<V> a) {
    const V root = sqrt(a.value);
    const V half = select(root > 0, V(ScalarOf<V>(0.5) / root), V{});
    return {root, a.du * half, a.dv * half};
}
template <class Mask, class V>
[[nodiscard]] Dual<V> select(Mask on, Dual<V> a, Dual<V> b) {
    return {select(on, a.value, b.value), select(on, a.du, b.du), select(on, a.dv, b.dv)};
}

template <class V>
struct NumberTraits<Dual<V>> : NumberTraits<V> {};

template <class V>
[[nodiscard]] V value_of(V a) {
    return a;
}
template <class V>
[[nodiscard]] V value_of(Dual<V> a) {
    return a.value;
}
/// A constant as an N: its derivatives are 0.
template <class N>
[[nodiscard]] N constant(ValueOf<N> a) {
    if constexpr (std::same_as<N, ValueOf<N>>)
        return a;
    else
        return {a};
}

/// Vector of three numbers. Imath's vectors want numbers that compare to a bool.
template <class N>
struct Vec3 {
    N x{}, y{}, z{};

    friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    template <class C>
    friend Vec3 operator*(Vec3 a, C c) {
        return {a.x * c, a.y * c, a.z * c};
    }
};
template <class N>
[[nodiscard]] N dot(Vec3<N> a, Vec3<N> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
[[nodiscard]] Vec3<ValueOf<N>> value_of(const Vec3<N>& a) {
    return {value_of(a.x), value_of(a.y), value_of(a.z)};
}
template <class Mask, class N>
[[nodiscard]] Vec3<N> select(Mask on, Vec3<N> a, Vec3<N> b) {
    return {select(on, a.x, b.x), select(on, a.y, b.y), select(on, a.z, b.z)};
}

}  // namespace petzval::camera
