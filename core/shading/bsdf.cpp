// SPDX-License-Identifier: Apache-2.0
#include "core/shading/bsdf.h"

#include "core/sampling/warp.h"
#include "core/scene/material.h"
#include "core/shading/visible_facets.h"

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

f4 mix(f4 a, f4 b, float share) {
    return a * (1.f - share) + b * share;
}

// KHR_materials_anisotropy: the lobe is widened along x.
GgxWidth width_of(const BsdfInput& in) {
    const float alpha = sqr(in.roughness);
    if (in.anisotropy == 0.f) return alpha;
    const float wide = lerp(alpha, 1.f, sqr(in.anisotropy));
    if (wide < kSmallestAlpha) return alpha;
    return {wide, std::max(alpha, kSmallestAlpha)};
}

GgxAlbedo albedo_of(const V3f& wo, const GgxWidth& alpha) {
    return alpha.anisotropic() ? visible_albedo(wo, alpha) : ggx_albedo(wo.z, alpha.x);
}

}  // namespace

// Layers as in the glTF 2.0 specification, appendix B: metal beside a dielectric coat over its
// body. Energy lost by single scattering comes back by Turquin 2019, "Practical multiple scattering
// compensation for microfacet models", equation 16, for each of the two, and in glass as GlassLoss
// says; the body gets what the coat leaves. A sheen lies over all and takes what it scatters by the
// strongest of its colours, as KHR_materials_sheen says.
Bsdf::Bsdf(const BsdfInput& in, const Bands& bands, const V3f& wo, f4 throughput, const V3f& up)
    : wo_(wo),
      up_(up),
      tilted_(up != V3f(0, 0, 1)),
      alpha_(width_of(in)),
      eta_(in.eta),
      share_(zero_off(bands.on, throughput)),
      disperses_(in.disperses),
      measured_metal_(in.measured_metal && in.metallic > 0.f),
      metal_(),
      film_share_(in.film_share),
      metal_n_(in.metal_n),
      metal_k_(in.metal_k),
      on_(bands.on),
      lead_(bands.lead) {
    share_ *= 1.f / hsum(share_);
    if (disperses_)
        for (int i = 0; i < 4; ++i) rank_of_lead_ += bands.nm[i] < bands.nm[bands.lead];
    delta_ = alpha_.x < kSmallestAlpha;
    const float schlick = schlick_weight(wo.z);
    const GgxAlbedo ggx = delta_ ? GgxAlbedo{1.f - schlick, schlick} : albedo_of(wo, alpha_);
    albedo_f0_ = ggx.f0;
    albedo_f90_ = ggx.f90;
    lambda_o_ = delta_ ? 0.f : ggx_lambda(wo, alpha_);
    const float lost = (1.f - ggx.total()) / ggx.total();

    const f4 one = uniform(1.f, bands);
    const float metal = in.metallic, body = 1.f - metal;
    const float glass_part = in.thin ? 0.f : in.transmission;
    const float coat_part = body * (1.f - glass_part);
    const f4 coat_f90 = one * in.dielectric_f90;
    const f4 metal_f0 =
        measured_metal_ ? zero_off(on_, fresnel_conductor(1.f, metal_n_, metal_k_)) : in.base_color;
    FilmMeans film{in.dielectric_f0, metal_f0, f4{}, f4{}};
    if (film_share_ > 0.f) film = means_of_film(in, bands, metal_f0);
    const f4 coat_gain = one + film.coat_f0 * lost;
    const f4 metal_gain = (one + film.metal_f0 * lost) * metal;
    f4 coat = in.dielectric_f0 * ggx.f0 + coat_f90 * ggx.f90;
    f4 of_metal = metal_f0 * ggx.f0 + ggx.f90;
    spec0_ = in.dielectric_f0 * coat_gain * coat_part;
    spec90_ = coat_f90 * coat_gain * coat_part;
    if (film_share_ > 0.f) {
        coat = mix(coat, film.coat * in.dielectric_f90, film_share_);
        of_metal = mix(of_metal, film.metal, film_share_);
        film_coat_ = spec90_ * film_share_;
        film_metal_ = metal_gain * film_share_;
        film_albedo_ = (film.coat * spec90_ + film.metal * metal_gain) * film_share_;
        spec0_ *= 1.f - film_share_;
        spec90_ *= 1.f - film_share_;
        p_spec_ = hsum((coat * coat_gain * coat_part + metal_gain * of_metal) * share_);
    } else {
        p_spec_ = hsum((spec0_ * ggx.f0 + spec90_ * ggx.f90 + metal_gain * of_metal) * share_);
    }
    coat *= coat_gain;
    const f4 bare_metal = film_share_ > 0.f ? metal_gain * (1.f - film_share_) : metal_gain;
    if (measured_metal_) {
        metal_ = bare_metal;
    } else {
        spec0_ += metal_f0 * bare_metal;
        spec90_ += bare_metal;
    }
    const f4 below = in.base_color * (one - coat) * body;
    diffuse_ = below * (1.f - in.transmission);
    thin_ = in.thin ? below * in.transmission : f4{};
    if (in.diffuse_transmission > 0.f) {
        diffuse_ *= 1.f - in.diffuse_transmission;
        behind_ = in.diffuse_transmission_color * (one - coat) *
                  (body * (1.f - in.transmission) * in.diffuse_transmission);
        p_behind_ = hsum(behind_ * share_);
    }
    glass_share_ = body * glass_part;
    glass_specular_ = in.dielectric_f90;
    glass_ = in.base_color;
    if (in.sheen_most > 0.f) add_sheen(in);
    if (glass_share_ > 0.f && !delta_) {
        // Without a difference in index all normals would share one direction.
        eta_ = eta_ > 0.999f && eta_ < 1.001f ? splat(1.001f) : eta_;
        loss_ = GlassLoss(alpha_.mean(), eta_, !disperses_, glass_specular_);
        lost_ = zero_off(on_, loss_.lost(wo.z, false));
        if (film_share_ > 0.f) lost_ = lost_below_film();
        const float glass_lost = hsum(share_ * lost_);
        if (glass_lost > 0.f) p_crossing_ = hsum(share_ * lost_ * loss_.crossing()) / glass_lost;
        p_lost_ =
            std::min(glass_lost, 0.95f);  // the single scattering that is left has its samples too
    }

    p_diffuse_ = hsum(diffuse_ * share_);
    p_thin_ = hsum(thin_ * share_);
    p_glass_ = glass_share_;
    const float sum = p_spec_ + p_diffuse_ + p_thin_ + p_glass_ + (p_behind_ + p_sheen_);
    const float scale = sum > 0.f ? 1.f / sum : 0.f;
    p_spec_ *= scale;
    p_diffuse_ *= scale;
    p_thin_ *= scale;
    p_glass_ *= scale;
    p_behind_ *= scale;
    p_sheen_ *= scale;
}

