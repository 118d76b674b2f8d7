// SPDX-License-Identifier: Apache-2.0
// Surfaces that tests of the Bsdf share.
#pragma once

#include "core/shading/bsdf.h"

namespace petzval::test {
inline V3f from_cosine(float cosine, float azimuth = 0.f) {
    const float sine = safe_sqrt(1 - sqr(cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

inline BsdfInput dielectric(float roughness) {
    BsdfInput in;
    in.base_color = uniform(1.f, Bands::rgb());
    in.roughness = roughness;
    in.dielectric_f0 = uniform(0.04f, Bands::rgb());
    return in;
}

inline BsdfInput metal(float roughness) {
    BsdfInput in = dielectric(roughness);
    in.metallic = 1.f;
    return in;
}

inline BsdfInput glass(float roughness, float eta) {
    BsdfInput in = dielectric(roughness);
    in.transmission = 1.f;
    in.thin = false;
    in.eta = splat(eta);
    return in;
}

/// A glass of 1.3, 1.5 and 1.9 in the three lanes: further apart than any real one.
inline BsdfInput dispersing(float roughness, bool from_inside) {
    BsdfInput in = glass(roughness, 1.5f);
    in.eta = f4{1.3f, 1.5f, 1.9f, 1.f};
    if (from_inside) in.eta = 1.f / in.eta;
    in.disperses = true;
    return in;
}

/// n and k of gold near 610, 540 and 450 nm.
inline BsdfInput gold(float roughness) {
    BsdfInput in = metal(roughness);
    in.measured_metal = true;
    in.metal_n = f4{0.21f, 0.43f, 1.5f, 1.f};
    in.metal_k = f4{3.25f, 2.35f, 1.88f, 0.f};
    return in;
}

inline BsdfInput thin_glass(float roughness) {
    BsdfInput in = dielectric(roughness);
    in.transmission = 1.f;
    return in;
}

inline BsdfInput half_metal(BsdfInput in) {
    in.metallic = 0.5f;
    return in;
}

}  // namespace petzval::test
