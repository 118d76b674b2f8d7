// SPDX-License-Identifier: Apache-2.0
// BSDF of a glTF surface: a budget of the light, and the list of lobes that share it.
#pragma once

#include <optional>
#include <tuple>

#include "core/shading/lobes.h"
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

/// Straight transmission through a thin, smooth surface.
struct StraightThrough {
    f4 value{};        ///< share of light
    float chance = 0;  ///< that Bsdf::sample draws it
};

/// BSDF for one wo. Directions point away from the surface, in the shading frame turned to wo's
/// side (wo.z > 0). Paths carry basic radiance L / n^2 (Nicodemus 1963), so refraction scales
/// nothing and no weight's mean exceeds 1.
///
/// The surface proper may have another normal, `up`, than the shading frame. A direction that the
/// lobes put on the wrong side of it is mirrored at its plane, in value, density and samples alike:
/// an idea of Schuessler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path
/// Tracing". docs/design/house.md says why at this plane.
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
                                                   bool hero_decided = true) const;
    /// Whether some lobe is wide enough for light sampling to help.
    [[nodiscard]] bool has_wide_lobe() const {
        return !seen_.smooth || diffuse_.chance + behind_.chance + sheen_.chance > 0;
    }
    /// Whether it is clear glass: what it lets through, it neither blurs nor scatters.
    [[nodiscard]] bool is_clear() const { return seen_.smooth && thin_.chance + glass_.chance > 0; }
    /// Share of light that goes straight through; nothing unless the surface is thin and smooth.
    [[nodiscard]] StraightThrough straight_through() const {
        return seen_.smooth ? StraightThrough{thin_.weight, thin_.chance} : StraightThrough{};
    }
    /// Share of light that is scattered, all lobes together (glass: as if its tint were white).
    [[nodiscard]] f4 albedo() const;

  private:
    /// The list of lobes, in the order in which they are added up and drawn.
    template <class Self>
    [[nodiscard]] static auto lobes(Self& self) {
        return std::tie(self.diffuse_, self.behind_, self.sheen_, self.mirror_, self.thin_,
                        self.glass_, self.lost_);
    }
    [[nodiscard]] V3f mirrored_at_surface(const V3f& w) const { return w - up_ * (2 * w.dot(up_)); }
    [[nodiscard]] BsdfValue eval_lobes(const V3f& wi) const;
    [[nodiscard]] BsdfValue eval_tilted(const V3f& wi) const;
    /// Sets the mirror, and returns what the coat keeps from the body.
    [[nodiscard]] f4 add_mirror(const BsdfInput&, const Bands&, f4 carried, float metal_part,
                                float coat_part);

    SeenFacets seen_;
    V3f up_;
    bool tilted_;  ///< up is not z
    DiffuseLobe<false> diffuse_;
    DiffuseLobe<true> behind_;
    SheenLobe sheen_;
    MirrorLobe mirror_;
    ThinLobe thin_;
    GlassLobe glass_;
    LostLobe lost_;
};

}  // namespace petzval
