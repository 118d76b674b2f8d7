// SPDX-License-Identifier: Apache-2.0
// Findings about thin lenses, irises, traced lenses and their glasses.
#include <cmath>
#include <numbers>

#include "io/lens/lens_file.h"
#include "tests/stability/findings.h"
#include "tests/support/statistics.h"

namespace petzval::stability {
namespace {

TEST_F(Findings, ThirdOrderFormula) {  // doubles throughout
    take(third_order_formula());
    expect_column("1 % below f/",
                  "5.86 5.85 5.81 5.59 4.76 3.71 1.9 1.27 1.08 5.3 5.29 5.1 4.52 2.58 1.52 4.48 "
                  "4.82 4.14");
    expect_column("10 % below f/",
                  "1.9 1.9 1.88 1.8 1.55 1.26 0.981 0.938 0.943 1.76 1.76 1.71 1.58 1.32 1.27 "
                  "1.32 1.35 1.36");
    expect_column("1 px below f/",
                  "3.64 3.63 3.6 3.56 3.54 3.52 3.11 3.48 4.74 3.24 3.25 3.33 3.43 3.16 3.75 5.63 "
                  "6.85 8.09");
    expect_column("no ray below f/",
                  "1.03 1.02 0.996 0.961 0.928 0.924 0.932 0.938 0.943 0.977 0.981 1.02 1.08 1.19 "
                  "1.26 1.32 1.35 1.36");
    expect_column("refused below f/",
                  "0.918 0.912 0.862 0.794 0.744 0.759 0.811 0.849 0.872 0.967 0.967 0.967 0.967 "
                  "1.04 1.18 1.32 1.39 1.43");
    expect_where("1 5.86 10 1.9 3.64 10 1.9 8.09 1.05");
    EXPECT_NE(f.instead.find("warning: singlet:schott:N-BK7 at f/1.5: the formula"),
              std::string::npos);
    EXPECT_NE(f.instead.find("refused: \"the stop is too wide"), std::string::npos);
}

TEST_F(Findings, FocusNearFocalLength) {
    take(focus_near_focal_length());
    expect_column("magnification S'/S", "1 10 100 1000 10000 1e5 1e6 1e7 1e8");
    // A focus that is off by half a float's spacing, 2^-24 at worst: over S/f - 1. Of a hundred
    // focal lengths one comes near to that.
    for (size_t i = 0; i + 1 < rows(); ++i) {
        const double most = 0x1p-24 / std::pow(10, -double(i));
        EXPECT_LE(value(i, "error of S'"), 3 * most) << i;
        EXPECT_GE(value(i, "error of S'"), 0.5 * most) << i;
    }
    EXPECT_EQ(cell(8, "error of S'"), "infinity");
    expect_column("miss at the origin (px)",
                  "0.000355 0.00138 0.0168 0.131 1.37 20.3 186 1560 16000", kSizeOfRounding);
    expect_column("miss 1.7 m from it (px)", "0.0201 0.201 2.01 20.1 201 2020 20200 2.01e5 2e6",
                  kSizeOfRounding);
    expect_where("1 0.0201 1 1 1 49.6 0.000133 1 5.73e-6", kSizeOfRounding);
    EXPECT_NE(f.instead.find("has no image"), std::string::npos);
}

TEST_F(Findings, RejectionOfSlivers) {
    take(rejection_of_slivers());
    // 2000 fixed draws, of which roundings move those at the edge.
    expect_column("tries per point", "6.08 50.3 201 251 255 256 256", {.relative = 0.02});
    expect_column("give up", "0 0.5 61.1 95.3 99.3 100 100", {.absolute = 0.5});
    // A band of roundings at the edge, of 8192 points: the share is N times as wide.
    expect_column("drawn but called outside", "0 0 0 0.0244 0.244 1.16 40.6",
                  {.relative = 0.6, .absolute = 0.1});
    expect_where("1 1 118 1 718 1 1 4.06e5", {.factor = 1.5});
}

TEST_F(Findings, DegeneratePolygons) {
    take(degenerate_polygons());
    // Where roundings of floats, 6e-8, and of doubles, 1e-16, are a hundredth of the size or all.
    expect_column("area off below d", "none none 3.17e-11 none", {.factor = 5});
    expect_column("1 % called outside below d", "none none 2.36e-6 none", kSizeOfRounding);
    expect_column("strays below d", "none none none none");
    expect_column("refused below d", "none 8.71e-17 8.91e-18 none", {.factor = 20});
    EXPECT_NE(f.instead.find("edges must neither cross nor touch"), std::string::npos);
}

TEST_F(Findings, ChoiceByWeight) {
    take(choice_by_weight());
    for (size_t i = 0; i < rows(); ++i) {
        const double w = value(i, "w"), due = w / (1 + w);
        const double units = std::fmax(1, std::round(due * 0x1p24));
        for (const char* column : {"running sum: drawn / due", "alias table: drawn / due"})
            EXPECT_TRUE(near(value(i, column), units / (due * 0x1p24), kAsPrinted))
                << column << ' ' << w;
    }
    // 2.73 units of 2^-24 become 3, 10 % too many.
    expect_where("10 1.63e-7 0", {.relative = 0.02});
}

TEST_F(Findings, PupilAtWideFields) {
    take(pupil_at_wide_fields());
    EXPECT_EQ(rows(), io::list_lenses().size());
    struct Row {
        std::string lens, no_ray, traces, off, folded, heaviest, first;
    };
    const Row expected[] = {
        {"angenieux-50mm-f1.1", "45", "1.62", "-0.04", "0", "1.02", "0.65"},
        {"biotar-58mm-f1.4", "2.64", "1.57", "0.0427", "0", "1.17", "0.65"},
        {"canon-14mm-f2.8-asph", "0", "1.01", "-0.0814", "0", "1.13", "1.55"},
        {"cooke-triplet-50mm-f5", "0", "1", "-0.00261", "0", "1.1", "1.5"},
        {"double-gauss-100mm-f2", "0", "1", "0.0299", "0", "1.07", "1.95"},
        {"kodak-petzval-100mm-f2", "0", "1", "-0.00887", "0", "1.06", "2.3"},
        {"kreitzer-telephoto-400mm-f5.6", "0", "1", "0.0139", "0", "1.02", "none"},
        {"minolta-fisheye-16mm-f2.8", "0", "1", "-0.00969", "0", "1.13", "1.75"},
        {"nikkor-400mm-f2.8-fl", "0", "1", "0.0427", "0", "1.04", "2.15"},
        {"nikkor-retrofocus-28mm-f2.8", "0", "1", "-0.0504", "0", "1.06", "1.6"},
        {"noct-nikkor-58mm-f0.95", "0", "1.11", "-0.00497", "0", "1.13", "1.1"},
        {"petzval-portrait-100mm-f3.6", "0", "1", "-0.0202", "0", "1.02", "1.55"},
        {"phone-f3.5-asph", "0", "1.02", "-0.0186", "0", "1.12", "1.2"},
        {"primoplan-58mm-f1.5", "38.2", "1.43", "-2.47", "2.36", "*", "0.75"},
        {"schneider-anamorphic-31mm", "1.07", "1.24", "-0.0049", "0", "1.45", "0.95"},
        {"takumar-50mm-f1.2", "3.61", "1.48", "-0.0578", "0", "1.13", "0.9"},
        {"tessar-100mm-f2.8", "0", "1", "-0.00799", "0", "1.04", "1.2"},
        {"werfel-double-gauss-100mm-f1.25", "0", "1.28", "0.00111", "0", "1.14", "1.15"}};
    for (const Row& e : expected) {
        size_t i = 0;
        while (i < rows() && cell(i, "lens") != e.lens) ++i;
        ASSERT_LT(i, rows()) << e.lens;
        const auto expect = [&](const char* column, const std::string& wanted, Tolerance t) {
            expect_cell(cell(i, column), wanted, t, e.lens + ", " + column);
        };
        // Of 1024 fixed draws, roundings move those at the rim of what has a ray.
        expect("no ray", e.no_ray, {.absolute = 0.5});
        expect("traces (mean)", e.traces, {.relative = 0.02});
        // One draw at the rim decides; it may not take more than the solver is given.
        EXPECT_GE(value(i, "traces (most)"), value(i, "traces (mean)")) << e.lens;
        EXPECT_LE(value(i, "traces (most)"), 12) << e.lens;
        // 65536 draws and 400 x 400 directions are evenly spread: each is good to 0.1 %.
        expect("irradiance off by", e.off, {.absolute = 0.1});
        expect("light beyond a fold", e.folded, {.absolute = 0.1});
        expect("heaviest draw", e.heaviest, {.relative = 0.03});
        // In steps of 0.05, of which a rounding may take the next one.
        expect("first without a ray (circles)", e.first, {.absolute = 0.051});
        // Next to a fold weights are large, and which draw comes how near to it is chance.
        if (e.lens.starts_with("primoplan")) {
            EXPECT_GT(value(i, "heaviest draw"), 5);
            EXPECT_LT(value(i, "heaviest draw"), 300);
        }
    }
    expect_where("13 18 * 2.36 * *", {.absolute = 1});
}

TEST_F(Findings, RaysAtGrazingIncidence) {
    take(trace_at_grazing_incidence());
    expect_column("into a sphere (mm)", "1.56e-6 4.72e-6 2.92e-5 0.000417 0.00426 0.0185 0.0185",
                  kSizeOfRounding);
    // Of 512 rays; from 1e-4 on chance decides.
    expect_column("other status", "0 0 0 0 0 42.2 39.5", {.absolute = 10});
    expect_column("out of a plane (mm)", "2.49e-6 0.000135 0.00348 3.57 4670 * *", kSizeOfRounding);
    expect_column("other status there", "0 0 0 0 0 0.195 3.91", {.absolute = 2.5});
    expect_where("6 0.000727 0.0417 1 0.000365 0.0857 4.92", kSizeOfRounding);
}

TEST_F(Findings, RaysOverLongRadii) {
    take(trace_over_long_radii());
    expect_column("radius R (mm)", "6.44e-6 5.11e-6 6.5e-6 5.97e-6 4.86e-6 6.34e-6 4.72e-6 3.76e-6",
                  kSizeOfRounding);
    expect_column("distance D (mm)", "2.51e-6 1.47e-5 0.000175 0.00135 0.0147 0.224 1.34 15.9",
                  kSizeOfRounding);
    EXPECT_NE(f.where.find("Radii: no failure"), std::string::npos) << f.where;
    expect_where("1e2 1e12 6.5e-6 6 3.65e5", kSizeOfRounding);
}

TEST_F(Findings, NewtonOnStrongAspheres) {
    take(newton_on_strong_aspheres());
    expect_column("lens",
                  "canon-14mm-f2.8-asph noct-nikkor-58mm-f0.95 noct-nikkor-58mm-f0.95 "
                  "noct-nikkor-58mm-f0.95 phone-f3.5-asph phone-f3.5-asph phone-f3.5-asph "
                  "phone-f3.5-asph phone-f3.5-asph phone-f3.5-asph phone-f3.5-asph "
                  "phone-f3.5-asph");
    expect_column("surface", "3 1 20 28 2 3 4 5 6 7 8 9");
    expect_column("departure at the rim / semi-diameter",
                  "0.115 0.0168 0.0164 0.0222 0.0381 0.059 0.105 0.12 0.107 0.192 0.344 0.545");
    // One ray of 96 decides, on steps of 10^(1/5); at 9650 of 10000 it may as well be none.
    const Tolerance step{.factor = 1.6};
    expect_column("a miss from", "none none none none none * none 9.43 none 262 43.7 none", step);
    expect_column("10 % miss from", "none none none none none none none 855 none 404 147 none",
                  step);
    expect_column("another point from", "none none none none none none none 11.5 none 634 356 none",
                  step);
    expect_where("9.43 1.13", step);
}

TEST_F(Findings, DispersionOutOfRange) {
    take(dispersion_out_of_range());
    // Glasses are counted, by formulas in doubles: one may stand at the edge.
    const Tolerance one{.absolute = 1};
    expect_column("formula", "Sellmeier *");
    expect_column("glasses", "655 972", {});
    expect_column("not a number", "302 11", one);
    expect_column("below 1", "275 15", one);
    expect_column("jumps", "340 125", one);
    expect_column("breaks below (nm)", "304 250", one);
    expect_column("breaks above (nm)", "none none");
    expect_column("as used: any of these", "1 0", {});
    expect_where("465 1627 304 1 360 830 926 0.0961", {.relative = 0.005});
    EXPECT_NE(f.instead.find("the glass POLE has coefficients (CD)"), std::string::npos);
}

}  // namespace
}  // namespace petzval::stability
