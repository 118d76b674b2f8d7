// SPDX-License-Identifier: Apache-2.0
// Rough glass sends on all that it meets, from both sides, the same way forwards and
// backwards.
#include <gtest/gtest.h>

#include <numbers>

#include "core/sampling/warp.h"
#include "core/scene/material.h"
#include "core/shading/bsdf.h"
#include "core/shading/microfacet.h"
#include "tests/support/jacobian.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

V3f leaning(float cosine, float azimuth = 0.f) {
    const float sine = safe_sqrt(1 - sqr(cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

BsdfInput rough_glass(float roughness, float eta) {
    BsdfInput in;
    in.base_color = uniform(1.f, Bands::rgb());
    in.roughness = roughness;
    in.dielectric_f0 = uniform(0.04f, Bands::rgb());
    in.transmission = 1.f;
    in.thin = false;
    in.eta = splat(eta);
    return in;
}

/// A dispersive glass, its indices 3 % apart as those of flint are.
BsdfInput flint(float roughness, float eta) {
    BsdfInput in = rough_glass(roughness, eta);
    in.eta = f4{eta * 0.985f, eta, eta * 1.015f, 1.f};
    in.disperses = true;
    return in;
}

struct Place {
    float index, roughness, cosine;
    bool from_inside;
    [[nodiscard]] float eta() const { return from_inside ? 1 / index : index; }
};
std::ostream& operator<<(std::ostream& out, const Place& p) {
    return out << "index " << p.index << (p.from_inside ? " inside" : " outside") << " roughness "
               << p.roughness << " cosine " << p.cosine;
}

/// Somewhere in the range that is promised, the ends included now and then.
Place any_place(test::Random& random) {
    const auto within = [&](float least, float most) {
        const float u = 1.2f * random.next() - 0.1f;
        return least + (most - least) * clamp_unit(u);
    };
    const float index = within(1.1f, 2.4f);
    const float roughness = within(std::sqrt(kSmallestAlpha) * 1.0001f, 1.f);
    const float cosine = sqr(within(0.1f, 1.f));
    return {index, roughness, cosine, random.next() < 0.5f};
}

/// Directions that know nothing of the sampler's: cosines on both sides, and reflections and
/// refractions at normals drawn in proportion to D cos (Walter et al. 2007, equations 35 and 36).
class Directions {
  public:
    Directions(const V3f& wo, float alpha, float eta) : wo_(wo), alpha_(alpha), eta_(eta) {}

    [[nodiscard]] V3f draw(int way, V2f u) const {
        if (way < 2) {
            const V3f w = cosine_hemisphere(u);
            return way == 0 ? w : V3f(w.x, w.y, -w.z);
        }
        const float tan2 = sqr(alpha_) * u.x / (1 - u.x), phi = 2 * kPi * u.y;
        const float z = 1 / std::sqrt(1 + tan2), s = std::sqrt(tan2) * z;
        const V3f m(s * std::cos(phi), s * std::sin(phi), z);
        const float c = wo_.dot(m);
        if (way == 2) return unit(reflect(wo_, m));
        const float cos2 = 1 - (1 - sqr(c)) / sqr(eta_);
        if (!(cos2 > 0)) return {0, 0, 0};
        return unit(m * (c / eta_ - std::copysign(std::sqrt(cos2), c)) - wo_ * (1 / eta_));
    }
    /// Density of the four ways together, each drawn as often.
    [[nodiscard]] double pdf(const V3f& wi) const {
        double sum = double(std::fabs(wi.z) * kInvPi);
        if (wi.z > 0) {
            const V3f m = unit(wo_ + wi);
            sum += double(ggx_d(m, alpha_) * m.z / (4 * wo_.dot(m)));
        } else {
            V3f m = unit(wo_ + wi * eta_);
            if (m.z < 0) m = -m;
            const float c = wo_.dot(m), d = wi.dot(m);
            if (c * d < 0)
                sum +=
                    double(ggx_d(m, alpha_) * m.z * sqr(eta_) * std::fabs(d) / sqr(c + eta_ * d));
        }
        return sum / 4;
    }

  private:
    V3f wo_;
    float alpha_, eta_;
};

constexpr int kDraws_per_side = 32, kRepeats = 8;

V2f jittered(int i, int j, test::Random& random) {
    const V2f u = random.next2();
    return {std::min((static_cast<float>(i) + u.x) / kDraws_per_side, kOneMinus),
            std::min((static_cast<float>(j) + u.y) / kDraws_per_side, kOneMinus)};
}

/// Share of the light that leaves, by the values alone.
test::Moments by_values(const BsdfInput& in, const V3f& wo, int lane, test::Random& random) {
    const Bsdf bsdf(in, Bands::rgb(), wo);
    const Directions directions(wo, sqr(in.roughness), in.eta[lane]);
    test::Moments albedo;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        double sum = 0;
        for (int way = 0; way < 4; ++way)
            for (int i = 0; i < kDraws_per_side; ++i)
                for (int j = 0; j < kDraws_per_side; ++j) {
                    const V3f wi = directions.draw(way, jittered(i, j, random));
                    if (wi.z == 0 || (way >= 2 && (way == 2) != (wi.z > 0))) continue;
                    sum += double(bsdf.eval(wi).f_cos[lane]) / directions.pdf(wi);
                }
        albedo.add(sum / (4 * kDraws_per_side * kDraws_per_side));
    }
    return albedo;
}

/// The same by samples, and of it what is reflected.
struct Sampled {
    test::Moments all, reflected;
};
Sampled by_samples(const BsdfInput& in, const V3f& wo, int lane, test::Random& random,
                   const V3f& up = V3f(0, 0, 1)) {
    const Bsdf bsdf(in, Bands::rgb(), wo, splat(1.f), up);
    Sampled sampled;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        double sum = 0, reflected = 0;
        for (int lobe = 0; lobe < 8; ++lobe)
            for (int i = 0; i < kDraws_per_side; ++i)
                for (int j = 0; j < kDraws_per_side; ++j) {
                    const float u = (static_cast<float>(lobe) + random.next()) / 8;
                    const auto s = bsdf.sample(std::min(u, kOneMinus), jittered(i, j, random));
                    if (!s) continue;
                    sum += double(s->weight[lane]);
                    if (!s->transmitted) reflected += double(s->weight[lane]);
                }
        sampled.all.add(sum / (8 * kDraws_per_side * kDraws_per_side));
        sampled.reflected.add(reflected / (8 * kDraws_per_side * kDraws_per_side));
    }
    return sampled;
}

constexpr int kPlaces = 300;

/// Within -1 % and +0.3 % of all, but for chance: the places together count as one test.
testing::AssertionResult keeps_all(const test::Moments& albedo, double least = 0.99,
                                   double most = 1.003) {
    const double p = test::p_of(albedo, (least + most) / 2, (most - least) / 2);
    if (p >= test::sidak(test::kStatisticalTests * kPlaces)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << test::Mean(albedo);
}

TEST(RoughGlass, ValuesHoldAllTheLight) {
    test::Random random(21);
    for (int i = 0; i < kPlaces; ++i) {
        const Place p = any_place(random);
        EXPECT_TRUE(
            keeps_all(by_values(rough_glass(p.roughness, p.eta()), leaning(p.cosine), 1, random)))
            << p;
    }
}

TEST(RoughGlass, SamplesHoldAllTheLight) {
    test::Random random(22);
    for (int i = 0; i < kPlaces; ++i) {
        const Place p = any_place(random);
        EXPECT_TRUE(keeps_all(
            by_samples(rough_glass(p.roughness, p.eta()), leaning(p.cosine), 1, random).all))
            << p;
    }
}

TEST(RoughGlass, EachLaneOfDispersiveGlassHoldsAllItsLight) {
    test::Random random(23);
    for (int i = 0; i < 60; ++i) {
        Place p = any_place(random);
        p.index = 1.13f + (p.index - 1.1f) * 0.9f;  // the lanes are up to 1.5 % off it
        const BsdfInput in = flint(p.roughness, p.eta());
        for (const int lane : {0, 2}) {
            EXPECT_TRUE(keeps_all(by_values(in, leaning(p.cosine), lane, random))) << p;
            EXPECT_TRUE(keeps_all(by_samples(in, leaning(p.cosine), lane, random).all)) << p;
        }
    }
}

// By the midpoint rule in the cosine's fourth root, where the lobe is smooth.
TEST(RoughGlass, TheLobeOfWhatIsLostHoldsItAll) {
    test::Random random(30);
    for (int i = 0; i < 300; ++i) {
        const Place p = any_place(random);
        for (const float specular : {0.3f, 1.f}) {
            const GlassLoss loss(sqr(p.roughness), splat(p.eta()), true, specular);
            double sum = 0;
            constexpr int steps = 2000;
            for (int j = 0; j < steps; ++j) {
                const double root = (j + 0.5) / steps;
                const auto cosine = static_cast<float>(root * root * root * root);
                const double width = 4 * root * root * root / steps;
                for (const bool behind : {false, true})
                    sum += 2 * std::numbers::pi * width * double(loss.lobe(cosine, behind)[0]);
            }
            // In energy: what is hardly lost need not be split as exactly.
            double most = 0;
            for (const float cosine : {0.003f, 0.01f, 0.03f, 0.1f, 0.3f, 1.f})
                most = std::fmax(most, double(loss.lost(cosine, false)[0]));
            EXPECT_NEAR(sum * most, most, 2e-3) << p << " specular " << specular;
        }
    }
}

// What glass takes from reflection goes into transmission; less is promised of that fit.
TEST(RoughGlass, WeakReflectionHoldsAllTheLight) {
    test::Random random(24);
    for (int i = 0; i < 60; ++i) {
        const Place p = any_place(random);
        for (const float specular : {0.f, 0.3f}) {
            BsdfInput in = rough_glass(p.roughness, p.eta());
            in.dielectric_f90 = specular;
            EXPECT_TRUE(keeps_all(by_values(in, leaning(p.cosine), 1, random), 0.983, 1.006))
                << p << " specular " << specular;
        }
    }
}

// A tint darkens what changes sides, once, and nothing else.
TEST(RoughGlass, TintDarkensWhatIsTransmitted) {
    test::Random random(25);
    for (int i = 0; i < 30; ++i) {
        const Place p = any_place(random);
        BsdfInput in = rough_glass(p.roughness, p.eta());
        const Sampled white = by_samples(in, leaning(p.cosine), 1, random);
        in.base_color = uniform(0.25f, Bands::rgb());
        const Sampled tinted = by_samples(in, leaning(p.cosine), 1, random);
        const double reflected = white.reflected.mean();
        EXPECT_NEAR(tinted.reflected.mean(), reflected, 0.01) << p;
        EXPECT_NEAR(tinted.all.mean(), reflected + 0.25 * (white.all.mean() - reflected), 0.01)
            << p;
    }
}

TEST(RoughGlass, HalfOfItBesideAPlasticHoldsAllTheLight) {
    test::Random random(26);
    for (int i = 0; i < 30; ++i) {
        const Place p = any_place(random);
        BsdfInput in = rough_glass(p.roughness, p.eta());
        in.transmission = 0.5f;
        // Plastic is promised 0.5 % either way, and below a cosine of 0.05 nothing.
        EXPECT_TRUE(keeps_all(by_samples(in, leaning(std::max(p.cosine, 0.05f)), 1, random).all,
                              0.99, 1.005))
            << p;
    }
}

TEST(RoughGlass, HoldsAllTheLightAtEveryTilt) {
    test::Random random(27);
    for (int i = 0; i < 60; ++i) {
        const Place p = any_place(random);
        const V3f wo = leaning(p.cosine);
        const V3f up = leaning(0.1f + 0.9f * random.next(), 6.f * random.next());
        if (wo.dot(up) < 1e-3f) continue;
        EXPECT_TRUE(keeps_all(by_samples(rough_glass(p.roughness, p.eta()), wo, 1, random, up).all))
            << p;
    }
}

// Walter et al. 2007, section 2, in basic radiance: forwards f cos / (n^2 cos) on the side where
// light leaves equals that backwards. Both single and multiple scattering obey, table or no table.
TEST(RoughGlass, IsReciprocal) {
    test::Random random(28);
    for (int i = 0; i < 20000; ++i) {
        const Place p = any_place(random);
        const V3f wo = leaning(p.cosine);
        const V3f wi = random.direction();
        if (std::fabs(wi.z) < 0.01f) continue;
        const bool through = wi.z < 0;
        const auto turned = [&](const V3f& w) { return through ? V3f(w.x, w.y, -w.z) : w; };
        const Bsdf forwards(rough_glass(p.roughness, p.eta()), Bands::rgb(), wo);
        const Bsdf backwards(rough_glass(p.roughness, through ? 1 / p.eta() : p.eta()),
                             Bands::rgb(), turned(wi));
        const float index2 = through ? sqr(p.eta()) : 1.f;
        const double there = double(forwards.eval(wi).f_cos[1] / (index2 * std::fabs(wi.z)));
        const double back = double(backwards.eval(turned(wo)).f_cos[1] / wo.z);
        EXPECT_NEAR(there, back, 2e-3 * back + 1e-6) << p << ' ' << wi.z;
    }
}

// Far beyond what is promised all stays finite, and no light is made of nothing but by the fit.
TEST(RoughGlass, OtherIndicesStayInBounds) {
    test::Random random(29);
    for (const float index : {1.f, 1.0001f, 1.01f, 1.05f, 2.6f, 3.5f, 5.f})
        for (const bool from_inside : {false, true})
            for (const float roughness : {0.032f, 0.3f, 1.f})
                for (const float cosine : {1e-3f, 0.01f, 0.1f, 1.f}) {
                    const Place p{index, roughness, cosine, from_inside};
                    const Sampled s =
                        by_samples(rough_glass(roughness, p.eta()), leaning(cosine), 1, random);
                    EXPECT_LT(std::fabs(s.all.mean() - 1), 0.15) << p << " keeps " << s.all.mean();
                }
}

}  // namespace
}  // namespace petzval
