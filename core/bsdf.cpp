// SPDX-License-Identifier: Apache-2.0
#include "core/bsdf.h"

#include "core/microfacet.h"
#include "core/warp.h"

namespace petzval {
namespace {

// Refracted direction of wo at the facet m, eta as in BsdfInput; the caller has excluded total
// reflection. Walter et al. 2007, equation 40.
V3f refract(const V3f& wo, const V3f& m, float wo_m, float eta) {
    const float cos_behind = safe_sqrt(1.f - (1.f - sqr(wo_m)) / sqr(eta));
    return m * (wo_m / eta - cos_behind) - wo * (1.f / eta);
}

V3f mirror_below(const V3f& w) {
    return {w.x, w.y, -w.z};
}

}  // namespace

// Layers as in the glTF 2.0 specification, appendix B: metal beside a dielectric coat over its
// body. Energy lost by single scattering comes back by Turquin 2019, "Practical multiple scattering
// compensation for microfacet models", equation 16, for each of the two; the body gets what the
// coat leaves.
Bsdf::Bsdf(const BsdfInput& in, const Bands& bands, const V3f& wo)
    : wo_(wo), alpha_(sqr(in.roughness)), eta_(in.eta), on_(bands.on) {
    delta_ = alpha_ < kSmallestAlpha;
    const float schlick = schlick_weight(wo.z);
    const GgxAlbedo ggx = delta_ ? GgxAlbedo{1.f - schlick, schlick} : ggx_albedo(wo.z, alpha_);
    albedo_f0_ = ggx.f0;
    albedo_f90_ = ggx.f90;
    lambda_o_ = delta_ ? 0.f : ggx_lambda(wo, alpha_);
    const float lost = (1.f - ggx.total()) / ggx.total();

    const f4 one = uniform(1.f, bands);
    const float metal = in.metallic, body = 1.f - metal;
    const float glass_part = in.thin ? 0.f : in.transmission;
    const f4 coat_f90 = one * in.dielectric_f90;
    const f4 coat_gain = one + in.dielectric_f0 * lost;
    const f4 metal_gain = one + in.base_color * lost;
    const f4 coat = (in.dielectric_f0 * ggx.f0 + coat_f90 * ggx.f90) * coat_gain;
    const float coat_part = body * (1.f - glass_part);
    spec0_ = in.dielectric_f0 * coat_gain * coat_part + in.base_color * metal_gain * metal;
    spec90_ = coat_f90 * coat_gain * coat_part + metal_gain * metal;
    const f4 below = in.base_color * (one - coat) * body;
    diffuse_ = below * (1.f - in.transmission);
    thin_ = in.thin ? below * in.transmission : f4{};
    glass_share_ = body * glass_part;
    glass_specular_ = in.dielectric_f90;
    glass_ = in.base_color;

    p_spec_ = hsum(spec0_ * ggx.f0 + spec90_ * ggx.f90);
    p_diffuse_ = hsum(diffuse_);
    p_thin_ = hsum(thin_);
    p_glass_ = hsum(one) * glass_share_;
    const float sum = p_spec_ + p_diffuse_ + p_thin_ + p_glass_;
    const float scale = sum > 0.f ? 1.f / sum : 0.f;
    p_spec_ *= scale;
    p_diffuse_ *= scale;
    p_thin_ *= scale;
    p_glass_ *= scale;
}

f4 Bsdf::albedo() const {
    return spec0_ * albedo_f0_ + spec90_ * albedo_f90_ + diffuse_ + thin_ +
           zero_off(on_, splat(glass_share_));
}

float Bsdf::glass_reflectance(float wo_m) const {
    const float reflectance = fresnel_dielectric(wo_m, eta_);
    return reflectance < 1.f ? reflectance * glass_specular_ : 1.f;
}

// Density of the visible normals, 1/sr, from GGX's d at the normal: Heitz 2014, equation 2.
float Bsdf::pdf_of_normal(float wo_m, float d) const {
    return d * wo_m / ((1.f + lambda_o_) * wo_.z);
}

BsdfValue Bsdf::eval(const V3f& wi) const {
    BsdfValue value;
    if (wi.z > 0.f && p_diffuse_ > 0.f) {
        value.f_cos = diffuse_ * (wi.z * kInvPi);
        value.pdf = p_diffuse_ * wi.z * kInvPi;
    }
    if (delta_ || wi.z == 0.f) return value;
    const V3f above = wi.z > 0.f ? wi : mirror_below(wi);
    if (wi.z > 0.f || p_thin_ > 0.f) {
        const V3f m = unit(wo_ + above);
        const float wo_m = wo_.dot(m);
        const float d = ggx_d(m, alpha_);
        // Height-correlated masking and shadowing: Heitz 2014, equation 99.
        const float g2 = 1.f / (1.f + lambda_o_ + ggx_lambda(above, alpha_));
        const float single = d * g2 / (4.f * wo_.z);
        const float pdf = pdf_of_normal(wo_m, d) / (4.f * wo_m);
        if (wi.z > 0.f) {
            const float s = schlick_weight(wo_m);
            f4 reflectance = spec0_ * (1.f - s) + spec90_ * s;
            float chance = p_spec_;
            if (glass_share_ > 0.f) {
                const float r = glass_reflectance(wo_m);
                reflectance += zero_off(on_, splat(glass_share_ * r));
                chance += p_glass_ * r;
            }
            value.f_cos += reflectance * single;
            value.pdf += chance * pdf;
        } else {
            value.f_cos += thin_ * (single / (albedo_f0_ + albedo_f90_));
            value.pdf += p_thin_ * pdf;
        }
    }
    if (wi.z < 0.f && glass_share_ > 0.f) add_glass(wi, value);
    return value;
}

// Refraction at a facet: Walter et al. 2007, equations 16, 17 and 21, less the factor eta^2 that
// turns radiance into basic radiance; separable masking and shadowing, equation 23.
void Bsdf::add_glass(const V3f& wi, BsdfValue& value) const {
    V3f m = wo_ + wi * eta_;
    if (m.dot(m) < 1e-12f) return;
    m = unit(m);
    if (m.z < 0.f) m = -m;
    const float wo_m = wo_.dot(m), wi_m = wi.dot(m);
    if (wo_m <= 0.f || wi_m >= 0.f) return;
    const float denominator = wo_m + eta_ * wi_m;
    const float jacobian = sqr(eta_) * -wi_m / sqr(denominator);
    const float transmittance = 1.f - glass_reflectance(wo_m);
    const float pdf = transmittance * pdf_of_normal(wo_m, ggx_d(m, alpha_)) * jacobian;
    value.f_cos += zero_off(on_, glass_) * (glass_share_ * pdf / (1.f + ggx_lambda(wi, alpha_)));
    value.pdf += p_glass_ * pdf;
}

std::optional<BsdfSample> Bsdf::sample_delta(float u) const {
    const V3f mirrored{-wo_.x, -wo_.y, wo_.z};
    if (u < p_spec_) {
        const f4 albedo = spec0_ * albedo_f0_ + spec90_ * albedo_f90_;
        return BsdfSample{mirrored, albedo * (1.f / p_spec_), 0.f, true, false};
    }
    u -= p_spec_;
    if (u < p_thin_) return BsdfSample{-wo_, thin_ * (1.f / p_thin_), 0.f, true, true};
    if (p_glass_ <= 0.f) return std::nullopt;  // the chances add up to 1 but for a rounding
    u = (u - p_thin_) / p_glass_;
    const float r = glass_reflectance(wo_.z);
    const f4 share = zero_off(on_, splat(glass_share_ / p_glass_));
    if (u < r) return BsdfSample{mirrored, share, 0.f, true, false};
    const V3f wi = refract(wo_, {0, 0, 1}, wo_.z, eta_);
    return BsdfSample{wi, share * glass_, 0.f, true, true};
}

std::optional<V3f> Bsdf::draw(float u_lobe, V2f u) const {
    const V3f m = ggx_sample_visible(wo_, alpha_, u);
    const float wo_m = wo_.dot(m);
    if (wo_m <= 0.f) return std::nullopt;
    const V3f mirrored = reflect(wo_, m);
    if (u_lobe < p_spec_) return mirrored.z > 0.f ? std::optional(mirrored) : std::nullopt;
    u_lobe -= p_spec_;
    if (u_lobe < p_thin_)
        return mirrored.z > 0.f ? std::optional(mirror_below(mirrored)) : std::nullopt;
    if (p_glass_ <= 0.f) return std::nullopt;
    u_lobe = (u_lobe - p_thin_) / p_glass_;
    if (u_lobe < glass_reflectance(wo_m))
        return mirrored.z > 0.f ? std::optional(mirrored) : std::nullopt;
    const V3f wi = refract(wo_, m, wo_m, eta_);
    return wi.z < 0.f ? std::optional(wi) : std::nullopt;
}

std::optional<BsdfSample> Bsdf::sample(float u_lobe, V2f u) const {
    V3f wi;
    if (u_lobe < p_diffuse_) {
        wi = cosine_hemisphere(u);
    } else {
        u_lobe -= p_diffuse_;
        if (p_spec_ + p_thin_ + p_glass_ <= 0.f) return std::nullopt;
        if (delta_) return sample_delta(u_lobe);
        const std::optional<V3f> drawn = draw(u_lobe, u);
        if (!drawn) return std::nullopt;
        wi = unit(*drawn);
    }
    const BsdfValue value = eval(wi);
    if (!(value.pdf > 0.f)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1.f / value.pdf), value.pdf, false, wi.z < 0.f};
}

}  // namespace petzval
