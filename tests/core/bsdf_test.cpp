// SPDX-License-Identifier: Apache-2.0
#include "core/shading/bsdf.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <random>

#include "core/shading/microfacet.h"
#include "tests/core/bsdf_inputs.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using namespace test;

// Mean weight over a jittered grid: lobes along one axis, directions along the two others.
float albedo_of(const BsdfInput& in, const V3f& wo, const V3f& up, int side) {
    const Bsdf bsdf(in, Bands::rgb(), wo, splat(1.f), up);
    constexpr int lobes = 24;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> jitter;
    double sum = 0;
    for (int k = 0; k < lobes; ++k)
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const float u_lobe = std::min((k + jitter(random)) / lobes, kOneMinus);
                const V2f u(std::min((i + jitter(random)) / side, kOneMinus),
                            std::min((j + jitter(random)) / side, kOneMinus));
                if (const auto s = bsdf.sample(u_lobe, u)) sum += s->weight[0];
            }
    return static_cast<float>(sum / (lobes * side * side));
}

float albedo_of(const BsdfInput& in, float cosine) {
    return albedo_of(in, from_cosine(cosine), V3f(0, 0, 1), 96);
}

// Normal of a surface in the frame of a shading normal that is tilted off it, with wo above both:
// nothing where there is no such.
std::optional<V3f> up_of(const V3f& wo, float tilt_deg, float azimuth) {
    const V3f up = from_cosine(std::cos(tilt_deg * kPi / 180), azimuth);
    return wo.dot(up) > 1e-3f ? std::optional(up) : std::nullopt;
}
constexpr float kTilts_deg[] = {20.f, 50.f, 75.f, 85.f};

constexpr float kCosines[] = {0.05f, 0.1f, 0.25f, 0.5f, 0.8f, 1.f};
constexpr float kRoughnesses[] = {0.f, 0.05f, 0.15f, 0.3f, 0.5f, 0.7f, 0.85f, 1.f};

TEST(Bsdf, OpaqueWhiteReflectsEverythingAtEveryRoughness) {
    for (const float metallic : {0.f, 0.5f, 1.f})
        for (const float roughness : kRoughnesses)
            for (const float cosine : kCosines) {
                BsdfInput in = dielectric(roughness);
                in.metallic = metallic;
                EXPECT_NEAR(albedo_of(in, cosine), 1.f, 0.005f)
                    << "metallic " << metallic << " roughness " << roughness << " cosine "
                    << cosine;
            }
}

// In a closed body that light can enter, rough metal reflects a path many times before it finds a
// way out. If a white weight has the variance v and the share r stays inside, the variance of a
// path is finite only where r (1 + v) < 1: reflections are drawn so that nearly all weigh the same.
TEST(Bsdf, WeightsOfRoughMetalWithGlassAreEven) {
    for (const BsdfInput& body : {glass(1.f, 1.001f), glass(1.f, 1 / 1.5f), thin_glass(1.f)}) {
        BsdfInput in = body;
        in.metallic = 0.81f;
        test::Random random(3);
        test::Moments weights;
        for (int i = 0; i < 100000; ++i) {
            const float cosine = random.next(), u_lobe = random.next();
            const auto s = Bsdf(in, Bands::rgb(), from_cosine(std::max(cosine, 0.01f)))
                               .sample(u_lobe, random.next2());
            weights.add(s ? double(s->weight[0]) : 0);
        }
        EXPECT_NEAR(weights.mean(), 1, 0.005);
        EXPECT_LT(0.81 * (1 + weights.variance()), 0.9) << weights.variance();
    }
}

// What a normal map tilts keeps its light: no direction is lost behind the surface.
TEST(Bsdf, OpaqueWhiteReflectsEverythingAtEveryTilt) {
    for (const float tilt_deg : kTilts_deg)
        for (const float azimuth : {0.f, 2.f, kPi})
            for (const float cosine : {0.1f, 0.6f, 1.f})
                for (const float roughness : {0.f, 0.15f, 0.5f, 1.f})
                    for (const float metallic : {0.f, 1.f}) {
                        const V3f wo = from_cosine(cosine);
                        const auto up = up_of(wo, tilt_deg, azimuth);
                        if (!up) continue;
                        BsdfInput in = dielectric(roughness);
                        in.metallic = metallic;
                        EXPECT_NEAR(albedo_of(in, wo, *up, 16), 1.f, 0.01f)
                            << "tilt " << tilt_deg << " azimuth " << azimuth << " cosine " << cosine
                            << " roughness " << roughness << " metallic " << metallic;
                    }
}

