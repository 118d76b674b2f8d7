// SPDX-License-Identifier: Apache-2.0
// GGX from mirror to matt, up to grazing light.
#include <fmt/format.h>

#include <numbers>

#include "core/shading/bsdf.h"
#include "core/shading/microfacet.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

V3f at_cosine(double cosine) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {static_cast<float>(sine), 0.f, static_cast<float>(cosine)};
}

enum class Kind { Metal, Plastic, Glass };

BsdfInput white(Kind kind, double roughness, double eta = 1.5) {
    BsdfInput in;
    in.base_color = uniform(1.f, Bands::rgb());
    in.roughness = static_cast<float>(roughness);
    in.dielectric_f0 = uniform(0.04f, Bands::rgb());
    in.metallic = kind == Kind::Metal ? 1.f : 0.f;
    if (kind == Kind::Glass) in.transmission = 1.f, in.thin = false;
    in.eta = splat(static_cast<float>(eta));
    return in;
}

struct Furnace {
    double albedo = 0;
    uint32_t bad = 0;  ///< samples that are not numbers
};

constexpr uint32_t kGgxSamples = 1u << 14;

Furnace furnace(Kind kind, double roughness, double cosine, double eta = 1.5,
                uint32_t samples = kGgxSamples) {
    const Bsdf bsdf(white(kind, roughness, eta), Bands::rgb(), at_cosine(cosine));
    Furnace out;
    double sum = 0;
    for (uint32_t i = 0; i < samples; ++i) {
        const Sampler u(SamplerKind::Owen, 7, {0, 0, i});
        const auto s = bsdf.sample(u.get1(Dim::BsdfLobe), u.get2(Dim::Bsdf));
        if (!s) continue;
        const float numbers = s->weight[0] + s->wi.x + s->wi.y + s->wi.z + s->pdf;
        if (std::isfinite(numbers))
            sum += double(s->weight[0]);
        else
            ++out.bad;
    }
    out.albedo = sum / samples;
    return out;
}

constexpr double kRoughnesses[] = {0, 0.03, 0.032, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1};
constexpr double kCosines[] = {1, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6};

// Extremes of what rough glass keeps, from both sides.
struct Kept {
    double least = 1, most = 1;
    uint32_t bad = 0;

    void add(double roughness, double cosine) {
        for (const double eta : {1.1, 1 / 1.1, 1.5, 1 / 1.5, 2.4, 1 / 2.4}) {
            const Furnace f = furnace(Kind::Glass, roughness, cosine, eta, 4 * kGgxSamples);
            least = std::fmin(least, f.albedo);
            most = std::fmax(most, f.albedo);
            bad += f.bad;
        }
    }
    [[nodiscard]] std::string text() const {
        return fmt::format("loses {} and gains {} at most", percent(1 - least), percent(most - 1));
    }
};

}  // namespace

Finding ggx_energy() {
    Finding f{.method = "Energy of GGX", .fails = "bias"};
    f.sweep =
        "White metal, white plastic (F0 = 0.04) and clear glass (n = 1.5, from outside) in a white "
        "furnace: what comes back of 1, from 16384 samples, over roughness and the cosine of the "
        "angle of view.";
    f.table.columns = {
        "roughness",      "metal at cosine 1", "0.1",        "0.01",         "1e-4",
        "plastic at 0.1", "plastic at 1e-4",   "glass at 1", "glass at 0.1", "glass at 1e-4"};
    uint32_t bad = 0;
    double worst = 0, worst_roughness = 0, worst_cosine = 0;
    Kept kept, kept_grazing;
    for (const double r : kRoughnesses) {
        for (const double c : kCosines) {
            (c < 0.01 ? kept_grazing : kept).add(r, c);
            for (const Kind kind : {Kind::Metal, Kind::Plastic}) {
                const Furnace a = furnace(kind, r, c);
                bad += a.bad;
                if (!(std::fabs(a.albedo - 1) > worst)) continue;
                worst = std::fabs(a.albedo - 1), worst_roughness = r, worst_cosine = c;
            }
        }
        const auto of = [r](Kind kind, double c) { return furnace(kind, r, c).albedo; };
        add_row(f, r, of(Kind::Metal, 1), of(Kind::Metal, 0.1), of(Kind::Metal, 0.01),
                of(Kind::Metal, 1e-4), of(Kind::Plastic, 0.1), of(Kind::Plastic, 1e-4),
                of(Kind::Glass, 1), of(Kind::Glass, 0.1), of(Kind::Glass, 1e-4));
    }
    const auto grazing = [](double r) {
        return first_failure(
            1, 1e-6,
            [r](double c) { return std::fabs(furnace(Kind::Metal, r, c).albedo - 1) > 0.01; }, 4);
    };
    std::optional<double> steepest;
    for (const double r : kRoughnesses)
        if (const auto c = grazing(r); c && !(steepest && *steepest >= *c)) steepest = c;
    f.where = fmt::format(
        "Opaque: {}, worst {} at roughness {} and cosine {}. Glass of index 1.1 to 2.4, from both "
        "sides, {} from a cosine of 0.01 on, and {} below. Samples that are not numbers: {}",
        steepest ? fmt::format("metal is 1 % off below a cosine of {}", number(*steepest))
                 : std::string("metal stays within 1 % down to a cosine of 1e-6"),
        percent(worst), number(worst_roughness), number(worst_cosine), kept.text(),
        kept_grazing.text(), bad + kept.bad + kept_grazing.bad);
    f.instead =
        "Below roughness 0.032 the lobe is a mirror. What surfaces lose in single scattering "
        "comes back by tables over cosine and roughness, that of glass over its index and side "
        "too. Normals seen at cosines below 1e-3 are tilted to 1e-3.";
    return f;
}

