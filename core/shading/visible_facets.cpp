// SPDX-License-Identifier: Apache-2.0
#include "core/shading/visible_facets.h"

#include <bit>

#include "core/shading/lobes.h"

namespace petzval {
namespace {

// Lattices of rank 1 (Niederreiter 1992, "Random Number Generation and Quasi-Monte Carlo Methods",
// 5.1): point i of n is (i k / n, (i + 1/2) / n). Of the k that were tried, these err least.
constexpr int kMany = 192;
constexpr float kManyStep = 75.f / kMany, kFewStep = 13.f / FewFacets::kCount;

f8 numbers_from(float first) {
    return splat8(first) + f8{0, 1, 2, 3, 4, 5, 6, 7};
}

f8 fifth_power(f8 a) {
    return a * a * (a * a) * a;
}

/// Facets that are seen from wo, eight at a time.
class Facets {
  public:
    Facets(const V3f& wo, const GgxWidth& alpha)
        : wo_(wo),
          alpha_(alpha),
          stretched_(unit({wo.x * alpha.x, wo.y * alpha.y, wo.z})),
          lambda_o_(ggx_lambda(wo, alpha)) {}

    struct Eight {
        f8 x, y, z;            ///< normals
        f8 cosine, reflected;  ///< as in FewFacets, but for the number of them
    };
    /// Facets at azimuths of this sine and cosine; v: second coordinate of the lattice.
    [[nodiscard]] Eight at(f8 sine, f8 cosine, f8 v) const {
        const f8 zero{};
        const f8 cap_z = 1.f - v * (1.f + stretched_.z);
        const f8 cap_r = sqrt(max(1.f - cap_z * cap_z, zero));
        const f8 hx = (cap_r * cosine + stretched_.x) * alpha_.x;
        const f8 hy = (cap_r * sine + stretched_.y) * alpha_.y;
        const f8 hz = max(cap_z + stretched_.z, splat8(1e-9f));
        const f8 scale = 1.f / sqrt(hx * hx + hy * hy + hz * hz);
        const f8 facing = max((hx * wo_.x + hy * wo_.y + hz * wo_.z) * scale, zero);
        const f8 x = hx * scale, y = hy * scale, z = hz * scale, twice = 2.f * facing;
        const f8 up = z * twice - wo_.z;
        const f8 behind = lambda(x * twice - wo_.x, y * twice - wo_.y, up);
        const f8 leaves = (1.f + lambda_o_) / (1.f + lambda_o_ + behind);
        return {x, y, z, facing, up > 1e-6f ? leaves : zero};
    }
    /// Share of what these facets refract that leaves: Walter et al. 2007, equations 23 and 40.
    [[nodiscard]] f8 refracted(const Eight& at, float eta) const {
        const f8 zero{};
        const f8 cos2 = 1.f - (1.f - at.cosine * at.cosine) / sqr(eta);
        const f8 along = at.cosine / eta - sqrt(max(cos2, zero));
        const f8 down = at.z * along - wo_.z / eta;
        const f8 masked = lambda(at.x * along - wo_.x / eta, at.y * along - wo_.y / eta, down);
        return cos2 > 0.f && down < -1e-6f ? 1.f / (1.f + masked) : zero;
    }

  private:
    [[nodiscard]] f8 lambda(f8 x, f8 y, f8 z) const {
        const f8 tan2 = (x * x + y * y * alpha_.y_per_x2) / (z * z);
        return 0.5f * (sqrt(1.f + sqr(alpha_.x) * tan2) - 1.f);
    }

    V3f wo_;
    GgxWidth alpha_;
    V3f stretched_;
    float lambda_o_;
};

/// Calls visit with all facets of the long lattice, eight by eight.
template <class Visit>
void for_many(const Facets& facets, const Visit& visit) {
    f8 sine, cosine;
    for (int i = 0; i < 8; ++i) {
        const SinCos at = sincos_turns(static_cast<float>(i) * kManyStep);
        sine[i] = at.sine;
        cosine[i] = at.cosine;
    }
    const SinCos step = sincos_turns(8 * kManyStep);
    for (int i = 0; i < kMany; i += 8) {
        visit(
            facets.at(sine, cosine, (numbers_from(static_cast<float>(i)) + 0.5f) * (1.f / kMany)));
        const f8 turned = sine * step.cosine + cosine * step.sine;
        cosine = cosine * step.cosine - sine * step.sine;
        sine = turned;
    }
}

}  // namespace

GgxAlbedo visible_albedo(const V3f& wo, const GgxWidth& alpha) {
    const Facets facets(wo, alpha);
    f8 all{}, schlick{};
    for_many(facets, [&](const Facets::Eight& met) {
        all += met.reflected;
        schlick += met.reflected * fifth_power(1.f - met.cosine);
    });
    const float f90 = hsum(schlick) * (1.f / kMany);
    return {hsum(all) * (1.f / kMany) - f90, f90};
}

float visible_glass_loss(const V3f& wo, const GgxWidth& alpha, float eta, float specular) {
    const Facets facets(wo, alpha);
    f8 left{};
    for_many(facets, [&](const Facets::Eight& met) {
        const f8 reflectance = of_glass(fresnel_dielectric(met.cosine, eta), specular);
        left += reflectance * met.reflected + (1.f - reflectance) * facets.refracted(met, eta);
    });
    return clamp_unit(1.f - hsum(left) * (1.f / kMany));
}

FewFacets few_visible_facets(const V3f& wo, const GgxWidth& alpha, float eta) {
    constexpr int count = FewFacets::kCount;
    const Facets facets(wo, alpha);
    FewFacets out;
    for (int i = 0; i < count; i += 8) {
        f8 sine, cosine;
        for (int j = 0; j < 8; ++j) {
            const SinCos at = sincos_turns(static_cast<float>(i + j) * kFewStep);
            sine[j] = at.sine;
            cosine[j] = at.cosine;
        }
        const f8 v = (numbers_from(static_cast<float>(i)) + 0.5f) * (1.f / count);
        const Facets::Eight met = facets.at(sine, cosine, v);
        const f8 refracted = facets.refracted(met, eta);
        for (int j = 0; j < 8 && i + j < count; ++j) {
            const auto at = static_cast<size_t>(i + j);
            out.cosine[at] = met.cosine[j];
            out.reflected[at] = met.reflected[j] * (1.f / count);
            out.refracted[at] = refracted[j] * (1.f / count);
        }
    }
    return out;
}

// Facets are drawn until one is met whose light leaves, with the share that masking lets go on.
V3f SeenFacets::draw_evenly(float u_more, V2f u) const {
    constexpr uint32_t tries = 64;  // a try fails in three of four cases at most
    const uint32_t seed =
        hash32(std::bit_cast<uint32_t>(u_more),
               hash32(std::bit_cast<uint32_t>(u.x), std::bit_cast<uint32_t>(u.y)));
    const float all = 1.f + lambda_o;
    for (uint32_t i = 0; i < tries; ++i) {
        const V3f wi = reflect(wo, ggx_sample_visible(wo, alpha, u));
        if (wi.z > 0.f && to_unit_float(hash32(seed, 3 * i)) * (all + ggx_lambda(wi, alpha)) < all)
            return wi;
        u = V2f(to_unit_float(hash32(seed, 3 * i + 1)), to_unit_float(hash32(seed, 3 * i + 2)));
    }
    return V3f(0.f);
}

}  // namespace petzval