TEST(Bsdf, TiltedTransmissionKeepsWhatAnUntiltedOneKeeps) {
    for (const float tilt_deg : kTilts_deg)
        for (const float azimuth : {0.f, 2.f})
            for (const float cosine : {0.3f, 0.9f})
                for (const float roughness : {0.f, 0.4f, 1.f})
                    for (const BsdfInput& in : {thin_glass(roughness), glass(roughness, 1.5f),
                                                glass(roughness, 1 / 1.5f)}) {
                        const V3f wo = from_cosine(cosine);
                        const auto up = up_of(wo, tilt_deg, azimuth);
                        if (!up) continue;
                        EXPECT_NEAR(albedo_of(in, wo, *up, 16), albedo_of(in, wo, V3f(0, 0, 1), 16),
                                    0.01f)
                            << tilt_deg << ' ' << azimuth << ' ' << cosine << ' ' << roughness;
                    }
}

// Nothing that is reflected leaves behind the surface, nothing that is transmitted before it.
TEST(Bsdf, TiltedSamplesLieOnTheirSide) {
    const V3f wo = from_cosine(0.6f, 0.7f);
    const V3f up = from_cosine(0.5f, 2.2f);
    for (const float roughness : {0.f, 0.5f})
        for (const BsdfInput& in : {dielectric(roughness), metal(roughness), thin_glass(roughness),
                                    glass(roughness, 1.5f), dispersing(roughness, true)}) {
            const Bsdf bsdf(in, Bands::rgb(), wo, splat(1.f), up);
            test::Random random(4);
            for (int i = 0; i < 2000; ++i) {
                const float u_lobe = random.next();
                const auto s = bsdf.sample(u_lobe, random.next2());
                if (s) {
                    EXPECT_EQ(s->wi.dot(up) < 0.f, s->transmitted);
                }
            }
        }
}

TEST(Bsdf, SpecularWeightsKeepWhiteWhite) {
    for (const float specular : {0.f, 0.3f})
        for (const float roughness : {0.f, 0.4f, 1.f}) {
            BsdfInput in = dielectric(roughness);
            in.dielectric_f0 = in.dielectric_f0 * specular;
            in.dielectric_f90 = specular;
            EXPECT_NEAR(albedo_of(in, 0.4f), 1.f, 0.005f) << specular << ' ' << roughness;
        }
}

// Transmission may lose what single scattering shadows; it never gains.
TEST(Bsdf, TransmissionNeverGains) {
    for (const float roughness : kRoughnesses)
        for (const float cosine : kCosines) {
            EXPECT_LE(albedo_of(thin_glass(roughness), cosine), 1.005f)
                << roughness << ' ' << cosine;
            EXPECT_LE(albedo_of(gold(roughness), cosine), 1.005f) << roughness << ' ' << cosine;
            for (const float eta : {1.5f, 1 / 1.5f, 2.4f, 1.001f})
                EXPECT_LE(albedo_of(glass(roughness, eta), cosine), 1.005f)
                    << roughness << ' ' << cosine << " eta " << eta;
        }
}

TEST(Bsdf, SmoothGlassLosesNothing) {
    for (const float eta : {1.5f, 1 / 1.5f})
        for (const float cosine : kCosines)
            EXPECT_NEAR(albedo_of(glass(0.f, eta), cosine), 1.f, 1e-4f) << eta << ' ' << cosine;
    EXPECT_GT(albedo_of(glass(0.3f, 1.5f), 0.8f), 0.99f);
    EXPECT_GT(albedo_of(glass(1.f, 1.5f), 0.8f), 0.99f);
}

TEST(Bsdf, SmoothGlassReflectsFresnelsShare) {
    for (const float cosine : {0.1f, 0.4f, 1.f}) {
        const Bsdf bsdf(glass(0.f, 1.5f), Bands::rgb(), from_cosine(cosine));
        constexpr int n = 4000;
        int reflected = 0;
        for (int i = 0; i < n; ++i) {
            const auto s = bsdf.sample((static_cast<float>(i) + 0.5f) / n, {0.5f, 0.5f});
            reflected += s && !s->transmitted;
        }
        EXPECT_NEAR(reflected / float(n), fresnel_dielectric(cosine, splat(1.5f))[0], 1.f / n);
    }
}

