// SPDX-License-Identifier: Apache-2.0
#include "core/shading/bsdf.h"

namespace petzval {
namespace {

// KHR_materials_anisotropy: the lobe is widened along x.
GgxWidth width_of(const BsdfInput& in) {
    const float alpha = sqr(in.roughness), wide = lerp(alpha, 1.f, sqr(in.anisotropy));
    if (in.anisotropy == 0.f || wide < kSmallestAlpha) return alpha;
    return {wide, std::max(alpha, kSmallestAlpha)};
}

// A sample of the lobe in whose share of [0, 1) the number for the lobe lies.
template <class Lobe, class... Others>
std::optional<BsdfSample> draw_first(const SeenFacets& seen, BsdfNumbers u, const Lobe& lobe,
                                     const Others&... others) {
    if (u.lobe < lobe.chance) return lobe.draw(seen, u);
    u.lobe -= lobe.chance;
    if constexpr (sizeof...(others) > 0)
        return draw_first(seen, u, others...);
    else
        return std::nullopt;  // the chances add up to 1 but for a rounding
}

}  // namespace

// Energy lost by single scattering comes back by Turquin 2019, "Practical multiple scattering
// compensation for microfacet models", equation 16, for the coat and for the metal.
[[gnu::always_inline]] inline f4 Bsdf::add_mirror(const BsdfInput& in, const Bands& bands,
                                                  f4 carried, float metal_part, float coat_part) {
    const GgxAlbedo ggx = seen_.albedo;
    MirrorLobe& out = mirror_;
    const f4 one = uniform(1.f, bands), coat_f90 = one * in.dielectric_f90;
    out.filmed = in.film_share > 0.f;
    out.measured = in.measured_metal && in.metallic > 0.f;
    out.metal_n = in.metal_n;
    out.metal_k = in.metal_k;
    const f4 bare_metal_f0 =
        out.measured ? zero_off(bands.on, fresnel_conductor(1.f, in.metal_n, in.metal_k))
                     : in.base_color;
    // Reflectance at normal incidence, and what single scattering reflects of the light from wo.
    f4 coat_f0 = in.dielectric_f0, coat = in.dielectric_f0 * ggx.f0 + coat_f90 * ggx.f90;
    f4 metal_f0 = bare_metal_f0, metal = metal_f0 * ggx.f0 + ggx.f90;
    if (out.filmed) {
        const ThinFilm film(in.film_index, in.film_thickness_nm, bands);
        const float specular = in.dielectric_f90;
        const f4 bare_coat_f0 = specular > 0.f ? in.dielectric_f0 / specular : f4{};
        out.on_coat = {film, index_for_reflectance(bare_coat_f0), f4{}, bands.on, f4{}};
        out.on_metal = {film, index_for_reflectance(metal_f0), f4{}, bands.on, f4{}};
        if (out.measured) out.on_metal = {film, in.metal_n, in.metal_k, bands.on, f4{}};
        const auto cover = [&](const FilmOver& by, float most, f4& f0, f4& reflected) {
            f0 = mix(f0, by.reflectance(1.f) * most, in.film_share);
            reflected = mix(reflected, by.mean(seen_) * most, in.film_share);
        };
        if (in.metallic < 1.f) cover(out.on_coat, specular, coat_f0, coat);
        if (in.metallic > 0.f) cover(out.on_metal, 1.f, metal_f0, metal);
    }
    const float lost = (1.f - ggx.total()) / ggx.total();
    const f4 coat_gain = one + coat_f0 * lost;
    out.metal = (one + metal_f0 * lost) * metal_part;
    out.f0 = in.dielectric_f0 * coat_gain * coat_part;
    out.f90 = coat_f90 * coat_gain * coat_part;
    const f4 of_coat =
        out.filmed ? coat * coat_gain * coat_part : out.f0 * ggx.f0 + out.f90 * ggx.f90;
    out.chance = hsum((of_coat + out.metal * metal) * carried);
    if (out.filmed) {
        out.on_coat.weight = out.f90 * in.film_share;
        out.on_metal.weight = out.metal * in.film_share;
        for (f4* const bare : {&out.f0, &out.f90, &out.metal}) *bare *= 1.f - in.film_share;
    }
    if (!out.measured) {
        out.f0 += bare_metal_f0 * out.metal;
        out.f90 += out.metal;
    }
    return coat * coat_gain;
}

// Layers as in the glTF 2.0 specification, appendix B, from the top: a sheen over all takes what it
// scatters by the strongest of its colours, as KHR_materials_sheen says; below it lies metal beside
// a dielectric coat; the coat's body gets what the coat leaves. How likely a lobe is drawn follows
// from what it makes of the light that the path carries.
Bsdf::Bsdf(const BsdfInput& in, const Bands& bands, const V3f& wo, f4 throughput, const V3f& up)
    : seen_(wo, width_of(in)), up_(up), tilted_(up != V3f(0, 0, 1)) {
    f4 carried = zero_off(bands.on, throughput);
    carried *= 1.f / hsum(carried);
    float under = 1.f;
    sheen_.chance = lost_.chance = 0.f;
    if (in.sheen_most > 0.f) {
        sheen_.white = Sheen(in.sheen_roughness, wo.z);
        const float scattered = sheen_.white.albedo();
        sheen_.set(in.sheen, carried);
        sheen_.chance *= scattered;
        under -= in.sheen_most * scattered;
    }
    const float metal = in.metallic * under, dielectric = (1.f - in.metallic) * under;
    const float glass = in.thin ? 0.f : in.transmission, opaque = 1.f - in.transmission;
    const f4 one = uniform(1.f, bands);
    const f4 below = one - add_mirror(in, bands, carried, metal, dielectric * (1.f - glass));
    const f4 body = in.base_color * below * dielectric;

    diffuse_.set(body * opaque * (1.f - in.diffuse_transmission), carried);
    behind_.set(
        in.diffuse_transmission_color * below * (dielectric * opaque * in.diffuse_transmission),
        carried);
    thin_.set(in.thin ? body * in.transmission : f4{}, carried);
    glass_.chance = dielectric * glass;
    if (glass_.chance > 0.f) {
        const Lobe share{glass_.chance, one * glass_.chance};
        glass_ = {share,        in.base_color, in.eta,   in.dielectric_f90,
                  in.disperses, bands.hero,    bands.on, bands.nm,
                  carried,      in.film_share, {}};
        if (in.film_share > 0.f)
            glass_.film = ThinFilm(in.film_index_on_glass, in.film_thickness_nm, bands);
    }

    seen_.even = !seen_.smooth && thin_.chance + glass_.chance + behind_.chance > 0.f;
    // Not in the list's order, by which old pictures would change in the last bits.
    const float sum = mirror_.chance + diffuse_.chance + thin_.chance + glass_.chance +
                      (behind_.chance + sheen_.chance);
    const float scale = sum > 0.f ? 1.f / sum : 0.f;
    std::apply([&](auto&... lobe) { ((lobe.chance *= scale), ...); }, lobes(*this));
    if (glass_.chance > 0.f && !seen_.smooth) lost_.split_from(glass_, seen_);
}

f4 Bsdf::albedo() const {
    const auto of = [&](const auto& lobe) { return lobe.chance > 0.f ? lobe.albedo(seen_) : f4{}; };
    return std::apply([&](const auto&... lobe) { return (... + of(lobe)); }, lobes(*this));
}

BsdfValue Bsdf::eval_lobes(const V3f& wi) const {
    BsdfValue sum;
    const auto add = [&](const auto& lobe) {
        if (lobe.chance != 0.f) sum += lobe.value(seen_, wi);  // of what is no number, too
    };
    std::apply([&](const auto&... lobe) { (add(lobe), ...); }, lobes(*this));
    return sum;
}

BsdfValue Bsdf::eval_tilted(const V3f& wi) const {
    // Light leaves towards wi on either of two ways that end on the same side.
    BsdfValue sum;
    for (const V3f& way : {wi, mirrored_at_surface(wi)})
        if ((way.z > 0.f) == (wi.dot(up_) > 0.f)) sum += eval_lobes(way);
    return sum;
}

std::optional<BsdfSample> Bsdf::sample(float u_lobe, V2f u, bool hero_decided) const {
    const BsdfNumbers numbers{u_lobe, u, hero_decided};
    const auto draw = [&](const auto&... lobe) { return draw_first(seen_, numbers, lobe...); };
    std::optional<BsdfSample> drawn = std::apply(draw, lobes(*this));
    if (!drawn) return drawn;
    if (tilted_ && (drawn->wi.z > 0.f) != (drawn->wi.dot(up_) > 0.f))
        drawn->wi = mirrored_at_surface(drawn->wi);
    if (!drawn->delta && !drawn->weigh(eval(drawn->wi))) drawn.reset();
    return drawn;
}

}  // namespace petzval
