// SPDX-License-Identifier: Apache-2.0
#include "core/shading/bsdf.h"

#include <bit>

#include "core/sampling/warp.h"

namespace petzval {
namespace {

// Refracted direction of wo at the facet m, eta as in BsdfInput; the caller has excluded total
// reflection. Walter et al. 2007, equation 40.
V3f refract(const V3f& wo, const V3f& m, float wo_m, float eta) {
    const float cos_behind = safe_sqrt(1.f - (1.f - sqr(wo_m)) / sqr(eta));
    return m * (wo_m / eta - cos_behind) - wo * (1.f / eta);
}

f4 only(int lane, float value) {
    f4 lanes{};
    lanes[lane] = value;
    return lanes;
}

V3f mirror_below(const V3f& w) {
    return {w.x, w.y, -w.z};
}

}  // namespace

f4 Bsdf::albedo() const {
    f4 albedo = spec0_ * albedo_f0_ + spec90_ * albedo_f90_ + diffuse_ + thin_ +
                zero_off(on_, splat(glass_share_));
    if (film_share_ > 0.f) albedo += film_albedo_;
    if (p_behind_ > 0.f) albedo += behind_;
    if (p_sheen_ > 0.f) albedo += sheen_colour_ * sheen_.albedo();
    // Approximation: every facet meets the light at wo's angle.
    if (measured_metal_)
        albedo +=
            metal_ * fresnel_conductor(wo_.z, metal_n_, metal_k_) * (albedo_f0_ + albedo_f90_);
    return albedo;
}

f4 Bsdf::glass_reflectance(float wo_m) const {
    f4 reflectance = fresnel_dielectric(wo_m, eta_);
    if (film_share_ > 0.f) reflectance = with_film(reflectance, wo_m);
    return reflectance < 1.f ? reflectance * glass_specular_ : splat(1.f);
}

f4 Bsdf::specular_reflectance(float wo_m) const {
    const float s = schlick_weight(wo_m);
    f4 reflectance = spec0_ * (1.f - s) + spec90_ * s;
    if (film_share_ > 0.f) reflectance += film_reflectance(wo_m);
    if (!measured_metal_) return reflectance;
    return reflectance + metal_ * fresnel_conductor(wo_m, metal_n_, metal_k_);
}

f4 Bsdf::with_film(f4 bare, float wo_m) const {
    return mix(bare, film_on_glass_.reflectance(wo_m, eta_, f4{}), film_share_);
}

f4 Bsdf::film_reflectance(float wo_m) const {
    f4 reflectance = film_coat_ * zero_off(on_, film_.reflectance(wo_m, coat_n_, f4{}));
    if (hmax(film_metal_) > 0.f)
        reflectance += film_metal_ * zero_off(on_, film_.reflectance(wo_m, metal_n_, metal_k_));
    return reflectance;
}

// Drawn lane, -1 for reflection. All lanes reflect the same way, so reflection is drawn by their
// mean; else a lane is drawn in proportion to what of it is not reflected, and the light takes its
// way. Lanes follow each other in the circle of their wavelengths' quantiles. The rank of the lane
// that leads is a digit of a random number, and u gives the rest of it.
int Bsdf::draw_lane(f4 reflectance, float u, bool hero_decided) const {
    const float reflected = hsum(share_ * reflectance);
    if (u < reflected) return -1;
    if (!disperses_) return 0;
    float left = u - reflected;
    int first = 0;
    if (!hero_decided && lane_count(on_) == 4) {
        first = hero_ - rank_of_hero_;
        left = 0.25f * (static_cast<float>(rank_of_hero_) * (1.f - reflected) + left);
    }
    int lane = 3;
    for (int j = 0; j < 4; ++j) {
        const int i = (first + j) & 3;
        const float chance = share_[i] * (1.f - reflectance[i]);
        if (!(chance > 0.f)) continue;
        lane = i;
        if (left < chance) break;
        left -= chance;
    }
    return lane;
}

// Density of the visible normals, 1/sr, from GGX's d at the normal: Heitz 2014, equation 2.
float Bsdf::pdf_of_normal(float wo_m, float d) const {
    return d * wo_m / ((1.f + lambda_o_) * wo_.z);
}

BsdfValue Bsdf::eval_tilted(const V3f& wi) const {
    // Light leaves towards wi on either of two ways that end on the same side.
    const V3f mirrored = mirrored_at_surface(wi);
    const bool above = wi.dot(up_) > 0.f;
    BsdfValue value;
    if ((wi.z > 0.f) == above) value = eval_lobes(wi);
    if ((mirrored.z > 0.f) == above) {
        const BsdfValue other = eval_lobes(mirrored);
        value.f_cos += other.f_cos;
        value.pdf += other.pdf;
    }
    return value;
}

BsdfValue Bsdf::eval_lobes(const V3f& wi) const {
    BsdfValue value;
    if (wi.z > 0.f && p_diffuse_ > 0.f) {
        value.f_cos = diffuse_ * (wi.z * kInvPi);
        value.pdf = p_diffuse_ * wi.z * kInvPi;
    }
    if (wi.z < 0.f && p_behind_ > 0.f) {
        value.f_cos = behind_ * (-wi.z * kInvPi);
        value.pdf = p_behind_ * -wi.z * kInvPi;
    }
    if (wi.z > 0.f && p_sheen_ > 0.f) {
        value.f_cos += sheen_colour_ * sheen_.f_cos(wo_, wi);
        value.pdf += p_sheen_ * uniform_hemisphere_pdf();
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
        const float by_normal = pdf_of_normal(wo_m, d) / (4.f * wo_m);
        const float by_value = single / (albedo_f0_ + albedo_f90_);
        const float pdf = even_weights_ ? by_value : by_normal;
        if (wi.z > 0.f) {
            f4 reflectance = specular_reflectance(wo_m);
            value.pdf += p_spec_ * pdf;
            if (glass_share_ > 0.f) {
                const f4 r = zero_off(on_, glass_reflectance(wo_m));
                reflectance += glass_share_ * r;
                value.pdf += p_glass_ * (1.f - p_lost_) * hsum(share_ * r) * by_normal;
            }
            value.f_cos += reflectance * single;
        } else {
            value.f_cos += thin_ * by_value;
            value.pdf += p_thin_ * pdf;
        }
    }
    if (wi.z < 0.f && glass_share_ > 0.f) add_glass(wi, value);
    if (p_lost_ > 0.f) add_lost(wi, value);
    return value;
}

// Refraction at a facet: Walter et al. 2007, equations 16, 17 and 21, less the factor eta^2 that
// turns radiance into basic radiance; separable masking and shadowing, equation 23.
void Bsdf::add_glass(const V3f& wi, BsdfValue& value) const {
    const float shadowing = 1.f / (1.f + ggx_lambda(wi, alpha_));
    f4 density{};  // of wi, as each lane would draw it
    for (int i = 0; i < (disperses_ ? 4 : 1); ++i) {
        const float eta = eta_[i];
        V3f m = wo_ + wi * eta;
        if (m.dot(m) < 1e-12f) continue;
        m = unit(m);
        if (m.z < 0.f) m = -m;
        const float wo_m = wo_.dot(m), wi_m = wi.dot(m);
        if (wo_m <= 0.f || wi_m >= 0.f) continue;
        const float denominator = wo_m + eta * wi_m;
        const float jacobian = sqr(eta) * -wi_m / sqr(denominator);
        const f4 refracted =
            (1.f - glass_reflectance(wo_m)) * pdf_of_normal(wo_m, ggx_d(m, alpha_)) * jacobian;
        if (disperses_)
            density[i] = refracted[i];
        else
            density = refracted;
    }
    value.f_cos += zero_off(on_, glass_ * density) * (glass_share_ * shadowing);
    value.pdf += p_glass_ * (1.f - p_lost_) * hsum(share_ * density);
}

void Bsdf::add_lost(const V3f& wi, BsdfValue& value) const {
    const bool behind = wi.z < 0.f;
    const float cosine = std::fabs(wi.z);
    const f4 scattered = glass_share_ * lost_ * loss_.lobe(cosine, behind);
    value.f_cos += zero_off(on_, behind ? glass_ * scattered : scattered);
    value.pdf += p_glass_ * p_lost_ * (behind ? p_crossing_ : 1.f - p_crossing_) *
                 LostDirections(alpha_.x).pdf(cosine);
}

V3f Bsdf::draw_lost(float u_side, V2f u) const {
    const V3f wi = LostDirections(alpha_.x).draw(u);
    return u_side < p_crossing_ ? mirror_below(wi) : wi;
}

std::optional<BsdfSample> Bsdf::sample_delta(float u, bool hero_decided) const {
    const V3f mirrored{-wo_.x, -wo_.y, wo_.z};
    if (u < p_spec_) {
        const f4 reflectance = specular_reflectance(wo_.z);
        return BsdfSample{mirrored, reflectance * (1.f / p_spec_), 0.f, true, false};
    }
    u -= p_spec_;
    if (u < p_thin_) return BsdfSample{-wo_, thin_ * (1.f / p_thin_), 0.f, true, true};
    if (p_glass_ <= 0.f) return std::nullopt;  // the chances add up to 1 but for a rounding
    u = (u - p_thin_) / p_glass_;
    const f4 r = zero_off(on_, glass_reflectance(wo_.z));
    const float share = glass_share_ / p_glass_;
    const int lane = draw_lane(r, u, hero_decided);
    if (lane < 0) {
        // Weight 1 for lanes of one index: no rounding, so that nothing is gained or lost.
        const bool alike = !disperses_ && !(film_share_ > 0.f);
        const f4 weight = alike ? zero_off(on_, splat(1.f)) : r / hsum(share_ * r);
        return BsdfSample{mirrored, weight * share, 0.f, true, false};
    }
    const V3f wi = refract(wo_, {0, 0, 1}, wo_.z, eta_[lane]);
    f4 weight = zero_off(on_, glass_ * share);
    if (disperses_)
        weight = only(lane, weight[lane] / share_[lane]);
    else if (film_share_ > 0.f)
        weight *= (1.f - r) / (1.f - hsum(share_ * r));
    return BsdfSample{wi, weight, 0.f, true, true};
}

std::optional<V3f> Bsdf::draw(float u_lobe, V2f u, bool hero_decided) const {
    if (p_lost_ > 0.f) {
        const float u_glass = (u_lobe - p_spec_ - p_thin_) / p_glass_;
        if (u_glass >= 1.f - p_lost_) return draw_lost((u_glass + p_lost_ - 1.f) / p_lost_, u);
    }
    if (even_weights_ && u_lobe < p_spec_ + p_thin_) {
        const bool reflected = u_lobe < p_spec_;
        const float u_more = reflected ? u_lobe / p_spec_ : (u_lobe - p_spec_) / p_thin_;
        const std::optional<V3f> drawn = draw_evenly(u_more, u);
        return reflected || !drawn ? drawn : mirror_below(*drawn);
    }
    const V3f m = ggx_sample_visible(wo_, alpha_, u);
    const float wo_m = wo_.dot(m);
    if (wo_m <= 0.f) return std::nullopt;
    const V3f mirrored = reflect(wo_, m);
    if (u_lobe < p_spec_) return mirrored.z > 0.f ? std::optional(mirrored) : std::nullopt;
    u_lobe -= p_spec_;
    if (u_lobe < p_thin_)
        return mirrored.z > 0.f ? std::optional(mirror_below(mirrored)) : std::nullopt;
    if (p_glass_ <= 0.f) return std::nullopt;
    const float u_single = (u_lobe - p_thin_) / (p_glass_ * (1.f - p_lost_));
    const int lane = draw_lane(zero_off(on_, glass_reflectance(wo_m)), u_single, hero_decided);
    if (lane < 0) return mirrored.z > 0.f ? std::optional(mirrored) : std::nullopt;
    const V3f wi = refract(wo_, m, wo_m, eta_[lane]);
    return wi.z < 0.f ? std::optional(wi) : std::nullopt;
}

// A reflection drawn in proportion to its value but for Fresnel's factor: facets are drawn until
// one is met whose light leaves, with the share that masking lets go on. u_more is free to use.
std::optional<V3f> Bsdf::draw_evenly(float u_more, V2f u) const {
    constexpr uint32_t tries = 64;  // a try fails in three of four cases at most
    const uint32_t seed =
        hash32(std::bit_cast<uint32_t>(u_more),
               hash32(std::bit_cast<uint32_t>(u.x), std::bit_cast<uint32_t>(u.y)));
    for (uint32_t i = 0; i < tries; ++i) {
        const V3f wi = reflect(wo_, ggx_sample_visible(wo_, alpha_, u));
        if (wi.z > 0.f) {
            const float all = 1.f + lambda_o_;
            if (to_unit_float(hash32(seed, 3 * i)) * (all + ggx_lambda(wi, alpha_)) < all)
                return wi;
        }
        u = V2f(to_unit_float(hash32(seed, 3 * i + 1)), to_unit_float(hash32(seed, 3 * i + 2)));
    }
    return std::nullopt;
}

std::optional<BsdfSample> Bsdf::sample_tilted(float u_lobe, V2f u, bool hero_decided) const {
    std::optional<BsdfSample> drawn = sample_lobes(u_lobe, u, hero_decided);
    if (!drawn) return drawn;
    if (!on_its_side(drawn->wi)) drawn->wi = mirrored_at_surface(drawn->wi);
    if (drawn->delta) return drawn;
    const BsdfValue value = eval(drawn->wi);
    if (!(value.pdf > 0.f)) return std::nullopt;
    drawn->weight = value.f_cos * (1.f / value.pdf);
    drawn->pdf = value.pdf;
    return drawn;
}

std::optional<BsdfSample> Bsdf::sample_lobes(float u_lobe, V2f u, bool hero_decided) const {
    V3f wi;
    if (u_lobe < p_diffuse_) {
        wi = cosine_hemisphere(u);
    } else if (u_lobe -= p_diffuse_; u_lobe < p_behind_) {
        wi = mirror_below(cosine_hemisphere(u));
    } else if (u_lobe -= p_behind_; u_lobe < p_sheen_) {
        wi = uniform_hemisphere(u);
    } else {
        u_lobe -= p_sheen_;
        if (p_spec_ + p_thin_ + p_glass_ <= 0.f) return std::nullopt;
        if (delta_) return sample_delta(u_lobe, hero_decided);
        const std::optional<V3f> drawn = draw(u_lobe, u, hero_decided);
        if (!drawn) return std::nullopt;
        wi = unit(*drawn);
    }
    const BsdfValue value = eval_lobes(wi);
    if (!(value.pdf > 0.f)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1.f / value.pdf), value.pdf, false, wi.z < 0.f};
}

}  // namespace petzval
