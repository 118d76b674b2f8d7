// SPDX-License-Identifier: Apache-2.0
// Stacks of thin layers against closed forms, and coats of whole lenses.
#include "camera/lens/layer_stack.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "camera/lens/lens_coats.h"
#include "tests/support/lens_json.h"
#include "tests/support/statistics.h"

namespace petzval::camera {
namespace {

constexpr double kPi = std::numbers::pi;

Layer waves(double index, double of_550nm) {
    return {of_550nm * 550 / index, index};
}
double cosine_of(double deg) {
    return std::cos(deg * kPi / 180);
}

// Macleod 2010, ch. 6: admittance of (high low)^pairs high on glass.
TEST(LayerStack, AQuarterWaveStackIsAMirror) {
    const double high = 2.3, low = 1.38, glass = 1.52;
    for (const int pairs : {0, 1, 4, 10}) {
        LayerStack stack{waves(high, 0.25)};
        for (int i = 0; i < pairs; ++i)
            stack.insert(stack.end(), {waves(low, 0.25), waves(high, 0.25)});
        const double y = std::pow(high / low, 2 * pairs) * high * high / glass;
        const SurfaceShares r = surface_shares(stack, false, {1, glass, 1, 550});
        EXPECT_NEAR(r.reflected, std::pow((1 - y) / (1 + y), 2), 1e-12) << pairs;
        EXPECT_NEAR(r.absorbed(), 0, 1e-12) << pairs;
    }
}

TEST(LayerStack, HalfAWaveIsAbsent) {
    const SurfaceShares r = surface_shares({waves(2.05, 0.5)}, false, {1, 1.6, 1, 550});
    EXPECT_NEAR(r.reflected, std::pow(0.6 / 2.6, 2), 1e-12);
    // At an angle it is half a wave thick in the layer's own direction.
    const double in_layer = std::sqrt(1 - std::pow(std::sin(kPi / 4) / 2.05, 2));
    const Incidence slant{1, 1.6, cosine_of(45), 550 * in_layer};
    EXPECT_NEAR(surface_shares({waves(2.05, 0.5)}, false, slant).reflected,
                surface_shares({}, false, slant).reflected, 1e-12);
}

TEST(LayerStack, AnAbsorbingLayerObeysLambertAndFresnel) {
    const double k = 1e-5, thickness_nm = 1e6;
    const SurfaceShares thin =
        surface_shares({{thickness_nm, 1.5, 0, k}}, false, {1.5, 1.5, 1, 550});
    EXPECT_NEAR(thin.transmitted, std::exp(-4 * kPi * k * thickness_nm / 550), 1e-9);
    EXPECT_NEAR(thin.absorbed(), 1 - thin.transmitted, 1e-9);
    // Opaque: the bare metal (Born and Wolf 1999, 14.2), from the front.
    const std::complex<double> metal(0.8, -6);
    const LayerStack opaque{{2000, 1.38}, {1e6, 0.8, 0, 6}};
    const LayerStack bare{{1e6, 0.8, 0, 6}};
    EXPECT_NEAR(surface_shares(bare, false, {1, 1.5, 1, 550}).reflected,
                std::norm((1. - metal) / (1. + metal)), 1e-9);
    EXPECT_NEAR(surface_shares(opaque, false, {1, 1.5, 0.6, 550}).transmitted, 0, 1e-100);
    // From the back it looks otherwise, but as much comes through.
    const LayerStack dim{{20, 0.8, 0, 6}, {90, 1.38}};
    const double sine = std::sin(0.5);
    const Incidence front{1, 1.5, std::cos(0.5), 550},
        back{1.5, 1, std::sqrt(1 - sine * sine / 2.25), 550};
    const SurfaceShares a = surface_shares(dim, false, front), b = surface_shares(dim, true, back);
    EXPECT_NEAR(a.transmitted, b.transmitted, 1e-12);
    EXPECT_GT(std::fabs(a.reflected - b.reflected), 0.01);
}

// s-polarised light through a gap beyond the critical angle (Zhu, Yu, Hawley and Roy 1986, Am. J.
// Phys. 54, 601), and p likewise.
TEST(LayerStack, TotalReflectionIsFrustratedByAGap) {
    const double n = 1.5, cosine = cosine_of(60), gap_nm = 150;
    EXPECT_EQ(surface_shares({}, false, {n, 1, cosine, 550}).transmitted, 0);
    EXPECT_NEAR(surface_shares({waves(1.38, 0.25)}, true, {n, 1, cosine, 550}).reflected, 1, 1e-12);
    const double sine2 = 1 - cosine * cosine, decay = std::sqrt(n * n * sine2 - 1);
    const double inside = n * cosine, sinh = std::sinh(2 * kPi / 550 * decay * gap_nm);
    const auto through = [&](double q, double d) {
        return 1 / (1 + std::pow((q * q + d * d) / (2 * q * d) * sinh, 2));
    };
    const double expected = (through(inside, decay) + through(cosine / n, decay)) / 2;
    const SurfaceShares r = surface_shares({{gap_nm, 1}}, false, {n, n, cosine, 550});
    EXPECT_NEAR(r.transmitted, expected, 1e-12);
    EXPECT_NEAR(r.reflected, 1 - expected, 1e-12);
}

TEST(LayerStack, NamedCoatingsReflectWhatTheyAreMadeFor) {
    for (const double glass : {1.45, 1.52, 1.7, 1.88, 2.}) {
        const auto at = [&](Coating coating, double nm) {
            return surface_shares(layers_of(coating, glass), false, {1, glass, 1, nm}).reflected;
        };
        for (const float nm : {400.f, 550.f, 700.f})
            EXPECT_NEAR(
                at(Coating::MgF2, double(nm)),
                coated_reflectance({splat(1), splat(float(glass)), splat(1)}, splat(nm)).s[0],
                1e-6);
        if (glass < 1.9) {
            EXPECT_NEAR(at(Coating::VCoat, 550), 0, 1e-12) << glass;
        }
        EXPECT_NEAR(at(Coating::Broadband, 550), 0, 1e-12) << glass;
        for (double nm = 460; nm <= 660; nm += 10) EXPECT_LT(at(Coating::Broadband, nm), 0.008);
    }
}

TEST(LayerStack, ManyLayersOrNoneKeepAllTheLight) {
    test::Random random(7);
    for (int k = 0; k < 300; ++k) {
        LayerStack stack;
        const bool lossy = k % 3 == 0;
        for (int i = 0; i < 200; ++i)
            stack.push_back({i % 5 ? 300. * double(random.next()) : 0, 1.3 + double(random.next()),
                             0, lossy ? double(random.next()) : 0});
        const Incidence light{1 + 0.6 * double(random.next()), 1 + 0.6 * double(random.next()),
                              double(random.next()), 360 + 470 * double(random.next())};
        const SurfaceShares r = surface_shares(stack, k % 2, light);
        ASSERT_TRUE(r.reflected >= 0 && r.transmitted >= 0 && r.absorbed() >= -1e-12);
        if (!lossy) {
            ASSERT_NEAR(r.absorbed(), 0, 1e-6);
        }
    }
    for (const double cosine : {0., 1e-12, 1e-6}) {
        const SurfaceShares r =
            surface_shares({{0, 2}, {1e6, 2, 0, 20}}, false, {1, 1, cosine, 550});
        EXPECT_NEAR(r.reflected, 1, 1e-5);
        EXPECT_TRUE(r.transmitted >= 0);
    }
}

TEST(LensCoats, LieTheRightWayRoundAndLeaveCementBare) {
    Prescription file = test::read_lens("double-gauss-100mm-f2");
    const LayerStack dim{{20, 0.8, 0, 6}, {90, 1.38}};
    file.surfaces[0].coat = file.surfaces[1].coat = dim;
    const Lens lens(file);
    const LensCoats filed(lens, Coating::Filed), named(lens, Coating::Broadband);
    const double glass = lens.media()[1].index(550.);
    const auto front = surface_shares(dim, false, {1, glass, 1, 550}).reflected;
    const auto back = surface_shares(dim, true, {glass, 1, 1, 550}).reflected;
    const Incidence in{1, glass, 1, 550}, out{glass, 1, 1, 550};
    EXPECT_EQ(filed.at(0, Towards::Film, in).reflected, front);
    EXPECT_EQ(filed.at(0, Towards::Scene, out).reflected, back);
    EXPECT_EQ(filed.at(1, Towards::Film, out).reflected, back);
    EXPECT_EQ(filed.at(1, Towards::Scene, in).reflected, front);
    int coated = 0, bare = 0;
    for (int i = 0; i < lens.size(); ++i) {
        const auto& s = lens.surfaces<double>()[size_t(i)];
        EXPECT_EQ(named.ideal(i), s.medium_before == s.medium_after);
        EXPECT_EQ(named.layers(i).empty(), !touches_air(s));
        if (!named.ideal(i)) ++(touches_air(s) ? coated : bare);
    }
    EXPECT_EQ(coated, 8);
    EXPECT_EQ(bare, 2);
}

TEST(CoatTables, AreTheStacksWithinWhatTheySay) {
    const Lens lens(test::read_lens("double-gauss-100mm-f2"));
    test::Random random(3);
    for (const Coating coating : {Coating::VCoat, Coating::Broadband, Coating::Filed}) {
        const CoatTables tables(lens, coating);
        const LensCoats coats(lens, coating);
        for (int k = 0; k < 2000; ++k) {
            const int i = k % lens.size();
            const auto& s = lens.surfaces<double>()[size_t(i)];
            if (s.medium_before == s.medium_after) continue;
            const bool to_film = k & 16;
            const float nm = 360 + 470 * random.next(), cosine = 0.1f + 0.9f * random.next();
            const double before = lens.media()[s.medium_before].index(double(nm)),
                         after = lens.media()[s.medium_after].index(double(nm));
            const double from = to_film ? before : after, into = to_film ? after : before;
            const float t = tables.transmittance(
                i, {splat(float(from)), splat(float(into)), splat(cosine)}, splat(nm))[1];
            const double exact = coats
                                     .at(i, to_film ? Towards::Film : Towards::Scene,
                                         {from, into, double(cosine), double(nm)})
                                     .transmitted;
            ASSERT_NEAR(t, exact, 2e-3) << nm << ' ' << cosine;
            if (cosine > 0.8f) {
                ASSERT_NEAR(t, exact, 1e-3) << nm << ' ' << cosine;
            }
        }
    }
    const Crossing c{splat(1), splat(1.6f), splat(0.7f)};
    for (const Coating coating : {Coating::Uncoated, Coating::MgF2})
        EXPECT_EQ(CoatTables(lens, coating).transmittance(0, c, splat(450))[0],
                  transmittance(coating, c, true, splat(450))[0]);
}

// Of any layers, from thin ones to some whose fringes are narrower than a nanometre.
TEST(CoatTables, AreThatNearForLayersOfAnyThickness) {
    test::Random random(7);
    Prescription file = test::read_lens("cooke-triplet-50mm-f5");
    for (int n = 0; n < 120; ++n) {
        LayerStack layers(1 + size_t(6 * random.next()));
        const double scale_nm = std::pow(10., 1 + 3.5 * double(random.next()));
        for (Layer& layer : layers) {
            layer.index = 1.3 + 1.2 * double(random.next());
            layer.thickness_nm = scale_nm * double(random.next());
        }
        file.surfaces[0].coat = layers;
        const Lens lens(file);
        const CoatTables tables(lens, Coating::Filed);
        const LensCoats coats(lens, Coating::Filed);
        for (int k = 0; k < 200; ++k) {
            const float nm = 360 + 470 * random.next(), cosine = 0.1f + 0.9f * random.next();
            const double glass = lens.media()[1].index(double(nm));
            const float t = tables.transmittance(0, {splat(1), splat(float(glass)), splat(cosine)},
                                                 splat(nm))[0];
            const double exact =
                coats.at(0, Towards::Film, {1, glass, double(cosine), double(nm)}).transmitted;
            ASSERT_NEAR(t, exact, 2e-3) << scale_nm << ' ' << nm << ' ' << cosine;
        }
    }
}

}  // namespace
}  // namespace petzval::camera
