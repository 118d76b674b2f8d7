// SPDX-License-Identifier: Apache-2.0
#include "core/shading/lobes.h"

#include "core/shading/ggx_albedo_table.h"
#include "core/shading/visible_facets.h"

namespace petzval {
namespace {

// Refracted direction of wo at the facet m, eta as in BsdfInput; the caller has excluded total
// reflection. Walter et al. 2007, equation 40.
V3f refract(const V3f& wo, const V3f& m, float wo_m, float eta) {
    const float cos_behind = safe_sqrt(1.f - (1.f - sqr(wo_m)) / sqr(eta));
    return m * (wo_m / eta - cos_behind) - wo * (1.f / eta);
}

}  // namespace

GgxAlbedo ggx_albedo(float cosine, float alpha) {
    constexpr int last = kGgxAlbedoSize - 1;
    const float y = std::sqrt(clamp_unit(alpha)) * last;
    const float x = std::sqrt(clamp_unit(cosine)) * last;
    const int j = std::min(static_cast<int>(y), last - 1);
    const int i = std::min(static_cast<int>(x), last - 1);
    const float fy = y - static_cast<float>(j), fx = x - static_cast<float>(i);
    const auto at = [&](int part) {
        return lerp(lerp(kGgxAlbedo[j][i][part], kGgxAlbedo[j][i + 1][part], fx),
                    lerp(kGgxAlbedo[j + 1][i][part], kGgxAlbedo[j + 1][i + 1][part], fx), fy);
    };
    const float schlick = at(1);
    return {at(0) - schlick, schlick};
}

void SeenFacets::set_rough() {
    lambda_o = ggx_lambda(wo, alpha);
    albedo = alpha.anisotropic() ? visible_albedo(wo, alpha) : ggx_albedo(wo.z, alpha.x);
}

f4 GlassLobe::reflectance(float wo_m) const {
    f4 out = fresnel_dielectric(wo_m, eta);
    if (film_share > 0.f) out = mix(out, film.reflectance(wo_m, eta, f4{}), film_share);
    return of_glass(out, specular);
}

// Refraction: Walter et al. 2007, equations 16, 17 and 21, less the factor eta^2 that turns
// radiance into basic radiance; separable masking and shadowing, equation 23.
BsdfValue GlassLobe::value(const SeenFacets& seen, const V3f& wi) const {
    if (seen.smooth || wi.z == 0.f) return {};
    if (wi.z > 0.f) {
        const SeenFacets::Mirror at = seen.mirror_to(wi);
        const f4 r = zero_off(on, reflectance(at.cosine));
        return {weight * r * at.value, chance * hsum(carried * r) * at.by_facet};
    }
    const float shadowing = 1.f / (1.f + ggx_lambda(wi, seen.alpha));
    f4 density{};  // of wi, as each lane would draw it
    for (int i = 0; i < (disperses ? 4 : 1); ++i) {
        V3f m = seen.wo + wi * eta[i];
        if (m.dot(m) < 1e-12f) continue;
        m = unit(m);
        if (m.z < 0.f) m = -m;
        const float wo_m = seen.wo.dot(m), wi_m = wi.dot(m);
        if (wo_m <= 0.f || wi_m >= 0.f) continue;
        const float jacobian = sqr(eta[i]) * -wi_m / sqr(wo_m + eta[i] * wi_m);
        const f4 passed =
            (1.f - reflectance(wo_m)) * seen.pdf_of_facet(wo_m, ggx_d(m, seen.alpha)) * jacobian;
        if (disperses)
            density[i] = passed[i];
        else
            density = passed;
    }
    return {tint * density * (weight * shadowing), chance * hsum(carried * density)};
}

// Drawn lane, -1 for reflection. All lanes reflect the same way, so reflection is drawn by their
// mean; else a lane is drawn in proportion to what of it is not reflected, and the light takes its
// way. Lanes follow each other in the circle of their wavelengths' quantiles. The rank of the lane
// that leads is a digit of a random number, and u gives the rest of it.
int GlassLobe::draw_lane(f4 reflectance, float u, bool hero_decided) const {
    const float reflected = hsum(carried * reflectance);
    if (u < reflected) return -1;
    if (!disperses) return 0;
    float left = u - reflected;
    int first = 0;
    if (!hero_decided && lane_count(on) == 4) {
        const int rank = lane_count(nm < splat(nm[hero]));
        first = hero - rank;
        left = 0.25f * (static_cast<float>(rank) * (1.f - reflected) + left);
    }
    int lane = 3;
    for (int j = 0; j < 4; ++j) {
        const int i = (first + j) & 3;
        const float chance_of_lane = carried[i] * (1.f - reflectance[i]);
        if (!(chance_of_lane > 0.f)) continue;
        lane = i;
        if (left < chance_of_lane) break;
        left -= chance_of_lane;
    }
    return lane;
}

std::optional<BsdfSample> GlassLobe::draw(const SeenFacets& seen, const BsdfNumbers& u) const {
    const V3f m = seen.smooth ? V3f(0, 0, 1) : ggx_sample_visible(seen.wo, seen.alpha, u.direction);
    const float wo_m = seen.wo.dot(m);
    if (wo_m <= 0.f) return std::nullopt;
    const f4 r = zero_off(on, reflectance(wo_m));
    const int lane = draw_lane(r, u.lobe / chance, u.hero_decided);
    const V3f wi = lane < 0 ? reflect(seen.wo, m) : refract(seen.wo, m, wo_m, eta[lane]);
    if (!seen.smooth && (wi.z > 0.f) != (lane < 0)) return std::nullopt;
    if (!seen.smooth) return BsdfSample::wide(unit(wi));
    f4 sample_weight = lane < 0 ? weight / chance : tint * (weight / chance);
    if (disperses && lane >= 0) {
        const float of_lane = sample_weight[lane] / carried[lane];
        sample_weight = f4{};
        sample_weight[lane] = of_lane;
    } else if (disperses || film_share > 0.f) {
        // Not where lanes are alike: no rounding, so that nothing is gained or lost.
        const float reflected = hsum(carried * r);
        sample_weight *= lane < 0 ? r / reflected : (1.f - r) / (1.f - reflected);
    }
    return BsdfSample{wi, sample_weight, 0.f, true, lane >= 0};
}

}  // namespace petzval
