// SPDX-License-Identifier: Apache-2.0
// The numbers of each finding of the map of failures: against theory where there is one, else
// against those that were found first, with a tolerance that has a reason. Processors and compilers
// may round otherwise, in the C library, in Embree, and where products and sums are contracted.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>

#include "apps/stability/sweeps.h"
#include "core/traversal/bvh.h"
#include "io/lens/lens_file.h"
#include "tests/support/statistics.h"

namespace petzval::stability {
namespace {

/// How far a number may be off: in proportion, and besides.
struct Tolerance {
    double relative = 0, absolute = 0;
    double factor = 1;  ///< in place of both: so many times as much, or as little
};
/// Cells have three digits, and places of failure are bisected to 1e-3.
constexpr Tolerance kAsPrinted{.relative = 0.01};
/// The greatest of some hundred roundings: with others it is another one, of the same size.
/// Products that are contracted with sums move it by 3.2 times at most.
constexpr Tolerance kSizeOfRounding{.factor = 5};

bool near(double found, double expected, const Tolerance& t) {
    if (found == expected) return true;
    if (!std::isfinite(found) || !std::isfinite(expected)) return false;
    if (t.factor != 1)
        return found * expected > 0 && std::fabs(std::log(found / expected)) <= std::log(t.factor);
    return std::fabs(found - expected) <= t.relative * std::fabs(expected) + t.absolute;
}

/// A cell, of which a percentage is its number; nothing for what is not a number.
std::optional<double> number_in(const std::string& cell) {
    std::istringstream text(cell);
    std::string first, unit, rest;
    text >> first >> unit >> rest;
    if (!rest.empty() || (!unit.empty() && unit != "%")) return std::nullopt;
    if (first == "infinity") return HUGE_VAL;
    size_t used = 0;
    try {
        const double a = std::stod(first, &used);
        if (used == first.size()) return a;
    } catch (const std::logic_error&) {
    }
    return std::nullopt;
}

std::vector<std::string> split(const std::string& words) {
    std::istringstream text(words);
    return {std::istream_iterator<std::string>(text), {}};
}

/// Expected: a number; "none", as it stands; "-" for an empty cell; "*" for anything.
void expect_cell(const std::string& found, const std::string& expected, const Tolerance& t,
                 const std::string& where) {
    if (expected == "*") return;
    const auto wanted = number_in(expected), is = number_in(found);
    if (wanted && is)
        EXPECT_TRUE(near(*is, *wanted, t)) << where << ": " << found << ", not " << expected;
    else
        EXPECT_EQ(found, expected == "-" ? "" : expected) << where;
}

/// The sweeps run as stability_findings() runs them.
class Findings : public ::testing::Test {
  protected:
    explicit Findings() { flush_denormals(); }

    void take(Finding finding) { f = std::move(finding); }
    [[nodiscard]] size_t rows() const { return f.table.rows.size(); }
    [[nodiscard]] const std::string& cell(size_t row, const std::string& column) const {
        const auto& names = f.table.columns;
        const auto at = std::find(names.begin(), names.end(), column);
        if (at == names.end()) throw std::out_of_range("no column " + column);
        return f.table.rows.at(row).at(size_t(at - names.begin()));
    }
    [[nodiscard]] double value(size_t row, const std::string& column) const {
        return number_in(cell(row, column)).value_or(NAN);
    }
    void expect_column(const std::string& column, const std::string& expected,
                       const Tolerance& t = kAsPrinted) const {
        const auto cells = split(expected);
        ASSERT_EQ(rows(), cells.size()) << column;
        for (size_t i = 0; i < cells.size(); ++i)
            expect_cell(cell(i, column), cells[i], t, column + ", row " + std::to_string(i + 1));
    }
    /// The numbers of the sentence, in its order; those of names are none.
    void expect_where(const std::string& expected, const Tolerance& t = kAsPrinted) const {
        const std::regex number("(^|[ (/:])([-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?)(?=$|[ ,;:.)])");
        std::vector<std::string> found;
        for (std::sregex_iterator i(f.where.begin(), f.where.end(), number), end; i != end; ++i)
            found.push_back((*i)[2]);
        const auto wanted = split(expected);
        ASSERT_EQ(found.size(), wanted.size()) << f.where;
        for (size_t i = 0; i < found.size(); ++i) expect_cell(found[i], wanted[i], t, f.where);
    }