TEST(Bsdf, RefractionObeysSnell) {
    const V3f wo = from_cosine(0.6f);
    const Bsdf bsdf(glass(0.f, 1.5f), Bands::rgb(), wo);
    const auto s = bsdf.sample(0.9f, {0.3f, 0.3f});
    ASSERT_TRUE(s && s->delta && s->transmitted);
    EXPECT_NEAR(std::hypot(s->wi.x, s->wi.y), 0.8f / 1.5f, 1e-6f);
    EXPECT_LT(s->wi.x * wo.x, 0.f);
    EXPECT_LT(s->wi.z, 0.f);
}

TEST(Bsdf, TotalReflectionInsideGlass) {
    const Bsdf bsdf(glass(0.f, 1 / 1.5f), Bands::rgb(), from_cosine(0.5f));
    for (const float u : {0.01f, 0.5f, 0.99f}) {
        const auto s = bsdf.sample(u, {0.5f, 0.5f});
        ASSERT_TRUE(s);
        EXPECT_FALSE(s->transmitted);
    }
}

// The table against brute force over cosine-weighted directions, which share nothing with it.
TEST(Microfacet, AlbedoTableMatchesDirectIntegration) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit_u;
    for (const float alpha : {0.09f, 0.31f, 0.77f})
        for (const float cosine : {0.23f, 0.55f, 0.93f}) {
            const V3f wo = from_cosine(cosine);
            double total = 0, schlick = 0;
            constexpr int side = 1200;
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j) {
                    const double r = std::sqrt((i + unit_u(random)) / side);
                    const double phi = 2 * std::numbers::pi * (j + unit_u(random)) / side;
                    const V3f wi(static_cast<float>(r * std::cos(phi)),
                                 static_cast<float>(r * std::sin(phi)),
                                 static_cast<float>(std::sqrt(std::max(1e-12, 1 - r * r))));
                    const V3f m = unit(wo + wi);
                    const float g = 1 / (1 + ggx_lambda(wo, alpha) + ggx_lambda(wi, alpha));
                    const double f = ggx_d(m, alpha) * g / (4 * wo.z * wi.z) * kPi;
                    total += f;
                    schlick += f * schlick_weight(wo.dot(m));
                }
            const GgxAlbedo table = ggx_albedo(cosine, alpha);
            EXPECT_NEAR(table.total(), total / (side * side), 0.004 * table.total())
                << alpha << ' ' << cosine;
            EXPECT_NEAR(table.f90, schlick / (side * side), 0.003) << alpha << ' ' << cosine;
        }
}

TEST(Microfacet, FresnelAtNormalIncidenceAndAtTheCriticalAngle) {
    EXPECT_NEAR(fresnel_dielectric(1.f, splat(1.5f))[0], 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1.f, splat(1 / 1.5f))[0], 0.04f, 1e-6f);
    EXPECT_FLOAT_EQ(fresnel_dielectric(0.74f, splat(1 / 1.5f))[0], 1.f);
    EXPECT_LT(fresnel_dielectric(0.75f, splat(1 / 1.5f))[0], 1.f);
    // Brewster's angle: the parallel part vanishes, half of the perpendicular one is left.
    const float brewster = std::cos(std::atan(1.5f));
    EXPECT_NEAR(fresnel_dielectric(brewster, splat(1.5f))[0], 0.5f * sqr((1 - 2.25f) / (1 + 2.25f)),
                1e-5f);
}

