// SPDX-License-Identifier: Apache-2.0
#include "camera/models/thin_lens_optics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "camera/models/aberrated_lens.h"
#include "tests/support/traced_singlets.h"

namespace petzval::camera {
namespace {

constexpr double kInfinite_m = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Schott's catalogue of 1992: BK7 by the power series. nd 1.51680, nF 1.52238, nC 1.51432.
Glass bk7() {
    return {"BK7", PowerSeries{{{2.2718929, 0},
                                {-1.0108077e-2, 2},
                                {1.0592509e-2, -2},
                                {2.0816965e-4, -4},
                                {-7.6472538e-6, -6},
                                {4.9240991e-7, -8}}}};
}
// Schott's catalogue of 2023: N-SF11 by Sellmeier's formula. nd 1.78472, nF 1.80651, nC 1.77596.
Glass index_of_sf11() {
    return {"N-SF11",
            Sellmeier{
                {{1.73759695, 0.013188707}, {0.313747346, 0.0623068142}, {1.89878101, 155.23629}}}};
}
Glass constant_of(double n) {
    return {"constant", IndexTable{{{587, n}}}};
}

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "nothing was refused";
}
bool says(const std::function<void()>& act, const char* words) {
    return refusal(act).find(words) != std::string::npos;
}

TEST(ThinLensOptics, RadiiAndGlassGiveTheFocalLength) {
    // Worked by hand: 0.5 (1/50 + 1/100) = 0.015; q = (-100 + 50) / (-100 - 50).
    const SingletOptics lens = Singlet{constant_of(1.5), 50, -100}.at(550);
    EXPECT_NEAR(lens.focal_mm, 1 / 0.015, 1e-12);
    EXPECT_NEAR(lens.bending, 1. / 3, 1e-15);
    const SingletOptics flat_behind = Singlet{constant_of(1.5), 50, kInfinite_m}.at(550);
    EXPECT_NEAR(flat_behind.focal_mm, 100, 1e-12);
    EXPECT_EQ(flat_behind.bending, 1);
    for (const double q : {-5., -1., -0.3, 0., 1., 4.}) {
        const SingletOptics bent = Singlet::bent(bk7(), 85, q).at(kLineD_nm);
        EXPECT_NEAR(bent.focal_mm, 85, 1e-10) << q;
        EXPECT_NEAR(bent.bending, q, 1e-13) << q;
    }
}

TEST(ThinLensOptics, AnyTwoOfFocusFilmAndFocalLengthGiveTheThird) {
    EXPECT_NEAR(image_distance_mm(50, 2050), 51.25, 1e-12);  // 50 * 2050 / 2000
    EXPECT_NEAR(object_distance_mm(50, 51.25), 2050, 1e-9);
    EXPECT_NEAR(focal_length_between_mm(2050, 51.25), 50, 1e-12);
    EXPECT_EQ(image_distance_mm(50, kInfinite_m), 50);
    EXPECT_EQ(object_distance_mm(50, 50), kInfinite_m);
    EXPECT_EQ(focal_length_between_mm(kInfinite_m, 50), 50);
    EXPECT_NEAR(image_distance_mm(50, 100), 100, 1e-12);
}

// The law as it is often printed, K h^2 / 2, and the factor (S'/f)^2 that a finite object needs.
TEST(ThinLensOptics, SphericalAberrationAgreesWithTraces) {
    int finite = 0;
    for (const auto& row : test::kTracedSinglets) {
        const SingletOptics lens{row.n, 100, row.bending};
        const bool far = row.object_mm == kInfinite_m;
        const double k = spherical_coefficient_per_mm(lens, row.object_mm);
        const double stretch = image_distance_mm(100, row.object_mm) / 100;
        const auto error = [&](double mm, int i) { return std::fabs(mm / row.at[i] - 1); };
        SCOPED_TRACE(testing::Message()
                     << "n " << row.n << " S " << row.object_mm << " q " << row.bending);
        // h = f / 100
        EXPECT_LT(error(spherical_aberration_mm(lens, row.object_mm, 1), 0), 2.5e-4);
        EXPECT_LT(error(stretch * stretch * k / 2, 0), far ? 2e-4 : 1.6e-3);
        if (!far) {
            EXPECT_GT(error(k / 2, 0), 0.4) << "K h^2 / 2 holds for an object at infinity only";
            ++finite;
        } else if (row.bending != 0) {
            // p with its sign turned is the lens turned round.
            EXPECT_GT(
                error(spherical_coefficient_per_mm({row.n, 100, -row.bending}, kInfinite_m) / 2, 0),
                0.4);
        }
        // The domain: 1 % to f / 20 (and f / 16), 10 % to f / 5.
        EXPECT_LT(error(spherical_aberration_mm(lens, row.object_mm, 5), 1), 0.006);
        EXPECT_LT(error(spherical_aberration_mm(lens, row.object_mm, 10), 2), 0.023);
        EXPECT_LT(error(spherical_aberration_mm(lens, row.object_mm, 20), 3), 0.095);
        EXPECT_LT(spherical_aberration_error(lens, row.object_mm, 100 / 16.), 0.01);
        EXPECT_LT(spherical_aberration_error(lens, row.object_mm, 20), 0.1);
        for (int i = 0; i < 4; ++i) {
            const double h = test::kTracedHeights_mm[i];
            const auto traced = traced_spherical_aberration_mm(lens, row.object_mm, h);
            ASSERT_TRUE(traced);
            EXPECT_LT(error(*traced, i), 1e-9);
            EXPECT_NEAR(spherical_aberration_error(lens, row.object_mm, h),
                        error(spherical_aberration_mm(lens, row.object_mm, h), i), 1e-9);
        }
    }
    EXPECT_EQ(finite, 42);
}

// Coddington's best form for a distant object: q = 2 (n^2 - 1) / (n + 2).
TEST(ThinLensOptics, BestFormIsTheLeastAberrated) {
    for (const double n : {1.5, 1.8}) {
        const auto k = [&](double q) {
            return spherical_coefficient_per_mm({n, 100, q}, kInfinite_m);
        };
        const double best = 2 * (n * n - 1) / (n + 2);
        EXPECT_LT(k(best), k(best + 0.01));
        EXPECT_LT(k(best), k(best - 0.01));
    }
    // An object and an image that change places see the lens turned round, and the same K.
    EXPECT_NEAR(spherical_coefficient_per_mm({1.6, 80, 0.7}, 120),
                spherical_coefficient_per_mm({1.6, 80, -0.7}, 240), 1e-15);
}

TEST(ThinLensOptics, TellsWhereTheFormulaIsOutOfItsDomain) {
    const SingletOptics lens{1.5, 100, -2};
    EXPECT_EQ(spherical_aberration_error(lens, kInfinite_m, 30), kInfinite_m) << "reflected within";
    EXPECT_FALSE(traced_spherical_aberration_mm(lens, kInfinite_m, 30));
    EXPECT_EQ(spherical_aberration_error({6, 100, 0}, 101, 136), kInfinite_m) << "f(h) is below 0";
    EXPECT_TRUE(traced_spherical_aberration_mm({6, 100, 0}, 101, 136));
    EXPECT_EQ(spherical_aberration_error(lens, kInfinite_m, 0), 0);
    EXPECT_GT(spherical_aberration_error(lens, kInfinite_m, 22), 0.1);
    EXPECT_TRUE(
        says([&] { (void)spherical_aberration_mm(lens, kInfinite_m, 330); }, "narrow the stop"));
}

// A print of Schott's formula has n^2 = a0 * a1 L^2 + ...; catalogues add the first two terms.
TEST(ThinLensOptics, SchottsFormulaIsASum) {
    const Glass glass = bk7();
    EXPECT_NEAR(glass.index(kLineD_nm), 1.51680, 1e-5);
    EXPECT_NEAR(glass.index(kLineF_nm), 1.52238, 1e-5);
    EXPECT_NEAR(glass.index(kLineC_nm), 1.51432, 1e-5);
    const double w2 = 0.5875618 * 0.5875618;
    const double misprinted =
        2.2718929 * -1.0108077e-2 * w2 + 1.0592509e-2 / w2 + 2.0816965e-4 / (w2 * w2);
    EXPECT_LT(misprinted, 0.1) << "n^2 of no glass";
}

TEST(ThinLensOptics, FocalLengthFollowsTheIndex) {
    struct Case {
        Glass glass;
        double nd, nF, nC, abbe;  // as the catalogues print them
    };
    for (const auto& [glass, nd, nF, nC, abbe] :
         {Case{bk7(), 1.51680, 1.52238, 1.51432, 64.17},
          Case{index_of_sf11(), 1.78472, 1.80651, 1.77596, 25.68}}) {
        const Singlet lens = Singlet::bent(glass, 100, 0.5);
        const double f_F = lens.at(kLineF_nm).focal_mm, f_C = lens.at(kLineC_nm).focal_mm;
        EXPECT_NEAR(lens.at(kLineD_nm).focal_mm, 100, 1e-10);
        EXPECT_NEAR(f_F, 100 * (nd - 1) / (nF - 1), 3e-3) << glass.name;
        EXPECT_NEAR(f_C, 100 * (nd - 1) / (nC - 1), 3e-3) << glass.name;
        EXPECT_NEAR((1 / f_F - 1 / f_C) * 100 * abbe, 1, 1e-3) << "power spreads by 1 / V";
    }
}

TEST(ThinLensOptics, RefusesWhatHasNoImage) {
    for (const double s : {10., 49., 50.})
        EXPECT_TRUE(
            says([&] { (void)image_distance_mm(50, s); }, "within the focal length, 50 mm"));
    EXPECT_TRUE(std::isfinite(image_distance_mm(50, std::nextafter(50., 60.))));
    EXPECT_TRUE(says([] { (void)object_distance_mm(50, 49); }, "within the focal length"));
    for (const double bad : {0., -1., kNan}) {
        EXPECT_TRUE(says([&] { (void)image_distance_mm(bad, 100); }, "focal length must be"));
        EXPECT_TRUE(says([&] { (void)image_distance_mm(50, bad); }, "object distance must be"));
        EXPECT_TRUE(says([&] { (void)object_distance_mm(50, bad); }, "film distance must be"));
    }
    EXPECT_TRUE(says([] { (void)image_distance_mm(kInfinite_m, kInfinite_m); }, "must be finite"));
}

TEST(ThinLensOptics, RefusesWhatIsNoLens) {
    const auto lens = [](double n, double r1, double r2) {
        return [=] { (void)Singlet{constant_of(n), r1, r2}.at(550); };
    };
    EXPECT_TRUE(says(lens(1, 50, -50), "does not gather light")) << "n = 1";
    EXPECT_TRUE(says(lens(1.5, 50, 50), "does not gather light")) << "a watch glass";
    EXPECT_TRUE(says(lens(1.5, kInfinite_m, kInfinite_m), "does not gather light")) << "a window";
    EXPECT_TRUE(says(lens(1.5, -50, 50), "does not gather light"));
    EXPECT_TRUE(says(lens(1.5, kNan, 50), "radii")) << "NaN";
    EXPECT_TRUE(says(lens(kNan, 50, -50), "does not gather light"));
    EXPECT_TRUE(says(lens(1.5, 0, 50), "radii of a lens must not be 0"));
    for (const double q : {kInfinite_m, -kInfinite_m, kNan})
        EXPECT_TRUE(says([&] { (void)Singlet::bent(bk7(), 50, q); }, "bending"));
    EXPECT_TRUE(says([] { (void)Singlet::bent(constant_of(1), 50, 0); }, "index"));
    EXPECT_TRUE(says([] { (void)spherical_coefficient_per_mm({1, 50, 0}, kInfinite_m); }, "index"));
    EXPECT_TRUE(says([] { (void)spherical_coefficient_per_mm({1.5, 50, 0}, 0); }, "object"));
    // Near the limits everything stays a number.
    EXPECT_TRUE(std::isfinite(Singlet::bent(constant_of(1 + 1e-9), 50, 0).at(550).focal_mm));
    EXPECT_TRUE(std::isfinite(spherical_coefficient_per_mm({1 + 1e-9, 50, 1e9}, kInfinite_m)));
    EXPECT_EQ(spherical_aberration_mm({1.5, 50, 1e9}, kInfinite_m, 0), 0);
}

}  // namespace
}  // namespace petzval::camera
