// SPDX-License-Identifier: Apache-2.0
// What few surfaces ask of the facets that are seen from one direction: averages that no table has,
// of two widths and of reflectances that no Schlick weight describes; and SeenFacets::draw_evenly.
#pragma once

#include <array>

#include "core/shading/microfacet.h"

namespace petzval {

/// Directional albedo of a GGX lobe of two widths, by 192 facets that a lattice picks in proportion
/// to what is seen of them. Against quadrature with 16,384 facets, widths from 0.001 to 1, cosines
/// from 0.01 to 1: total() is off by 0.25 % in the mean square, by 1 % at most.
[[nodiscard]] GgxAlbedo visible_albedo(const V3f& wo, const GgxWidth& alpha);

/// Share of the light from wo that single scattering at glass of two widths loses, reflection and
/// refraction together, by as many facets. eta: index behind over that in front; specular: factor
/// on Fresnel's reflectance.
[[nodiscard]] float visible_glass_loss(const V3f& wo, const GgxWidth& alpha, float eta,
                                       float specular);

/// A few facets as seen from wo, which stand for all of them.
struct FewFacets {
    static constexpr int kCount = 21;
    std::array<float, kCount> cosine;  ///< between facet and wo
    /// Shares of the light that leave again, of what facets reflect and of what they refract; each
    /// adds up to 1 at most.
    std::array<float, kCount> reflected, refracted;
};
/// eta: index behind over that in front, for what is refracted.
[[nodiscard]] FewFacets few_visible_facets(const V3f& wo, const GgxWidth& alpha, float eta);

}  // namespace petzval
