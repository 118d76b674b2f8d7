// SPDX-License-Identifier: Apache-2.0
// BSDF of a glTF surface: sheen over one GGX reflection over a diffuse, thin or glass body.
#pragma once

#include <optional>

#include "core/math/math.h"
#include "core/shading/glass_loss.h"
#include "core/shading/microfacet.h"
#include "core/shading/sheen.h"
#include "core/shading/thin_film.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// Parameters of a material at a point, textures applied. Shares of light are per lane.
struct BsdfInput {
    f4 base_color{};
    float metallic = 0, roughness = 1;
    f4 dielectric_f0{};        ///< reflectance at normal incidence, KHR_materials_specular included
    float dielectric_f90 = 1;  ///< at grazing incidence
    float transmission = 0;
    f4 eta = splat(1.5f);    ///< index on the far side over index on wo's side
    bool disperses = false;  ///< eta differs from lane to lane
    bool thin = true;        ///< transmission without a volume: nothing bends
    /// Whether the metallic part has the index metal_n + i metal_k instead of base_color.
    bool measured_metal = false;
    f4 metal_n{}, metal_k{};

    /// KHR_materials_anisotropy: strength, and the direction of the wide lobe is x of the frame.
    float anisotropy = 0;
    /// KHR_materials_iridescence: how much of the surface has a film, and which. Its index is over
    /// that outside the material, from both sides; over glass it is over the index on wo's side.
    float film_share = 0, film_index = 1.3f, film_index_on_glass = 1.3f, film_thickness_nm = 0;
    f4 sheen{};                                 ///< KHR_materials_sheen: its colour
    float sheen_most = 0, sheen_roughness = 0;  ///< most: of the colour's R, G and B
    /// KHR_materials_diffuse_transmission: share of the diffuse light that leaves behind.
    float diffuse_transmission = 0;
    f4 diffuse_transmission_color{};
};

/// Value f cos and its density; both 0 where only a delta lobe could answer.
struct BsdfValue {
    f4 f_cos{};
    float pdf = 0;  ///< 1/sr
};

/// Straight transmission through a thin, smooth surface.
struct StraightThrough {
    f4 value{};        ///< share of light
    float chance = 0;  ///< that Bsdf::sample draws it
};

struct BsdfSample {
    V3f wi;
    f4 weight;  ///< f cos / pdf
    float pdf;  ///< 1/sr; meaningless for a delta lobe
    bool delta;
    bool transmitted;  ///< wi lies on the other side
};

/// BSDF for one wo. Directions point away from the surface, in the shading frame turned to wo's
/// side (wo.z > 0). Paths carry basic radiance L / n^2 (Nicodemus 1963), so refraction scales
/// nothing and no weight's mean exceeds 1.
///
/// A dispersive lobe draws the direction of one lane, in proportion to what the lane carries, and
/// the density is the mean over the lanes by the same proportion: single-sample MIS with the
/// balance heuristic (Veach 1997, 9.2.3; Wilkie et al. 2014, section 3.2). A delta lobe leaves the
/// drawn lane alone.
///
/// The surface proper may have another normal, `up`, than the shading frame. A direction that the
/// lobes put on the wrong side of it is mirrored at its plane, in value, density and samples alike:
/// the surface is a microsurface, whose neighbouring slopes send on what the shaded one sends into
/// them. The second, mirroring facet is the idea of Schuessler et al. 2017, "Microfacet-based
/// Normal Mapping for Robust Monte Carlo Path Tracing"; here it lies in the surface, as mirroring
/// keeps solid angles, so that no light is lost or gained at any tilt.
class Bsdf {
  public:
    /// throughput: what each lane of the path carries, not all 0; it steers what is drawn. up: unit
    /// normal of the surface in the shading frame, on wo's side; z where both are the same.
    Bsdf(const BsdfInput&, const Bands&, const V3f& wo, f4 throughput = splat(1.f),
         const V3f& up = V3f(0, 0, 1));

    [[nodiscard]] BsdfValue eval(const V3f& wi) const {
        return tilted_ ? eval_tilted(wi) : eval_lobes(wi);
    }
    /// Draws a direction: u_lobe picks the lobe and the lane, u the direction. Nothing where that
    /// is absorbed. hero_decided: the choice of the hero lane (Bands::hero) has decided something
    /// already; otherwise it picks the lane, which then is the hero wherever all carry the same.
    [[nodiscard]] std::optional<BsdfSample> sample(float u_lobe, V2f u,
                                                   bool hero_decided = true) const {
        return tilted_ ? sample_tilted(u_lobe, u, hero_decided)
                       : sample_lobes(u_lobe, u, hero_decided);
    }
    /// Whether some lobe is wide enough for light sampling to help.
    [[nodiscard]] bool has_wide_lobe() const {
        return p_diffuse_ > 0 || !delta_ || p_behind_ > 0 || p_sheen_ > 0;
    }
    /// Whether it is clear glass: what it lets through, it neither blurs nor scatters.
    [[nodiscard]] bool is_clear() const { return delta_ && p_thin_ + p_glass_ > 0; }
    /// Share of light that goes straight through; nothing unless the surface is thin and smooth.
    [[nodiscard]] StraightThrough straight_through() const {
        return delta_ ? StraightThrough{thin_, p_thin_} : StraightThrough{};
    }
    /// Share of light that is scattered, all lobes together (glass: as if its tint were white).
    [[nodiscard]] f4 albedo() const;

