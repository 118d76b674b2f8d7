// SPDX-License-Identifier: Apache-2.0
// Lobes: the ways in which a surface scatters light. Each is a value, made for one wo:
//
//   chance    that a sample is its own; where there is no such lobe 0, and nothing else is set
//   albedo()  the share of light that it scatters
//   value()   its part of the surface's f cos and density, by its weight and its chance
//   draw()    a sample; nothing where the light is absorbed
#pragma once

#include <optional>

#include "core/sampling/warp.h"
#include "core/scene/material.h"
#include "core/shading/glass_loss.h"
#include "core/shading/microfacet.h"
#include "core/shading/sheen.h"
#include "core/shading/thin_film.h"

namespace petzval {

/// Value f cos and its density; both 0 where only a delta lobe could answer.
struct BsdfValue {
    f4 f_cos{};
    float pdf = 0;  ///< 1/sr

    void operator+=(const BsdfValue& other) {
        f_cos += other.f_cos;
        pdf += other.pdf;
    }
};

struct BsdfSample {
    V3f wi;
    f4 weight;  ///< f cos / pdf
    float pdf;  ///< 1/sr; meaningless for a delta lobe
    bool delta;
    bool transmitted;  ///< wi lies on the other side

    /// Sample of a wide lobe, to be weighed.
    [[nodiscard]] static BsdfSample wide(const V3f& wi) {
        return {wi, f4{}, 0.f, false, wi.z < 0.f};
    }
    /// Sets weight and density to those of all lobes together; returns whether there are any.
    [[nodiscard]] bool weigh(const BsdfValue& of_all) {
        pdf = of_all.pdf;
        weight = of_all.f_cos * (1.f / pdf);
        return pdf > 0.f;
    }
};

/// Random numbers of a sample, as Bsdf::sample has them. lobe: what is left of it, below `chance`.
struct BsdfNumbers {
    float lobe;
    V2f direction;
    bool hero_decided;
};

[[nodiscard]] inline V3f mirror_below(const V3f& w) {
    return {w.x, w.y, -w.z};
}

/// GGX facets as wo sees them.
struct SeenFacets {
    V3f wo;
    GgxWidth alpha;
    bool smooth;        ///< the surface is the only facet: lobes are deltas
    bool even = false;  ///< mirror images are drawn in proportion to their value
    float lambda_o;     ///< ggx_lambda of wo; 0 where smooth
    GgxAlbedo albedo;

    SeenFacets(const V3f& wo0, const GgxWidth& alpha0)
        : wo(wo0), alpha(alpha0), smooth(alpha.x < kSmallestAlpha), lambda_o(0.f) {
        const float schlick = schlick_weight(wo.z);
        albedo = {1.f - schlick, schlick};
        if (!smooth) set_rough();
    }
    /// Density of the facets in the proportion in which they are seen, 1/sr, from GGX's d: Heitz
    /// 2014, equation 2.
    [[nodiscard]] float pdf_of_facet(float wo_m, float d) const {
        return d * wo_m / ((1.f + lambda_o) * wo.z);
    }
    /// The facet that mirrors wo to a direction above the surface.
    struct Mirror {
        float cosine;    ///< between facet and wo
        float value;     ///< f cos where it reflects all
        float by_facet;  ///< density of the direction, 1/sr, where facets are drawn as seen
        float pdf;       ///< density of the direction, 1/sr, as draw_mirrored has it
    };
    [[nodiscard]] Mirror mirror_to(const V3f& wi) const {
        const V3f m = unit(wo + wi);
        const float wo_m = wo.dot(m), d = ggx_d(m, alpha);
        // Height-correlated masking and shadowing: Heitz 2014, equation 99.
        const float g2 = 1.f / (1.f + lambda_o + ggx_lambda(wi, alpha));
        const float value = d * g2 / (4.f * wo.z), by_facet = pdf_of_facet(wo_m, d) / (4.f * wo_m);
        return {wo_m, value, by_facet, even ? value / albedo.total() : by_facet};
    }
    /// Draws a mirror image of wo above the surface, or the same behind it. u_more: free to use.
    [[nodiscard]] std::optional<BsdfSample> draw_mirrored(float u_more, V2f u, bool behind) const {
        const V3f wi =
            even ? draw_evenly(u_more, u) : reflect(wo, ggx_sample_visible(wo, alpha, u));
        if (!(wi.z > 0.f)) return std::nullopt;
        return BsdfSample::wide(unit(behind ? mirror_below(wi) : wi));
    }

  private:
    void set_rough();
    [[nodiscard, gnu::noinline]] V3f draw_evenly(float u_more, V2f u) const;
};

/// What lobes have in common. weight: share of light.
struct Lobe {
    float chance;
    f4 weight;

    /// carried: each lane's part of what the path carries.
    void set(f4 share, f4 carried) {
        weight = share;
        chance = hsum(share * carried);
    }
    [[nodiscard]] f4 albedo(const SeenFacets&) const { return weight; }
};

/// Lambert's lobe of a body, on wo's side or behind the surface.
template <bool kBehind>
struct DiffuseLobe : Lobe {
    [[nodiscard]] BsdfValue value(const SeenFacets&, const V3f& wi) const {
        const float cosine = kBehind ? -wi.z : wi.z;
        if (!(cosine > 0.f)) return {};
        return {weight * (cosine * kInvPi), chance * cosine * kInvPi};
    }
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets&, const BsdfNumbers& u) const {
        const V3f wi = cosine_hemisphere(u.direction);
        return BsdfSample::wide(kBehind ? mirror_below(wi) : wi);
    }
};

