// SPDX-License-Identifier: Apache-2.0
// GGX microfacets and Fresnel reflection. Directions are unit vectors in the frame of the surface,
// z along its normal.
#pragma once

#include "core/math/lanes.h"
#include "core/math/math.h"
#include "core/math/trig.h"

namespace petzval {

/// Widths of a GGX lobe along x and y of the surface's frame; a single number is one for both.
/// Burley 2012, "Physically-Based Shading at Disney", appendix B.
struct GgxWidth {
    float x, y;
    float x_per_y2, y_per_x2;  ///< squares of the ratios; exactly 1 where both are the same

    GgxWidth(float alpha)  // NOLINT(google-explicit-constructor): most surfaces have one width
        : x(alpha), y(alpha), x_per_y2(1.f), y_per_x2(1.f) {}
    GgxWidth(float x0, float y0) : x(x0), y(y0), x_per_y2(sqr(x0 / y0)), y_per_x2(sqr(y0 / x0)) {}
    [[nodiscard]] bool anisotropic() const { return x != y; }
};

/// Normal density, 1/sr. Walter et al. 2007, "Microfacet Models for Refraction", equation 33.
[[nodiscard]] inline float ggx_d(const V3f& m, const GgxWidth& alpha) {
    // Written in the slopes so that nothing cancels for a narrow lobe.
    const float e = (sqr(m.x) + sqr(m.y) * alpha.x_per_y2) / sqr(alpha.x) + sqr(m.z);
    return kInvPi / (alpha.x * alpha.y * sqr(e));
}

/// Smith's auxiliary function. Heitz 2014, "Understanding the Masking-Shadowing Function",
/// equations 72 and 80.
[[nodiscard]] inline float ggx_lambda(const V3f& w, const GgxWidth& alpha) {
    const float tan2 = (sqr(w.x) + sqr(w.y) * alpha.y_per_x2) / sqr(w.z);
    return 0.5f * (std::sqrt(1.f + sqr(alpha.x) * tan2) - 1.f);
}

/// A microfacet normal in proportion to what is visible of it from wo (wo.z > 0). Dupuy and
/// Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
[[nodiscard]] inline V3f ggx_sample_visible(const V3f& wo, const GgxWidth& alpha, V2f u) {
    const V3f stretched = unit({wo.x * alpha.x, wo.y * alpha.y, wo.z});
    const SinCos phi = sincos_turns(u.x);
    const float z = 1.f - u.y * (1.f + stretched.z);
    const float sin_theta = safe_sqrt(1.f - sqr(z));
    const V3f half = V3f(sin_theta * phi.cosine, sin_theta * phi.sine, z) + stretched;
    return unit({half.x * alpha.x, half.y * alpha.y, half.z > 1e-9f ? half.z : 1e-9f});
}

/// The first where share is 0, the second where it is 1, exactly.
[[nodiscard]] inline f4 mix(f4 a, f4 b, float share) {
    return a * (1.f - share) + b * share;
}

/// Schlick 1994's weight (1 - cos)^5.
[[nodiscard]] inline float schlick_weight(float cosine) {
    const float a = clamp_unit(1.f - cosine);
    return sqr(sqr(a)) * a;
}

/// Unpolarised reflectance of a boundary; eta = index behind over index in front; cosine >= 0 in
/// front. 1 under total reflection. Born and Wolf 1999, "Principles of Optics", 1.5.2.
template <class Cosine, class Eta>
[[nodiscard]] auto fresnel_dielectric(Cosine cosine, Eta eta) {
    using Lanes = decltype(cosine * eta);
    const Lanes zero{}, cos2_behind = 1.f - (1.f - cosine * cosine) / (eta * eta);
    const Lanes cos_behind = sqrt(max(cos2_behind, zero));
    const Lanes parallel = (eta * cosine - cos_behind) / (eta * cosine + cos_behind);
    const Lanes perpendicular = (cosine - eta * cos_behind) / (cosine + eta * cos_behind);
    const Lanes share = 0.5f * (parallel * parallel + perpendicular * perpendicular);
    return cos2_behind > 0.f ? share : zero + 1.f;
}
/// Fresnel's reflectance of glass, times KHR_materials_specular's factor but for total reflection.
template <class Lanes>
[[nodiscard]] Lanes of_glass(Lanes fresnel, float specular) {
    return fresnel < 1.f ? fresnel * specular : Lanes{} + 1.f;
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