// The hero lane is one of four, all equally likely. Drawn by it, each lane keeps its mean,
// whatever the lanes carry; where all carry the same, the one that leads is kept.
TEST(Bsdf, TheLaneThatLeadsPicksTheRefractedOne) {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.on = m4{-1, -1, -1, -1};
    bands.nm = f4{550, 640, 430, 480};
    BsdfInput in = dispersing(0.f, false);
    in.base_color = splat(1.f);
    in.eta = f4{1.3f, 1.5f, 1.9f, 1.6f};
    const float cosine = 0.66f;
    const f4 kept = 1.f - fresnel_dielectric(cosine, in.eta);
    for (const f4& throughput : {splat(1.f), f4{1.f, 0.3f, 2.f, 0.4f}, f4{0, 1, 0, 2}}) {
        f4 refracted{};
        int drawn = 0, led = 0;
        constexpr int n = 1 << 14;
        for (bands.hero = 0; bands.hero < 4; ++bands.hero) {
            const Bsdf bsdf(in, bands, from_cosine(cosine), throughput);
            for (int i = 0; i < n; ++i) {
                const auto s = bsdf.sample((float(i) + 0.5f) / n, {0.5f, 0.5f}, false);
                if (!s || !s->transmitted) continue;
                refracted += s->weight * (1.f / (4 * n));
                ++drawn;
                led += s->weight[bands.hero] > 0.f;
            }
        }
        for (int lane = 0; lane < 4; ++lane)
            if (throughput[lane] > 0.f) {
                EXPECT_NEAR(refracted[lane], kept[lane], 1e-3) << lane;
            }
        // The lanes lose up to 10 % to reflection, which shifts their bounds.
        if (throughput[0] == throughput[2] && throughput[0] == throughput[1]) {
            EXPECT_GT(led, 0.9 * drawn);
        }
    }
}

// The mean over what is drawn is the same for each lane, though each refracts another way.
TEST(Bsdf, SmoothDispersingGlassLosesNothingInAnyLane) {
    const f4 throughput{1.f, 0.3f, 2.f, 0.f};
    for (const bool from_inside : {false, true})
        for (const float cosine : {0.3f, 0.66f, 0.9f}) {
            const BsdfInput in = dispersing(0.f, from_inside);
            const Bsdf bsdf(in, Bands::rgb(), from_cosine(cosine), throughput);
            constexpr int n = 1 << 16;
            std::array<double, 3> sum{}, refracted{};
            for (int i = 0; i < n; ++i) {
                const auto s = bsdf.sample((static_cast<float>(i) + 0.5f) / n, {0.5f, 0.5f});
                ASSERT_TRUE(s && s->delta);
                for (size_t lane = 0; lane < 3; ++lane) {
                    const float weight = s->weight[static_cast<int>(lane)];
                    sum[lane] += weight / n;
                    if (!s->transmitted) continue;
                    refracted[lane] += weight / n;
                    if (weight == 0.f) continue;
                    // Snell's law for the one lane that is left.
                    EXPECT_NEAR(std::hypot(s->wi.x, s->wi.y),
                                safe_sqrt(1 - sqr(cosine)) / in.eta[static_cast<int>(lane)], 1e-5f);
                    EXPECT_EQ(hsum(s->weight), weight);
                }
            }
            const f4 reflectance = fresnel_dielectric(cosine, in.eta);
            for (size_t lane = 0; lane < 3; ++lane) {
                EXPECT_NEAR(sum[lane], 1., 1e-3) << lane << ' ' << cosine << from_inside;
                EXPECT_NEAR(refracted[lane], 1 - reflectance[static_cast<int>(lane)], 1e-3);
            }
        }
}

TEST(Bsdf, MeasuredMetalReflectsAsItsIndexSays) {
    const BsdfInput in = gold(0.f);
    for (const float cosine : {1.f, 0.5f, 0.05f}) {
        const Bsdf bsdf(in, Bands::rgb(), from_cosine(cosine));
        const auto s = bsdf.sample(0.5f, {0.5f, 0.5f});
        ASSERT_TRUE(s);
        for (int lane = 0; lane < 3; ++lane) {
            // Fresnel's amplitudes in complex arithmetic: another way to the same number.
            const std::complex<double> index(in.metal_n[lane], in.metal_k[lane]);
            const std::complex<double> behind =
                std::sqrt(1. - (1. - cosine * double(cosine)) / (index * index));
            const double rs =
                std::norm((double(cosine) - index * behind) / (double(cosine) + index * behind));
            const double rp =
                std::norm((index * double(cosine) - behind) / (index * double(cosine) + behind));
            EXPECT_NEAR(s->weight[lane], (rs + rp) / 2, 2e-6) << lane << ' ' << cosine;
        }
    }
}

}  // namespace
}  // namespace petzval