    Finding f;
};

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
    EXPECT_EQ(rows(), list_lenses().size());
    struct Row {
        std::string lens, no_ray, traces, off, folded, heaviest, first;
    };
    const Row expected[] = {
        {"angenieux-50mm-f1.1", "45", "1.62", "1.52", "0", "1.02", "0.65"},
        {"biotar-58mm-f1.4", "2.64", "1.57", "-0.0341", "0", "1.17", "0.65"},
        {"canon-14mm-f2.8-asph", "0", "1.01", "0.072", "0", "1.13", "1.55"},
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
        {"primoplan-58mm-f1.5", "38.2", "1.43", "-3.02", "2.36", "*", "0.75"},
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

TEST_F(Findings, MarchAtGrazingIncidence) {
    take(trace_at_grazing_incidence());
    expect_column("into a sphere (mm)", "1.56e-6 4.72e-6 2.92e-5 0.000417 0.00426 0.0185 0.0185",
                  kSizeOfRounding);
    // Of 512 rays; from 1e-4 on chance decides.
    expect_column("other status", "0 0 0 0 0 42.2 39.5", {.absolute = 10});
    expect_column("out of a plane (mm)", "2.49e-6 0.000135 0.00348 3.57 4670 * *", kSizeOfRounding);
    expect_column("other status there", "0 0 0 0 0 0.195 3.91", {.absolute = 2.5});
    expect_where("6 0.000727 0.0417 1 0.000365 0.0857 4.92", kSizeOfRounding);
}

TEST_F(Findings, MarchOverLongRadii) {
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

TEST_F(Findings, SceneScale) {
    take(scene_scale());
    // Where squares leave the range of floats, at about 1e-19 and 1e19 of something of the size of
    // the radius or of a triangle, Embree's kernels differ: two decades within nothing leaks, and
    // beyond nearly all does.
    for (size_t i = 0; i < rows(); ++i) {
        const double radius = value(i, "radius (m)");
        if (radius >= 1e-6 && radius <= 1e8) {
            EXPECT_EQ(cell(i, "leaks"), "0 %") << radius;
            EXPECT_EQ(cell(i, "self-hits"), "0 %") << radius;
        }
        if (radius <= 1e-12 || radius >= 1e13) {
            EXPECT_GT(value(i, "leaks"), 10) << radius;
        }
        const double away = value(i, "away (radii)");
        if (away <= 1e5) {
            EXPECT_EQ(cell(i, "leaks there"), "0 %") << away;
            EXPECT_EQ(cell(i, "self-hits there"), "0 %") << away;
        }
        if (away >= 1e7) {
            EXPECT_GT(value(i, "leaks there"), 50) << away;
        }
    }
    expect_where("7.04e-9 3.28e10 1.05e6", {.factor = 10});
}

TEST_F(Findings, CameraFarFromOrigin) {
    take(camera_far_from_origin());
    expect_column("off (px)", "0.00447 0.0137 0.123 0.962 14.6 112 1130 15700", kSizeOfRounding);
    expect_where("67.8 1000 1", kSizeOfRounding);
}

TEST_F(Findings, GgxEnergy) {
    take(ggx_energy());
    // 16384 evenly spread samples and three digits: 0.005 where all comes back, more where samples
    // weigh unequally.
    const Tolerance even{.absolute = 0.006}, uneven{.absolute = 0.012};
    expect_column("metal at cosine 1", "1 1 1 1 1 1 1 1 1 1", even);
    expect_column("0.1", "1 1 1 1 1 0.999 0.999 1 1 1", even);
    expect_column("0.01", "1 1 1 1.01 0.996 1 1 1 1 1", even);
    expect_column("1e-4", "1 1 1.01 1.02 1 1 1 1 1 1", uneven);
    expect_column("plastic at 0.1", "1 1 1 1 1 1 0.999 1 1 1", even);
    expect_column("plastic at 1e-4", "1 1 1.01 1.01 1 0.999 1 1 1 1", uneven);
    expect_column("glass at 1", "1 1 1 1 1 1 0.999 0.992 0.969 0.894", even);
    expect_column("glass at 0.1", "1 1 1 1 0.996 0.951 0.922 0.892 0.728 0.42", uneven);
    expect_column("glass at 1e-4", "1 1 0.98 0.992 0.998 0.996 0.982 0.877 0.662 0.358", uneven);
    // Where 1 % is first passed hangs on noise of half of that.
    expect_where("1 * 1.51 0.05 * 1 60 0.335 35.8 0", {.relative = 0.3, .absolute = 0.02});
    EXPECT_TRUE(f.where.ends_with("not numbers: 0")) << f.where;
}

TEST_F(Findings, GgxDensity) {
    take(ggx_density());
    for (const char* column : {"cosine 1", "0.5", "0.1", "0.01", "1e-3", "1e-4"})
        expect_column(column, "1 1 1 1 1 1", {.absolute = 0.006});
    EXPECT_EQ(f.fails, "nothing");
}

/// Of a variance 1 / p - 1 that some thousands of samples found, or none: those that found light
/// are p of 65536, and a number of n independent ones is good to 1 / sqrt(n), 4.4 times at most.
Tolerance rare(double variance) {
    return {.factor = 1 + 4.4 / std::sqrt(std::fmax(65536 / (1 + variance), 2))};
}

TEST_F(Findings, TinySun) {
    take(tiny_sun());
    // 65536 samples of a variance of about 1.
    expect_column("both (as rendered)", "0.834 1.07 1.06 1.05 1.05", {.relative = 0.03});
    expect_column("light samples only", "1.02 1.08 1.06 1.05 1.05", {.relative = 0.03});
    const double variance[] = {19.9, 314, 3720, 22400};
    for (size_t i = 0; i < 4; ++i)
        EXPECT_TRUE(near(value(i, "surface samples only"), variance[i], rare(variance[i]))) << i;
    // In the last row less than one is to be expected.
    expect_where("10000 1 1e8 512 680 1.07", {.factor = 2.1});
}

TEST_F(Findings, TinyLamp) {
    take(tiny_lamp());
    // What varies is the angle to a lamp of that side, 10 m away.
    expect_column("both (as rendered)", "0.00036 4.41e-6 * * * *", {.relative = 0.1});
    expect_column("light samples only", "0.000341 4.37e-6 * * * *", {.relative = 0.1});
    for (size_t i = 2; i < rows(); ++i)
        for (const char* column : {"both (as rendered)", "light samples only"})
            EXPECT_EQ(cell(i, column), "below 1e-9") << i;
    const double alone[] = {35.6, 313}, behind_glass[] = {84.8, 682};
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(near(value(i, "surface samples only"), alone[i], rare(alone[i]))) << i;
        EXPECT_TRUE(
            near(value(i, "as rendered behind glass"), behind_glass[i], rare(behind_glass[i])))
            << i;
    }
    for (size_t i = 3; i < rows(); ++i)  // of the third row two are to be expected
        for (const char* column : {"surface samples only", "as rendered behind glass"})
            EXPECT_EQ(cell(i, column), "none of 65536 found it") << i;
    // Six hits and seven are to either side of it: in proportion to the side's square.
    expect_where("10000 1 1e8 0.18 0.283 65536 1", {.factor = 1.6});
}

TEST_F(Findings, DefocusedHighlights) {
    take(defocused_highlights());
    for (size_t i = 0; i < rows(); ++i) {
        const double side = value(i, "side (m)"), fstop = value(i, "f/");
        // A thin lens of 50 mm in focus at 1 m, 9 m before the highlight.
        const double there = 0.05 / fstop * 9;
        const double share = side * side / (std::numbers::pi / 4 * there * there);
        EXPECT_TRUE(near(value(i, "blur there (m)"), there, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "share"), share, kAsPrinted)) << i;
        EXPECT_TRUE(near(value(i, "blur (px)"), there / 10 * (50 / 0.95) / 0.006, kAsPrinted)) << i;
        const double variance = std::fmax(1 / share - 1, 0);
        // Hits among 131072 samples: at least as even as independent ones.
        const Tolerance chance{.relative = 0.01 + 4.4 / std::sqrt(131072 * std::fmin(share, 1))};
        EXPECT_TRUE(near(value(i, "variance"), variance, chance)) << i;
        EXPECT_TRUE(near(value(i, "samples for 10 %"), 100 * variance, chance)) << i;
    }
    // From 128 means: a variance is good to sqrt(2 / 128), 4.4 times at most.
    expect_column("gain of Owen", "7.86 4.17 - - - 11.2 8.56 -", {.relative = 0.55});
    // Where 1 / share is 100 and 1000.
    expect_where("1 1 1.4 0.321 99 0.0285 999 0.00907 2.82", {.relative = 0.08});
}

TEST_F(Findings, ChainsOfGlass) {
    take(chains_of_glass());
    // 8192 fixed samples: roundings change few of their choices.
    const Tolerance few{.relative = 0.02, .absolute = 0.1};
    expect_column("panes", "1 2 3 4 6 8 12 16 32");
    expect_column("lost at depth 16", "0 0 0.0366 0.671 11.6 22.8 75.8 75.8 75.8", few);
    expect_column("lost at depth 64", "0 0 0 0 0 0.0488 1.17 7.3 39.4", few);
    for (size_t i = 0; i < rows(); ++i) {
        EXPECT_EQ(cell(i, "lost at depth 1000"), "0 %") << i;
    }
    // Roulette's weights have a long tail: the more panes, the fewer samples make the variance.
    expect_column("variance at 1000", "0.0497 0.162 0.294 0.443 0.814 1.33 3.39 * *",
                  {.relative = 0.1});
    EXPECT_GT(value(7, "variance at 1000"), 5);
    EXPECT_GT(value(8, "variance at 1000"), 10);
    expect_where("16 1 5 9 1 7", {});
}

TEST_F(Findings, NestedVolumes) {
    take(nested_volumes());
    for (size_t i = 0; i < rows(); ++i) {
        const double a = value(i, "a");
        EXPECT_TRUE(near(value(i, "comes through"), a * a, kAsPrinted)) << a;
        EXPECT_TRUE(near(value(i, "should"), a * a * a, kAsPrinted)) << a;
        EXPECT_TRUE(near(value(i, "ratio"), 1 / a, kAsPrinted)) << a;
    }
    expect_where("100 0.01");
}

TEST_F(Findings, ManySamples) {
    take(many_samples());
    ASSERT_EQ(rows(), 11u);
    double n = 256;
    for (size_t i = 0; i < 8; ++i, n *= 4) {
        // Hits of independent points are binomial; their squared errors over 4 seeds, chi-square.
        const double p = std::numbers::pi / 4, variance = p * (1 - p) / n;
        const double squares = 4 * std::pow(value(i, "independent"), 2) / variance;
        EXPECT_GE(test::chi_square_p(squares, 4), test::sidak()) << n;
        EXPECT_LE(test::chi_square_p(squares, 4), 1 - test::sidak()) << n;
    }
    // Of four seeds; a point at the disk's edge is rounded to either side.
    expect_column("Owen", "0.00536 0.000944 0.000611 0.0003 0.000162 4.35e-5 1.42e-5 4.8e-6 - - -",
                  {.factor = 1.5});
    expect_column("Sobol", "0.00489 0.00152 0.000753 7.39e-5 0.00012 4.26e-5 1.27e-5 2.24e-6 - - -",
                  {.factor = 1.5});
    for (size_t i = 4; i < rows(); ++i) {
        EXPECT_EQ(cell(i, "empty by Owen"), "0") << i;
        EXPECT_EQ(cell(i, "empty by Sobol"), "0") << i;
        // Each of N cells is empty with the chance 1 / e; the variance of their number is
        // N (1 / e - 2 / e^2).
        const double cells = 65536, e = std::numbers::e;
        const double error = std::sqrt(cells * (1 / e - 2 / (e * e)));
        EXPECT_TRUE(test::agrees({value(i, "empty by independent"), error}, cells / e)) << i;
    }
    EXPECT_EQ(f.fails, "nothing");
}

TEST_F(Findings, FilmSums) {
    take(film_sums());
    for (size_t i = 0; i < rows(); ++i)  // sums of doubles: half a float's spacing at 1
        EXPECT_LE(value(i, "error of the mean"), 0x1p-24 * 1.01) << i;
    // Sums of floats, whose roundings are added up in a fixed order.
    expect_column("stated / exact standard error", "1 1 1 1 1 1 1 1.06 1.3", {.relative = 0.02});
    EXPECT_EQ(f.fails, "bias of the stated error");
}

}  // namespace
}  // namespace petzval::stability