// The film replaces Fresnel's reflectance, of the coat and of the metal: KHR_materials_iridescence.
Bsdf::FilmMeans Bsdf::means_of_film(const BsdfInput& in, const Bands& bands, f4 metal_f0) {
    film_ = ThinFilm(in.film_index, in.film_thickness_nm, bands);
    const float specular = in.dielectric_f90;
    coat_n_ = index_for_reflectance(specular > 0.f ? in.dielectric_f0 / specular : f4{});
    if (!measured_metal_) {
        metal_n_ = index_for_reflectance(metal_f0);
        metal_k_ = f4{};
    }
    const auto on_coat = [&](float c) {
        return zero_off(on_, film_.reflectance(c, coat_n_, f4{}));
    };
    const auto on_metal = [&](float c) {
        return in.metallic > 0.f ? zero_off(on_, film_.reflectance(c, metal_n_, metal_k_)) : f4{};
    };
    FilmMeans out{mix(in.dielectric_f0, on_coat(1.f) * specular, film_share_),
                  mix(metal_f0, on_metal(1.f), film_share_), f4{}, f4{}};
    if (delta_) {
        out.coat = on_coat(wo_.z);
        out.metal = on_metal(wo_.z);
        return out;
    }
    const FewFacets facets = few_visible_facets(wo_, alpha_, eta_[0]);
    float all = 0;
    for (size_t i = 0; i < FewFacets::kCount; ++i) {
        out.coat += on_coat(facets.cosine[i]) * facets.reflected[i];
        out.metal += on_metal(facets.cosine[i]) * facets.reflected[i];
        all += facets.reflected[i];
    }
    // What a film of reflectance 1 sends back is known better than a few facets tell.
    const float known = all > 0.f ? (albedo_f0_ + albedo_f90_) / all : 0.f;
    out.coat *= known;
    out.metal *= known;
    return out;
}

// What facets of glass lose, where a film reflects more or less than Fresnel's formula: facets hide
// more or less of what they reflect than of what they refract.
f4 Bsdf::lost_below_film() const {
    const FewFacets facets = few_visible_facets(wo_, alpha_, eta_[0]);
    f4 lost = lost_;
    for (size_t i = 0; i < FewFacets::kCount; ++i) {
        const float c = facets.cosine[i];
        const f4 bare = fresnel_dielectric(c, eta_);
        const f4 more = glass_reflectance(c) - (bare < 1.f ? bare * glass_specular_ : splat(1.f));
        lost -= more * (facets.reflected[i] - facets.refracted[i]);
    }
    return zero_off(on_, min(max(lost, f4{}), splat(1.f)));
}

