// SPDX-License-Identifier: Apache-2.0
// GGX microfacets and Fresnel reflection. Directions are unit vectors in the frame of the surface,
// z along its normal.
#pragma once

#include "core/math/lanes.h"
#include "core/math/math.h"
#include "core/math/trig.h"

namespace petzval {

/// Normal density, 1/sr. Walter et al. 2007, "Microfacet Models for Refraction", equation 33.
[[nodiscard]] inline float ggx_d(const V3f& m, float alpha) {
    // Written in the slopes so that nothing cancels for a narrow lobe.
    const float a2 = sqr(alpha);
    const float e = (sqr(m.x) + sqr(m.y)) / a2 + sqr(m.z);
    return kInvPi / (a2 * sqr(e));
}

/// Smith's auxiliary function. Heitz 2014, "Understanding the Masking-Shadowing Function",
/// equation 72.
[[nodiscard]] inline float ggx_lambda(const V3f& w, float alpha) {
    const float tan2 = (sqr(w.x) + sqr(w.y)) / sqr(w.z);
    return 0.5f * (std::sqrt(1.f + sqr(alpha) * tan2) - 1.f);
}

/// A microfacet normal in proportion to what is visible of it from wo (wo.z > 0). Dupuy and
/// Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
[[nodiscard]] inline V3f ggx_sample_visible(const V3f& wo, float alpha, V2f u) {
    const V3f stretched = unit({wo.x * alpha, wo.y * alpha, wo.z});
    const SinCos phi = sincos_turns(u.x);
    const float z = 1.f - u.y * (1.f + stretched.z);
    const float sin_theta = safe_sqrt(1.f - sqr(z));
    const V3f half = V3f(sin_theta * phi.cosine, sin_theta * phi.sine, z) + stretched;
    return unit({half.x * alpha, half.y * alpha, half.z > 1e-9f ? half.z : 1e-9f});
}

/// Schlick 1994's weight (1 - cos)^5.
[[nodiscard]] inline float schlick_weight(float cosine) {
    const float a = clamp_unit(1.f - cosine);
    return sqr(sqr(a)) * a;
}

/// Unpolarised reflectance of a boundary; eta = index behind over index in front; cosine >= 0 in
/// front. 1 under total reflection. Born and Wolf 1999, "Principles of Optics", 1.5.2.
[[nodiscard]] inline f4 fresnel_dielectric(float cosine, f4 eta) {
    const f4 cos2_behind = splat(1.f) - splat(1.f - sqr(cosine)) / (eta * eta);
    const f4 cos_behind = sqrt(max(cos2_behind, f4{}));
    const f4 parallel = (eta * cosine - cos_behind) / (eta * cosine + cos_behind);
    const f4 perpendicular = (cosine - eta * cos_behind) / (cosine + eta * cos_behind);
    const f4 share = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    return cos2_behind > 0.f ? share : splat(1.f);
}

/// Unpolarised reflectance of a metal of index n + ik over the index in front. Born and Wolf 1999,
/// 14.2, with the complex cosine behind written as a + ib.
[[nodiscard]] inline f4 fresnel_conductor(float cosine, f4 n, f4 k) {
    const float cos2 = sqr(cosine), sin2 = 1.f - cos2;
    const f4 p = n * n - k * k - sin2, nk = n * k;
    const f4 length = sqrt(p * p + 4.f * nk * nk);  // a^2 + b^2
    const f4 a = sqrt(max(0.5f * (length + p), f4{}));
    const f4 perpendicular =
        (length + cos2 - 2.f * cosine * a) / (length + cos2 + 2.f * cosine * a);
    const f4 c = cos2 * length + sqr(sin2), d = 2.f * cosine * sin2 * a;
    const f4 parallel = perpendicular * (c - d) / (c + d);
    return 0.5f * (perpendicular + parallel);
}

/// Share of light that single scattering on a GGX surface reflects, split by Schlick's weight:
/// a reflectance F0 (1 - s) + F90 s has the directional albedo F0 * f0 + F90 * f90.
struct GgxAlbedo {
    float f0, f90;
    [[nodiscard]] float total() const { return f0 + f90; }
};
/// Directional albedo from a table, bilinear in sqrt(cosine) and sqrt(alpha); relative error of
/// total() < 0.3 %.
[[nodiscard]] GgxAlbedo ggx_albedo(float cosine, float alpha);

}  // namespace petzval
