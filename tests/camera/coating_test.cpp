// SPDX-License-Identifier: Apache-2.0
// What surfaces reflect, against textbook cases and against a sum over the layer's matrices.
#include "camera/lens/coating.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

constexpr float kRound = 2e-6f;

Crossing crossing(float from, float into, double incidence_deg) {
    return {splat(from), splat(into),
            splat(float(std::cos(incidence_deg * std::numbers::pi / 180)))};
}
Crossing backwards(const Crossing& c) {
    const f4 ratio = c.index_from / c.index_into;
    return {c.index_into, c.index_from, sqrt(1 - ratio * ratio * (1 - c.cosine * c.cosine))};
}

TEST(Coating, BareGlassReflectsFourPercentAtNormalIncidence) {
    const Reflectance r = fresnel_reflectance(crossing(1, 1.5f, 0));
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(r.s[i], 0.04, kRound);
        EXPECT_NEAR(r.p[i], 0.04, kRound);
    }
    EXPECT_NEAR(transmittance(Coating::Uncoated, crossing(1, 1.5f, 0), true, splat(550))[0], 0.96,
                kRound);
    EXPECT_EQ(transmittance(Coating::Ideal, crossing(1, 1.5f, 80), true, splat(550))[0], 1);
}

TEST(Coating, NothingOfPIsReflectedAtBrewstersAngle) {
    const double brewster_deg = std::atan(1.5) * 180 / std::numbers::pi;
    const Reflectance r = fresnel_reflectance(crossing(1, 1.5f, brewster_deg));
    EXPECT_NEAR(r.p[0], 0, 1e-10);
    // There the two rays are perpendicular: r_s = cos 2 theta.
    EXPECT_NEAR(r.s[0], std::pow(std::cos(2 * std::atan(1.5)), 2), kRound);
}

TEST(Coating, AQuarterWaveReflectsAsItsIndicesSay) {
    for (const float glass : {1.5168f, 1.7f, 1.38f * 1.38f}) {
        const double square = double(kMgF2Index) * kMgF2Index;
        const double expected = std::pow((glass - square) / (glass + square), 2);
        const Reflectance r = coated_reflectance(crossing(1, glass, 0), splat(550));
        EXPECT_NEAR(r.s[0], expected, kRound) << glass;
        EXPECT_NEAR(r.p[0], expected, kRound) << glass;
    }
    // Half a wave is as if there were no layer.
    EXPECT_NEAR(coated_reflectance(crossing(1, 1.6f, 0), splat(275)).s[0],
                fresnel_reflectance(crossing(1, 1.6f, 0)).s[0], kRound);
}

/// The characteristic matrix of one layer (Born and Wolf 1999, 1.6.2), in doubles.
double by_matrix(double n0, double n2, double cosine0, double nm, bool s) {
    using C = std::complex<double>;
    const double n1 = kMgF2Index;
    const auto cosine_in = [&](double n) {
        return std::sqrt(1 - n0 * n0 * (1 - cosine0 * cosine0) / (n * n));
    };
    const double c1 = cosine_in(n1), c2 = cosine_in(n2);
    const auto admittance = [s](double n, double c) { return s ? n * c : n / c; };
    const double y0 = admittance(n0, cosine0), y1 = admittance(n1, c1), y2 = admittance(n2, c2);
    const double beta = std::numbers::pi / 2 * kQuarterWave_nm / nm * c1;
    const C b = std::cos(beta) + C(0, 1) * std::sin(beta) * y2 / y1;
    const C c = y2 * std::cos(beta) + C(0, 1) * y1 * std::sin(beta);
    return std::norm((y0 * b - c) / (y0 * b + c));
}

TEST(Coating, AirysSumIsTheLayersMatrix) {
    for (const float nm : {400.f, 550.f, 700.f})
        for (const float angle : {0.f, 20.f, 45.f, 60.f, 80.f})
            for (const auto& [from, into] : {std::pair(1.f, 1.52f), {1.f, 1.85f}}) {
                const Crossing c = crossing(from, into, angle);
                const Reflectance r = coated_reflectance(c, splat(nm));
                const double cosine = c.cosine[0];
                EXPECT_NEAR(r.s[0], by_matrix(from, into, cosine, nm, true), 3e-6) << angle;
                EXPECT_NEAR(r.p[0], by_matrix(from, into, cosine, nm, false), 3e-6) << angle;
            }
}

TEST(Coating, EachLaneHasItsOwnIndexAngleAndWavelength) {
    const Crossing all{{1, 1, 1.6f, 1.5f}, {1.5f, 1.8f, 1, 1}, {1, 0.5f, 0.9f, 0.8f}};
    const f4 nm{400, 500, 600, 700};
    const f4 t = transmittance(Coating::MgF2, all, true, nm);
    for (int i = 0; i < 4; ++i) {
        const Crossing one{splat(all.index_from[i]), splat(all.index_into[i]),
                           splat(all.cosine[i])};
        EXPECT_EQ(t[i], transmittance(Coating::MgF2, one, true, splat(nm[i]))[0]);
    }
}

TEST(Coating, SharesAreSharesAndTheSameBothWays) {
    test::Random random(4);
    const auto four = [&](float low, float high) {
        f4 out;
        for (int i = 0; i < 4; ++i) out[i] = low + (high - low) * random.next();
        return out;
    };
    for (int k = 0; k < 2000; ++k) {
        const bool air = k % 2;
        const Crossing c{air ? splat(1) : four(1.4f, 2), four(1.4f, 2), four(0.05f, 1)};
        const f4 nm = four(360, 830);
        for (const Coating coating : {Coating::Uncoated, Coating::MgF2}) {
            const f4 there = transmittance(coating, c, air, nm);
            const Crossing reverse = backwards(c);
            const f4 back = transmittance(coating, reverse, air, nm);
            for (int i = 0; i < 4; ++i) {
                ASSERT_TRUE(there[i] >= 0 && there[i] <= 1);
                // Near the critical angle a cosine is the root of a difference.
                if (reverse.cosine[i] > 0.05f) {
                    ASSERT_NEAR(there[i], back[i], 2e-4);
                }
            }
        }
    }
}

TEST(Coating, NothingPassesAtGrazingIncidence) {
    for (const Coating coating : {Coating::Uncoated, Coating::MgF2}) {
        float before = 1;
        for (const float cosine : {1e-1f, 1e-2f, 1e-3f, 1e-5f, 0.f}) {
            const f4 t =
                transmittance(coating, {splat(1), splat(1.5f), splat(cosine)}, true, splat(550));
            EXPECT_LE(t[0], std::fmin(before, 12 * cosine));
            before = t[0];
        }
        // Beyond the critical angle, and exactly along the surface from within.
        for (const float cosine : {0.1f, 0.f})
            EXPECT_EQ(
                transmittance(coating, {splat(1.5f), splat(1), splat(cosine)}, true, splat(550))[0],
                0);
    }
}

TEST(Coating, CementedSurfacesStayBare) {
    const Crossing c = crossing(1.5f, 1.7f, 10);
    EXPECT_EQ(transmittance(Coating::MgF2, c, false, splat(550))[0],
              transmittance(Coating::Uncoated, c, false, splat(550))[0]);
    EXPECT_NE(transmittance(Coating::MgF2, c, true, splat(550))[0],
              transmittance(Coating::Uncoated, c, true, splat(550))[0]);
}

}  // namespace
}  // namespace petzval::camera