  private:
    [[nodiscard]] V3f mirrored_at_surface(const V3f& w) const { return w - up_ * (2 * w.dot(up_)); }
    [[nodiscard]] bool on_its_side(const V3f& w) const { return (w.z > 0.f) == (w.dot(up_) > 0.f); }
    [[nodiscard]] BsdfValue eval_lobes(const V3f& wi) const;
    [[nodiscard]] BsdfValue eval_tilted(const V3f& wi) const;
    [[nodiscard]] std::optional<BsdfSample> sample_lobes(float u_lobe, V2f u,
                                                         bool hero_decided) const;
    [[nodiscard]] std::optional<BsdfSample> sample_tilted(float u_lobe, V2f u,
                                                          bool hero_decided) const;
    [[nodiscard]] float pdf_of_normal(float wo_m, float d) const;
    void add_glass(const V3f& wi, BsdfValue&) const;
    void add_lost(const V3f& wi, BsdfValue&) const;
    [[nodiscard]] V3f draw_lost(float u_side, V2f u) const;
    [[nodiscard]] f4 glass_reflectance(float wo_m) const;
    [[nodiscard]] f4 specular_reflectance(float wo_m) const;
    // Apart, so that surfaces without a film pay a branch and no registers.
    [[nodiscard, gnu::noinline]] f4 film_reflectance(float wo_m) const;
    [[nodiscard, gnu::noinline]] f4 with_film(f4 bare, float wo_m) const;
    /// Reflectances with the film: at normal incidence, mixed with those without it, and of the
    /// film alone on average over the facets that wo sees.
    struct FilmMeans {
        f4 coat_f0, metal_f0, coat, metal;
    };
    [[nodiscard, gnu::noinline]] FilmMeans means_of_film(const BsdfInput&, const Bands&,
                                                         f4 metal_f0);
    [[nodiscard, gnu::noinline]] f4 lost_by_two_widths() const;
    [[nodiscard, gnu::noinline]] f4 lost_below_film() const;
    [[gnu::noinline]] void add_sheen(const BsdfInput&);
    [[nodiscard]] int draw_lane(f4 reflectance, float u, bool hero_decided) const;
    [[nodiscard]] std::optional<BsdfSample> sample_delta(float u_lobe, bool hero_decided) const;
    [[nodiscard]] std::optional<V3f> draw(float u_lobe, V2f u, bool hero_decided) const;
    [[nodiscard, gnu::noinline]] std::optional<V3f> draw_evenly(float u_more, V2f u) const;

    V3f wo_, up_;
    bool tilted_;  ///< up is not z
    GgxWidth alpha_;
    f4 eta_, share_;  ///< share_: each lane's part of what the path carries
    bool disperses_, delta_;
    bool even_weights_;  ///< reflections are drawn in proportion to their value
    float lambda_o_;
    // Reflection: single-scatter GGX times spec0 (1 - s) + spec90 s, multiple scattering included.
    f4 spec0_, spec90_;
    bool measured_metal_;
    f4 metal_;                      ///< factor on what a measured metal reflects
    float albedo_f0_, albedo_f90_;  ///< of GGX alone, for wo
    f4 diffuse_;                    ///< albedo
    f4 behind_;                     ///< albedo of what leaves diffusely on the other side
    f4 thin_;                       ///< albedo of straight transmission
    f4 glass_;                      ///< tint of refracted light; its untinted share is glass_share_
    float glass_share_, glass_specular_;
    GlassLoss loss_;                     ///< of rough glass
    f4 lost_;                            ///< its share of the light from wo
    float p_lost_ = 0, p_crossing_ = 0;  ///< chance of multiple scattering in glass, and then to
                                         ///< the other side
    f4 sheen_colour_;
    Sheen sheen_;  ///< set where p_sheen_ > 0
    ThinFilm film_, film_on_glass_;
    float film_share_;
    f4 film_coat_, film_metal_;  ///< factors on what a film on the coat and on the metal reflects
    f4 coat_n_, metal_n_, metal_k_;  ///< indices below the film, and of a measured metal
    f4 film_albedo_;                 ///< of both films, for wo
    float p_spec_, p_diffuse_, p_thin_, p_glass_, p_behind_ = 0, p_sheen_ = 0;
    m4 on_;
    int hero_, rank_of_hero_ = 0;  ///< rank: number of wavelengths below the hero
};

}  // namespace petzval
