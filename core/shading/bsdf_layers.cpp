// SPDX-License-Identifier: Apache-2.0
// How a Bsdf shares light between its lobes.
#include "core/scene/material.h"
#include "core/shading/bsdf.h"
#include "core/shading/visible_facets.h"

namespace petzval {
namespace {

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
      hero_(bands.hero) {
    share_ *= 1.f / hsum(share_);
    if (disperses_)
        for (int i = 0; i < 4; ++i) rank_of_hero_ += bands.nm[i] < bands.nm[bands.hero];
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
        loss_ = GlassLoss(alpha_.x, eta_, !disperses_, glass_specular_);
        lost_ = alpha_.anisotropic() ? lost_by_two_widths() : loss_.lost(wo.z, false);
        lost_ = zero_off(on_, lost_);
        if (film_share_ > 0.f) lost_ = lost_below_film();
        const float glass_lost = hsum(share_ * lost_);
        if (glass_lost > 0.f) p_crossing_ = hsum(share_ * lost_ * loss_.crossing()) / glass_lost;
        p_lost_ =
            std::min(glass_lost, 0.95f);  // the single scattering that is left has its samples too
    }

    p_diffuse_ = hsum(diffuse_ * share_);
    p_thin_ = hsum(thin_ * share_);
    p_glass_ = glass_share_;
    even_weights_ = !delta_ && p_thin_ + p_glass_ + p_behind_ > 0.f;
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
    film_on_glass_ = ThinFilm(in.film_index_on_glass, in.film_thickness_nm, bands);
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

f4 Bsdf::lost_by_two_widths() const {
    f4 lost = splat(visible_glass_loss(wo_, alpha_, eta_[0], glass_specular_));
    for (int i = 1; i < 4 && disperses_; ++i)
        lost[i] = visible_glass_loss(wo_, alpha_, eta_[i], glass_specular_);
    return lost;
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

}  // namespace petzval