/// Fibres above the surface.
struct SheenLobe : Lobe {
    Sheen white;

    [[nodiscard]] f4 albedo(const SeenFacets&) const { return weight * white.albedo(); }
    [[nodiscard]] BsdfValue value(const SeenFacets& seen, const V3f& wi) const {
        if (!(wi.z > 0.f)) return {};
        return {weight * white.f_cos(seen.wo, wi), chance * uniform_hemisphere_pdf()};
    }
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets&, const BsdfNumbers& u) const {
        return BsdfSample::wide(uniform_hemisphere(u.direction));
    }
};

/// Facets that mirror, of a coat and of a metal together, multiple scattering included.
struct MirrorLobe {
    float chance;
    f4 f0, f90;                  ///< reflectance f0 (1 - s) + f90 s, s being Schlick's weight
    bool measured, filmed;       ///< whether a metal of measured index, or films, reflect besides
    f4 metal, metal_n, metal_k;  ///< factor on that metal's reflectance, and its index
    FilmOver on_coat, on_metal;

    [[nodiscard]] f4 reflectance(float wo_m) const {
        const float s = schlick_weight(wo_m);
        f4 out = f0 * (1.f - s) + f90 * s;
        if (filmed) out += on_coat.reflected(wo_m) + on_metal.reflected(wo_m);
        if (measured) out += metal * fresnel_conductor(wo_m, metal_n, metal_k);
        return out;
    }
    [[nodiscard]] f4 albedo(const SeenFacets& seen) const {
        f4 out = f0 * seen.albedo.f0 + f90 * seen.albedo.f90;
        if (filmed)
            out += on_coat.weight * on_coat.mean(seen) + on_metal.weight * on_metal.mean(seen);
        // Approximation: every facet meets the light at wo's angle.
        if (measured)
            out += metal * fresnel_conductor(seen.wo.z, metal_n, metal_k) * seen.albedo.total();
        return out;
    }
    [[nodiscard]] BsdfValue value(const SeenFacets& seen, const V3f& wi) const {
        if (seen.smooth || !(wi.z > 0.f)) return {};
        const SeenFacets::Mirror at = seen.mirror_to(wi);
        return {reflectance(at.cosine) * at.value, chance * at.pdf};
    }
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets& seen,
                                                 const BsdfNumbers& u) const {
        if (!seen.smooth) return seen.draw_mirrored(u.lobe / chance, u.direction, false);
        const f4 sample_weight = reflectance(seen.wo.z) * (1.f / chance);
        return BsdfSample{mirror_below(-seen.wo), sample_weight, 0.f, true, false};
    }
};

/// Facets of a thin wall, which light passes straight: mirror images, behind the surface and in
/// proportion to their value.
struct ThinLobe : Lobe {
    [[nodiscard]] BsdfValue value(const SeenFacets& seen, const V3f& wi) const {
        if (seen.smooth || !(wi.z < 0.f)) return {};
        const float pdf = seen.mirror_to(mirror_below(wi)).pdf;
        return {weight * pdf, chance * pdf};
    }
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets& seen,
                                                 const BsdfNumbers& u) const {
        if (!seen.smooth) return seen.draw_mirrored(u.lobe / chance, u.direction, true);
        return BsdfSample{-seen.wo, weight * (1.f / chance), 0.f, true, true};
    }
};

/// Facets of glass: single scattering, reflected and refracted together. Where it disperses, it
/// draws the direction of one lane, in proportion to what the lane carries, and the density is the
/// mean over the lanes by the same proportion: single-sample MIS with the balance heuristic (Veach
/// 1997, 9.2.3; Wilkie et al. 2014, section 3.2). A smooth one leaves the drawn lane alone.
struct GlassLobe : Lobe {
    f4 tint;         ///< of what is refracted
    f4 eta;          ///< as in BsdfInput
    float specular;  ///< factor on Fresnel's reflectance
    bool disperses;  ///< eta differs from lane to lane
    int hero;        ///< as in Bands, like the next two
    m4 on;
    f4 nm;
    f4 carried;  ///< each lane's part of what the path carries
    float film_share;
    ThinFilm film;

    [[nodiscard]] f4 reflectance(float wo_m) const;
    [[nodiscard]] BsdfValue value(const SeenFacets&, const V3f& wi) const;
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets&, const BsdfNumbers&) const;

  private:
    [[nodiscard]] int draw_lane(f4 reflectance, float u, bool hero_decided) const;
};

/// What single scattering by rough glass loses, scattered more than once (glass_loss.cpp).
struct LostLobe : Lobe {
    f4 tint;         ///< of what leaves behind
    float crossing;  ///< share of the chance that goes behind
    GlassLoss loss;

    /// Takes over a part of the glass's chance, whose albedo has both.
    void split_from(GlassLobe&, const SeenFacets&);
    [[nodiscard]] f4 albedo(const SeenFacets&) const { return f4{}; }
    [[nodiscard]] BsdfValue value(const SeenFacets&, const V3f& wi) const;
    [[nodiscard]] std::optional<BsdfSample> draw(const SeenFacets&, const BsdfNumbers&) const;
};

}  // namespace petzval