void Bsdf::add_sheen(const BsdfInput& in) {
    sheen_colour_ = in.sheen;
    sheen_ = Sheen(in.sheen_roughness, wo_.z);
    p_sheen_ = hsum(sheen_colour_ * share_) * sheen_.albedo();
    const float under = 1.f - in.sheen_most * sheen_.albedo();
    for (f4* const lobe : {&spec0_, &spec90_, &metal_, &diffuse_, &thin_}) *lobe *= under;
    if (film_share_ > 0.f)
        for (f4* const lobe : {&film_coat_, &film_metal_, &film_albedo_}) *lobe *= under;
    if (p_behind_ > 0.f) behind_ *= under;
    glass_share_ *= under;
    p_spec_ *= under;
    p_behind_ *= under;
}

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
    if (film_share_ > 0.f)
        reflectance = mix(reflectance, film_.reflectance(wo_m, eta_, f4{}), film_share_);
    return reflectance < 1.f ? reflectance * glass_specular_ : splat(1.f);
}

f4 Bsdf::specular_reflectance(float wo_m) const {
    const float s = schlick_weight(wo_m);
    f4 reflectance = spec0_ * (1.f - s) + spec90_ * s;
    if (film_share_ > 0.f) reflectance += film_reflectance(wo_m);
    if (!measured_metal_) return reflectance;
    return reflectance + metal_ * fresnel_conductor(wo_m, metal_n_, metal_k_);
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
int Bsdf::draw_lane(f4 reflectance, float u, bool led) const {
    const float reflected = hsum(share_ * reflectance);
    if (u < reflected) return -1;
    if (!disperses_) return 0;
    float left = u - reflected;
    int first = 0;
    if (!led && lane_count(on_) == 4) {
        first = lead_ - rank_of_lead_;
        left = 0.25f * (static_cast<float>(rank_of_lead_) * (1.f - reflected) + left);
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
        const float pdf = pdf_of_normal(wo_m, d) / (4.f * wo_m);
        if (wi.z > 0.f) {
            f4 reflectance = specular_reflectance(wo_m);
            float chance = p_spec_;
            if (glass_share_ > 0.f) {
                const f4 r = zero_off(on_, glass_reflectance(wo_m));
                reflectance += glass_share_ * r;
                chance += p_glass_ * (1.f - p_lost_) * hsum(share_ * r);
            }
            value.f_cos += reflectance * single;
            value.pdf += chance * pdf;
        } else {
            value.f_cos += thin_ * (single / (albedo_f0_ + albedo_f90_));
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
                 LostDirections(alpha_.mean()).pdf(cosine);
}

V3f Bsdf::draw_lost(float u_side, V2f u) const {
    const V3f wi = LostDirections(alpha_.mean()).draw(u);
    return u_side < p_crossing_ ? mirror_below(wi) : wi;
}

std::optional<BsdfSample> Bsdf::sample_delta(float u, bool led) const {
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
    const int lane = draw_lane(r, u, led);
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

std::optional<V3f> Bsdf::draw(float u_lobe, V2f u, bool led) const {
    if (p_lost_ > 0.f) {
        const float u_glass = (u_lobe - p_spec_ - p_thin_) / p_glass_;
        if (u_glass >= 1.f - p_lost_) return draw_lost((u_glass + p_lost_ - 1.f) / p_lost_, u);
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
    const int lane = draw_lane(zero_off(on_, glass_reflectance(wo_m)), u_single, led);
    if (lane < 0) return mirrored.z > 0.f ? std::optional(mirrored) : std::nullopt;
    const V3f wi = refract(wo_, m, wo_m, eta_[lane]);
    return wi.z < 0.f ? std::optional(wi) : std::nullopt;
}

std::optional<BsdfSample> Bsdf::sample_tilted(float u_lobe, V2f u, bool led) const {
    std::optional<BsdfSample> drawn = sample_lobes(u_lobe, u, led);
    if (!drawn) return drawn;
    if (!on_its_side(drawn->wi)) drawn->wi = mirrored_at_surface(drawn->wi);
    if (drawn->delta) return drawn;
    const BsdfValue value = eval(drawn->wi);
    if (!(value.pdf > 0.f)) return std::nullopt;
    drawn->weight = value.f_cos * (1.f / value.pdf);
    drawn->pdf = value.pdf;
    return drawn;
}

std::optional<BsdfSample> Bsdf::sample_lobes(float u_lobe, V2f u, bool led) const {
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
        if (delta_) return sample_delta(u_lobe, led);
        const std::optional<V3f> drawn = draw(u_lobe, u, led);
        if (!drawn) return std::nullopt;
        wi = unit(*drawn);
    }
    const BsdfValue value = eval_lobes(wi);
    if (!(value.pdf > 0.f)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1.f / value.pdf), value.pdf, false, wi.z < 0.f};
}

}  // namespace petzval
