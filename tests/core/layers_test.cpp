// SPDX-License-Identifier: Apache-2.0
// The layers of glTF's material extensions: coat, sheen, two widths, thin films, light behind.
#include <gtest/gtest.h>

#include <numbers>

#include "core/shading/coated_bsdf.h"
#include "core/shading/visible_facets.h"
#include "tests/support/chi_square.h"

namespace petzval {
namespace {

V3f from_cosine(float cosine, float azimuth = 0.7f) {
    const float sine = safe_sqrt(1 - sqr(cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

struct Layered {
    BsdfInput in;
    CoatInput coat;
};

Layered white(float roughness, float metallic = 0) {
    Layered out;
    out.in.base_color = uniform(1.f, Bands::rgb());
    out.in.roughness = roughness;
    out.in.metallic = metallic;
    out.in.dielectric_f0 = uniform(0.04f, Bands::rgb());
    return out;
}
Layered coated(Layered l, float roughness, float weight = 1, V3f normal = {0, 0, 1}) {
    l.coat = {weight, roughness, normal};
    return l;
}
Layered with_sheen(Layered l, float roughness, Rgb colour = Rgb(1.f)) {
    l.in.sheen = colour.v;
    l.in.sheen_most = hmax(colour.v);
    l.in.sheen_roughness = roughness;
    return l;
}
Layered brushed(Layered l, float strength) {
    l.in.anisotropy = strength;
    return l;
}
Layered filmed(Layered l, float thickness_nm, float index = 1.3f, float share = 1) {
    l.in.film_share = share;
    l.in.film_index = index;
    l.in.film_thickness_nm = thickness_nm;
    return l;
}
Layered leaf(Layered l, float share) {
    l.in.diffuse_transmission = share;
    l.in.diffuse_transmission_color = uniform(1.f, Bands::rgb());
    return l;
}
Layered glass(float roughness, float eta, bool thin = false) {
    Layered out = white(roughness);
    out.in.transmission = 1;
    out.in.thin = thin;
    out.in.eta = splat(eta);
    return out;
}

CoatedBsdf bsdf_of(const Layered& l, const V3f& wo, const V3f& up = V3f(0, 0, 1)) {
    return {l.in, l.coat, Bands::rgb(), wo, splat(1.f), up};
}

// Mean weight over a jittered grid: lobes along one axis, directions along the two others.
V3f layered_albedo(const Layered& l, const V3f& wo, const V3f& up = V3f(0, 0, 1)) {
    const CoatedBsdf bsdf = bsdf_of(l, wo, up);
    constexpr int lobes = 24, side = 64;
    test::Random random(7);
    V3d sum(0.);
    for (int k = 0; k < lobes; ++k)
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const auto within = [&](int cell, int cells) {
                    return std::min(
                        (static_cast<float>(cell) + random.next()) / static_cast<float>(cells),
                        kOneMinus);
                };
                const float u_lobe = within(k, lobes), x = within(i, side), y = within(j, side);
                if (const auto s = bsdf.sample(u_lobe, {x, y}))
                    sum += V3d(double(s->weight[0]), double(s->weight[1]), double(s->weight[2]));
            }
    return V3f(sum / (lobes * side * side));
}

constexpr float kLayerCosines[] = {0.05f, 0.2f, 0.5f, 0.8f, 1.f};
constexpr float kLayerRoughnesses[] = {0.f, 0.1f, 0.3f, 0.6f, 1.f};

void expect_white(const Layered& l, float cosine, const std::string& what,
                  const V3f& up = V3f(0, 0, 1), float tolerance = 0.01f) {
    const V3f albedo = layered_albedo(l, from_cosine(cosine), up);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(albedo[c], 1.f, tolerance)
            << what << ", roughness " << l.in.roughness << ", metallic " << l.in.metallic
            << ", cosine " << cosine << ", channel " << c;
}

TEST(Coat, KeepsWhiteWhite) {
    for (const float metallic : {0.f, 1.f})
        for (const float roughness : kLayerRoughnesses)
            for (const float coat : kLayerRoughnesses)
                for (const float cosine : kLayerCosines)
                    expect_white(coated(white(roughness, metallic), coat, 0.8f), cosine,
                                 "coat " + std::to_string(coat));
}

TEST(Coat, KeepsWhiteWhiteAboutNormalsOfItsOwn) {
    for (const float roughness : {0.f, 0.3f, 1.f})
        for (const float coat : {0.f, 0.3f})
            for (const float cosine : {0.5f, 0.9f})
                expect_white(coated(white(roughness), coat, 1, from_cosine(0.9f, 2.f)), cosine,
                             "coat " + std::to_string(coat), from_cosine(0.95f, 4.f));
}

// What a coat reflects about a normal of its own leaves on the surface's own side.
TEST(Coat, SamplesLieOnTheSurfacesSide) {
    const V3f up = from_cosine(0.6f, 2.2f), wo = from_cosine(0.7f);
    for (const float roughness : {0.f, 0.5f}) {
        const CoatedBsdf bsdf =
            bsdf_of(coated(white(0.6f), roughness, 1, from_cosine(0.75f, 4.5f)), wo, up);
        test::Random random(4);
        for (int i = 0; i < 4000; ++i) {
            const float u_lobe = random.next();
            const auto s = bsdf.sample(u_lobe, random.next2());
            if (s) {
                EXPECT_GT(s->wi.dot(up), 0.f) << roughness;
            }
        }
    }
}

// Fresnel's share of a smooth coat over black is all that is seen of it.
TEST(Coat, ReflectsSchlicksShare) {
    Layered black = coated(white(0.5f), 0.f, 0.7f);
    black.in.base_color = f4{};
    black.in.dielectric_f0 = f4{};
    black.in.dielectric_f90 = 0;
    for (const float cosine : kLayerCosines) {
        const float schlick = 0.04f + 0.96f * std::pow(1 - cosine, 5.f);
        EXPECT_NEAR(layered_albedo(black, from_cosine(cosine)).x, 0.7f * schlick, 2e-4f) << cosine;
        EXPECT_NEAR(bsdf_of(black, from_cosine(cosine)).albedo()[0], 0.7f * schlick, 1e-6f);
    }
}

TEST(Coat, OverAPaneTintsWhatGoesStraight) {
    const V3f wo = from_cosine(0.6f);
    const Layered pane = glass(0.f, 1.5f, true);
    const StraightThrough bare = bsdf_of(pane, wo).straight_through();
    const StraightThrough with_coat = bsdf_of(coated(pane, 0.f), wo).straight_through();
    const float left = 1 - (0.04f + 0.96f * std::pow(0.4f, 5.f));
    EXPECT_NEAR(with_coat.value[1], bare.value[1] * left, 1e-6f);
    EXPECT_GT(with_coat.chance, 0.f);
    EXPECT_LT(with_coat.chance, bare.chance);
    // What is drawn carries what is said.
    const auto s = bsdf_of(coated(pane, 0.f), wo).sample(0.9f, {0.5f, 0.5f});
    ASSERT_TRUE(s && s->delta && s->transmitted);
    EXPECT_NEAR(s->weight[1] * with_coat.chance, with_coat.value[1], 1e-6f);
}

TEST(SheenLobe, KeepsWhiteWhite) {
    for (const float roughness : {0.2f, 0.8f})
        for (const float sheen : {0.f, 0.07f, 0.085f, 0.1f, 0.13f, 0.2f, 0.3f, 0.5f, 0.75f, 1.f})
            for (const float cosine : {0.02f, 0.05f, 0.1f, 0.2f, 0.5f, 0.8f, 1.f})
                expect_white(with_sheen(white(roughness), sheen), cosine,
                             "sheen " + std::to_string(sheen));
}

TEST(SheenLobe, LeavesGlassWhatItDoesNotScatter) {
    for (const bool thin : {false, true})
        expect_white(with_sheen(glass(0.f, 1.5f, thin), 0.5f), 0.3f, "sheen over glass");
}

TEST(SheenLobe, TakesFromBelowWhatItsStrongestColourScatters) {
    const Rgb colour(0.2f, 0.5f, 0.9f);
    const float cosine = 0.3f;
    const V3f albedo = layered_albedo(with_sheen(white(0.5f), 0.4f, colour), from_cosine(cosine));
    const float scattered = Sheen(0.4f, cosine).albedo();
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(albedo[c], 1 - scattered * (0.9f - colour[c]), 0.01f) << c;
}

// Estevez and Kulla 2017, in doubles, term by term.
TEST(SheenLobe, HasTheValueOfItsFormula) {
    const double roughness = 0.5, alpha = roughness * roughness;
    const V3f wo = from_cosine(0.7f), wi = from_cosine(0.4f, 2.f), h = unit(wo + wi);
    const double density = (2 + 1 / alpha) *
                           std::pow(std::sqrt(1 - double(h.z) * double(h.z)), 1 / alpha) /
                           (2 * std::numbers::pi);
    const double t = (1 - alpha) * (1 - alpha);
    const auto mix = [t](double narrow, double wide) { return t * narrow + (1 - t) * wide; };
    const auto curve = [&](double x) {
        return mix(25.3245, 21.5473) /
                   (1 + mix(3.32435, 3.82987) * std::pow(x, mix(0.16801, 0.19823))) +
               mix(-1.27393, -1.97760) * x + mix(-4.85967, -4.32054);
    };
    const double lambda_o = std::exp(2 * curve(0.5) - curve(1 - 0.7)),
                 lambda_i = std::exp(curve(0.4));
    const double value = density / (1 + lambda_o + lambda_i) / (4 * 0.7 * 0.4) * 0.4;
    EXPECT_NEAR(double(Sheen(0.5f, 0.7f).f_cos(wo, wi)), value, 1e-4 * value);
}

TEST(Anisotropy, KeepsWhiteWhite) {
    for (const float metallic : {0.f, 1.f})
        for (const float roughness : {0.f, 0.05f, 0.1f, 0.3f, 0.6f, 1.f})
            for (const float strength : {0.02f, 0.3f, 0.7f, 1.f})
                for (const float cosine : kLayerCosines)
                    expect_white(brushed(white(roughness, metallic), strength), cosine,
                                 "strength " + std::to_string(strength));
}

// Quadrature errs on both sides of the boundary.
TEST(Anisotropy, OfGlassKeepsWhiteWhite) {
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const float roughness : {0.f, 0.1f, 0.3f, 0.6f})
            for (const float strength : {0.3f, 0.7f, 1.f})
                for (const float cosine : kLayerCosines)
                    expect_white(
                        brushed(glass(roughness, eta), strength), cosine,
                        "index " + std::to_string(eta) + ", strength " + std::to_string(strength),
                        V3f(0, 0, 1), 0.015f);
}

// The quadrature against uniform directions, which know nothing of facets.
TEST(Anisotropy, AlbedoIsThatOfDirectIntegration) {
    for (const GgxWidth& alpha : {GgxWidth(0.6f, 0.1f), GgxWidth(0.9f, 0.3f), GgxWidth(0.2f, 0.2f)})
        for (const float cosine : {0.3f, 0.9f}) {
            const V3f wo = from_cosine(cosine, 1.1f);
            test::Random random(3);
            test::Moments total, schlick;
            for (int i = 0; i < 400000; ++i) {
                V3f wi = random.direction();
                wi.z = std::fabs(wi.z);
                const V3f m = unit(wo + wi);
                const float g = 1 / (1 + ggx_lambda(wo, alpha) + ggx_lambda(wi, alpha));
                const double f = double(ggx_d(m, alpha) * g / (4 * wo.z)) * 2 * std::numbers::pi;
                total.add(f);
                schlick.add(f * double(schlick_weight(wo.dot(m))));
            }
            const GgxAlbedo albedo = visible_albedo(wo, alpha);
            EXPECT_TRUE(test::agrees(total, double(albedo.total()), 0.01)) << total.mean();
            EXPECT_TRUE(test::agrees(schlick, double(albedo.f90), 0.005)) << schlick.mean();
        }
}

// Across the brushes the highlight keeps the base's width, along them it is wide.
TEST(Anisotropy, WidensTheLobeAlongX) {
    const Layered l = brushed(white(0.3f, 1), 0.8f);
    const V3f wo(0, 0, 1);
    const CoatedBsdf bsdf = bsdf_of(l, wo), round = bsdf_of(white(0.3f, 1), wo);
    const V3f along(std::sin(0.6f), 0, std::cos(0.6f)), across(0, std::sin(0.6f), std::cos(0.6f));
    EXPECT_GT(bsdf.eval(along).f_cos[0], 10 * bsdf.eval(across).f_cos[0]);
    const auto fall = [&](const CoatedBsdf& b) { return b.eval(across).pdf / b.eval(wo).pdf; };
    EXPECT_NEAR(fall(bsdf) / fall(round), 1.f, 0.1f);
}

TEST(ThinFilmLobe, OverWhiteKeepsWhiteWhite) {
    for (const float roughness : {0.f, 0.3f, 1.f})
        for (const float nm : {100.f, 400.f, 1200.f})
            for (const float cosine : {0.05f, 0.5f, 1.f}) {
                expect_white(filmed(white(roughness, 1), nm), cosine, std::to_string(nm) + " nm");
                expect_white(filmed(white(roughness), nm, 1.8f), cosine,
                             std::to_string(nm) + " nm");
            }
}

TEST(ThinFilmLobe, NothingIsGainedByGlass) {
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const float cosine : kLayerCosines) {
            expect_white(filmed(glass(0.f, eta), 400.f, eta > 1 ? 1.3f : 1.3f / 1.5f), cosine,
                         "glass");
            for (const float roughness : {0.3f, 0.5f, 1.f})
                expect_white(filmed(glass(roughness, eta), 400.f, eta > 1 ? 1.3f : 1.3f / 1.5f),
                             cosine, "index " + std::to_string(eta));
        }
}

// Of smooth glass the film's colour is what is reflected, and what is refracted is the rest.
TEST(ThinFilmLobe, ColoursWhatGlassReflectsAndRefracts) {
    const float cosine = 0.7f;
    const f4 film = ThinFilm(1.3f, 400.f, Bands::rgb()).reflectance(cosine, splat(1.5f), f4{});
    const CoatedBsdf bsdf = bsdf_of(filmed(glass(0.f, 1.5f), 400.f), from_cosine(cosine));
    V3d reflected(0.), refracted(0.);
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const auto s = bsdf.sample((static_cast<float>(i) + 0.5f) / n, {0.5f, 0.5f});
        ASSERT_TRUE(s);
        for (int c = 0; c < 3; ++c)
            (s->transmitted ? refracted : reflected)[c] += double(s->weight[c]) / n;
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(reflected[c], double(film[c]), 1e-4) << c;
        EXPECT_NEAR(refracted[c], 1 - double(film[c]), 2e-4) << c;
    }
    EXPECT_GT(std::fabs(film[0] - film[2]), 0.01f);
}

TEST(DiffuseTransmission, KeepsWhiteWhite) {
    for (const float roughness : kLayerRoughnesses)
        for (const float share : {0.3f, 1.f})
            for (const float transmission : {0.f, 0.4f})
                for (const float cosine : kLayerCosines) {
                    Layered l = leaf(white(roughness), share);
                    l.in.transmission = transmission;
                    expect_white(l, cosine, "leaf");
                }
}

TEST(DiffuseTransmission, SendsItsShareBehind) {
    Layered l = leaf(white(1.f), 0.3f);
    l.in.dielectric_f0 = f4{};
    l.in.dielectric_f90 = 0;
    l.in.diffuse_transmission_color = f4{0.5f, 1, 0, 0};
    const CoatedBsdf bsdf = bsdf_of(l, from_cosine(0.5f));
    const V3f wi = from_cosine(0.6f, 2.f);
    EXPECT_NEAR(bsdf.eval(wi).f_cos[0], 0.7f * 0.6f * kInvPi, 1e-6f);
    const f4 behind = bsdf.eval(-wi).f_cos;
    EXPECT_NEAR(behind[0], 0.3f * 0.5f * 0.6f * kInvPi, 1e-6f);
    EXPECT_NEAR(behind[1], 0.3f * 0.6f * kInvPi, 1e-6f);
    EXPECT_EQ(behind[2], 0.f);
}

// Each lobe is the same both ways; only the shares that layers leave each other are not.
TEST(Layers, LobesAreReciprocal) {
    Layered bare = white(0.4f, 1);
    bare.in.base_color = f4{0.9f, 0.5f, 0.2f, 0};
    Layered only_sheen = with_sheen(white(0.5f), 0.4f);
    only_sheen.in.base_color = only_sheen.in.dielectric_f0 = f4{};
    only_sheen.in.dielectric_f90 = 0;
    Layered only_coat = only_sheen;
    only_coat.in.sheen = f4{};
    only_coat.in.sheen_most = 0;
    // Without compensation for multiple scattering, which follows wo alone: a narrow lobe.
    Layered narrow = brushed(bare, 0.15f);
    narrow.in.roughness = 0.1f;
    Layered narrow_film = filmed(narrow, 350.f);
    test::Random random(9);
    const auto upper = [&] {
        V3f w = random.direction();
        w.z = std::max(std::fabs(w.z), 0.3f);
        return unit(w);
    };
    for (int i = 0; i < 2000; ++i) {
        const V3f a = upper(), b = upper();
        for (const auto& [l, tolerance] : {std::pair{only_sheen, 1e-4f},
                                           {coated(only_coat, 0.2f), 0.003f},
                                           {narrow, 0.02f},
                                           {narrow_film, 0.02f}}) {
            const float forth = bsdf_of(l, a).eval(b).f_cos[0] / b.z;
            const float back = bsdf_of(l, b).eval(a).f_cos[0] / a.z;
            EXPECT_NEAR(forth, back, tolerance * std::max(forth, back) + 1e-6f);
        }
    }
}

struct LayerCase {
    const char* name;
    Layered layered;
    float cosine;
    int lane = 1;
    V3f up{0, 0, 1};
};

const V3f kTiltedLayer = from_cosine(0.6f, 2.2f);

class LayerSampling : public testing::TestWithParam<LayerCase> {};

TEST_P(LayerSampling, DirectionsFollowTheDensity) {
    const CoatedBsdf bsdf =
        bsdf_of(GetParam().layered, from_cosine(GetParam().cosine), GetParam().up);
    const auto draw = [&](test::Random& random) -> std::optional<V3f> {
        const float u_lobe = random.next();
        const auto s = bsdf.sample(u_lobe, random.next2());
        return s ? std::optional(s->wi) : std::nullopt;
    };
    const auto pdf = [&](const V3f& wi) -> double { return bsdf.eval(wi).pdf; };
    EXPECT_TRUE(test::chi_square_sphere(draw, pdf, 11)) << GetParam().name;
}

// The integral of the value over uniform directions, which know nothing of the lobes, against the
// mean weight of the sampler's own.
TEST_P(LayerSampling, WeightsIntegrateTheValue) {
    const CoatedBsdf bsdf =
        bsdf_of(GetParam().layered, from_cosine(GetParam().cosine), GetParam().up);
    const int lane = GetParam().lane;
    test::Random random(5);
    test::Moments value, weight;
    for (int i = 0; i < 400000; ++i) {
        value.add(4 * std::numbers::pi * double(bsdf.eval(random.direction()).f_cos[lane]));
        const float u_lobe = random.next();
        const auto s = bsdf.sample(u_lobe, random.next2());
        weight.add(s ? double(s->weight[lane]) : 0);
    }
    EXPECT_TRUE(test::agrees(test::Mean(value) - test::Mean(weight), 0))
        << value.mean() << " and " << weight.mean();
}

INSTANTIATE_TEST_SUITE_P(
    All, LayerSampling,
    testing::Values(
        LayerCase{"coat", coated(white(0.8f), 0.3f), 0.6f},
        LayerCase{"coat of its own normal",
                  coated(white(0.5f, 1), 0.3f, 0.9f, from_cosine(0.85f, 2.f)), 0.8f},
        LayerCase{"tilted coat", coated(white(0.6f), 0.4f, 1, from_cosine(0.9f, 4.f)), 0.7f, 1,
                  kTiltedLayer},
        LayerCase{"coated glass", coated(glass(0.5f, 1.5f), 0.4f), 0.7f},
        LayerCase{"sheen", with_sheen(white(0.6f), 0.3f, Rgb(0.9f, 0.6f, 0.1f)), 0.4f},
        LayerCase{"tilted sheen", with_sheen(white(0.6f), 0.5f), 0.6f, 1, kTiltedLayer},
        LayerCase{"coated sheen", coated(with_sheen(white(0.7f), 0.4f), 0.3f, 0.6f), 0.5f},
        LayerCase{"brushed metal", brushed(white(0.3f, 1), 0.6f), 0.6f},
        LayerCase{"brushed and grazing", brushed(white(0.4f, 1), 1.f), 0.15f},
        LayerCase{"tilted brushed metal", brushed(white(0.4f, 1), 0.5f), 0.6f, 1, kTiltedLayer},
        LayerCase{"brushed glass", brushed(glass(0.4f, 1.5f), 0.6f), 0.7f},
        LayerCase{"film", filmed(white(0.5f), 400.f, 1.6f), 0.6f, 2},
        LayerCase{"film on metal", filmed(white(0.4f, 1), 300.f), 0.6f, 0},
        LayerCase{"film on glass", filmed(glass(0.5f, 1.5f), 300.f), 0.6f, 0},
        LayerCase{"leaf", leaf(white(0.5f), 0.4f), 0.6f},
        LayerCase{"tilted leaf", leaf(white(0.5f), 0.4f), 0.7f, 1, kTiltedLayer},
        LayerCase{"all",
                  coated(with_sheen(leaf(brushed(filmed(white(0.4f, 0.3f), 400.f), 0.5f), 0.3f),
                                    0.4f, Rgb(0.5f)),
                         0.2f, 0.5f),
                  0.7f}),
    [](const auto& case_info) {
        std::string name = case_info.param.name;
        for (char& c : name) c = c == ' ' ? '_' : c;
        return name;
    });

}  // namespace
}  // namespace petzval