namespace {

struct Density {
    double sampled = 0, integrated = 0;  ///< share of draws above the surface, and pdf's integral
};

// The integral of the density over the directions above, by other draws than the sampler's: normals
// by D cos (Walter et al. 2007, equations 35 and 36), of all that the metal's lobe can be.
Density density_of(double roughness, double cosine) {
    constexpr uint32_t kDraws = 1u << 17;
    const V3f wo = at_cosine(cosine);
    const Bsdf bsdf(white(Kind::Metal, roughness), Bands::rgb(), wo);
    const auto alpha = static_cast<float>(roughness * roughness);
    Density out;
    for (uint32_t i = 0; i < kDraws; ++i) {
        const Sampler sampler(SamplerKind::Owen, 8, {0, 0, i});
        const V2f u = sampler.get2(Dim::Bsdf);
        if (const auto s = bsdf.sample(sampler.get1(Dim::BsdfLobe), u); s && s->wi.z > 0)
            out.sampled += 1.0 / kDraws;
        const V2f v = sampler.get2(Dim::LightPoint);
        const double tan2 = double(alpha * alpha) * double(v.x) / (1 - double(v.x));
        const double c = 1 / std::sqrt(1 + tan2), s = std::sqrt(tan2) * c;
        const double phi = 2 * std::numbers::pi * double(v.y);
        const V3f m(static_cast<float>(s * std::cos(phi)), static_cast<float>(s * std::sin(phi)),
                    static_cast<float>(c));
        const float wo_m = wo.dot(m);
        const V3f wi = reflect(wo, m);
        if (!(wo_m > 0 && wi.z > 0)) continue;
        const double drawn = double(ggx_d(m, alpha)) * c / (4 * double(wo_m));
        out.integrated += double(bsdf.eval(wi).pdf) / drawn / kDraws;
    }
    return out;
}

}  // namespace

Finding ggx_density() {
    Finding f{.method = "Density of GGX"};
    f.sweep =
        "White metal: the integral of the density over the directions above, by 131072 draws of "
        "another kind, over the share of the sampler's own draws that end there; 1 where the two "
        "agree.";
    f.table.columns = {"roughness", "cosine 1", "0.5", "0.1", "0.01", "1e-3", "1e-4"};
    double worst = 0, worst_roughness = 0, worst_cosine = 0;
    for (const double r : {0.032, 0.05, 0.1, 0.3, 0.6, 1.}) {
        std::vector<std::string> cells{number(r)};
        for (const double c : {1., 0.5, 0.1, 1e-2, 1e-3, 1e-4}) {
            const Density d = density_of(r, c);
            const double ratio = d.integrated / d.sampled;
            cells.push_back(number(ratio));
            if (!(std::fabs(ratio - 1) > worst)) continue;
            worst = std::fabs(ratio - 1), worst_roughness = r, worst_cosine = c;
        }
        f.table.rows.push_back(cells);
    }
    f.fails = worst < 0.005 ? "nothing" : "variance";
    f.where = fmt::format("Off by {} at worst, at roughness {} and cosine {}", percent(worst),
                          number(worst_roughness), number(worst_cosine));
    if (worst < 0.005) f.where += ", by what the integral errs itself";
    f.instead =
        "Weights are f cos over the density that was evaluated, not over the one drawn "
        "with: a density that is off makes multiple importance sampling noisier.";
    return f;
}

}  // namespace petzval::stability
