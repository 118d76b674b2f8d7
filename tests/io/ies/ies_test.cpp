// SPDX-License-Identifier: Apache-2.0
#include "io/ies/ies.h"

#include <gmock/gmock.h>

#include <numbers>

#include "io/base/error.h"

namespace petzval::io {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Text of a file. ballast: the three numbers about it. body: angles and intensities.
std::string ies(const std::string& counts_and_type, const std::string& body,
                const std::string& ballast = "1 1 60", const std::string& multiplier = "1",
                const std::string& version = "IESNA:LM-63-2002",
                const std::string& tilt = "TILT=NONE") {
    return version + "\n[TEST] none\n[MANUFAC] nobody\n" + tilt + "\n1 -1 " + multiplier + " " +
           counts_and_type + " 2 0 0 0\n" + ballast + "\n" + body + "\n";
}

LightProfile parsed(const std::string& text) {
    return parse_ies(text, "a.ies", "").profile;
}

/// Intensity at angles of type C: vertical from straight on, horizontal from x to y.
double at(const LightProfile& profile, double vertical_deg, double horizontal_deg) {
    const double v = vertical_deg * kRadians, h = horizontal_deg * kRadians;
    return double(profile.intensity(
        V3f(V3d(std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), std::cos(v)))));
}

void expect_refused(const std::string& text, const std::string& message) {
    try {
        (void)parse_ies(text, "a.ies", "/extensions/0");
        ADD_FAILURE() << "accepted where this was expected: " << message;
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
}

TEST(Ies, UniformLightIsTheSameInAllDirections) {
    const LightProfile profile = parsed(ies("2 1 1", "0 180\n0\n50 50"));
    for (double v = 0; v <= 180; v += 7.5)
        for (double h = -180; h < 360; h += 11) EXPECT_EQ(at(profile, v, h), 50) << v << " " << h;
    EXPECT_NEAR(profile.flux_lm(), 4 * std::numbers::pi * 50, 1e-3);
    EXPECT_FLOAT_EQ(profile.reach_rad(), kPi);
}

TEST(Ies, HalfOfTheSphereIsDarkWhereItWasNotMeasured) {
    const LightProfile down = parsed(ies("2 1 1", "0 90\n0\n50 50"));
    EXPECT_EQ(at(down, 89, 20), 50);
    EXPECT_EQ(at(down, 91, 20), 0);
    EXPECT_NEAR(down.flux_lm(), 2 * std::numbers::pi * 50, 1e-3);
    EXPECT_FLOAT_EQ(down.reach_rad(), kPi / 2);
    const LightProfile up = parsed(ies("2 1 1", "90 180\n0\n50 50"));
    EXPECT_EQ(at(up, 89, 20), 0);
    EXPECT_EQ(at(up, 91, 20), 50);
}

TEST(Ies, ReachIsWhereTheLastLightEnds) {
    EXPECT_FLOAT_EQ(parsed(ies("4 1 1", "0 30 60 90\n0\n5 0 0 0")).reach_rad(), kPi / 6);
    EXPECT_FLOAT_EQ(parsed(ies("4 1 1", "0 30 60 90\n0\n5 0 1 0")).reach_rad(), kPi / 2);
    EXPECT_FLOAT_EQ(parsed(ies("3 2 2", "-90 0 90\n-90 90\n0 1 0\n0 1 0")).reach_rad(), kPi / 2);
}

// A Lambertian lamp of 100 cd has 100 pi lumen; knots every degree are off by 1/12 of a degree
// squared.
TEST(Ies, CosineHasItsFluxAndIsLinearBetweenKnots) {
    std::string angles, values;
    for (int v = 0; v <= 90; ++v) {
        angles += std::to_string(v) + (v % 10 == 9 ? "\n" : " ");
        values += std::to_string(100 * std::cos(v * kRadians)) + (v % 7 == 6 ? "\r\n" : ", ");
    }
    const LightProfile profile = parsed(ies("91 1 1", angles + "\n0\n" + values));
    EXPECT_NEAR(profile.flux_lm(), 100 * std::numbers::pi, 0.02);
    for (double v = 0; v < 90; v += 1.3)
        EXPECT_NEAR(at(profile, v, 40), 100 * std::cos(v * kRadians), 5e-3) << v;
    const double between = (100 * std::cos(10 * kRadians) + 100 * std::cos(11 * kRadians)) / 2;
    EXPECT_NEAR(at(profile, 10.5, 0), between, 1e-3);
}

TEST(Ies, FactorsMultiply) {
    const auto value = [](const std::string& version) {
        return at(parsed(ies("2 1 1", "0 180\n0\n50 50", "0.5 3 60", "4", version)), 30, 0);
    };
    EXPECT_EQ(value("IESNA:LM-63-2002"), 50 * 4 * 0.5);
    EXPECT_EQ(value("IES:LM-63-2019"), 50 * 4 * 0.5);
    EXPECT_EQ(value("IESNA:LM-63-1995"), 50 * 4 * 0.5 * 3);
    EXPECT_EQ(value("IESNA91"), 50 * 4 * 0.5 * 3);
    EXPECT_EQ(value("a lamp of 1986"), 50 * 4 * 0.5 * 3);
}

TEST(Ies, QuadrantsMirror) {
    const LightProfile profile = parsed(ies("2 3 1", "0 90\n0 30 90\n1 10\n1 20\n1 30"));
    for (const auto& [h, expected] : {std::pair(0., 10.), {30., 20.}, {90., 30.}, {15., 15.}})
        for (const double turned : {h, 180 - h, 180 + h, 360 - h})
            EXPECT_NEAR(at(profile, 90, turned), expected, 1e-4) << turned;
}

TEST(Ies, HalvesMirrorAboutThePlaneOfTheirEnds) {
    const LightProfile about_0 = parsed(ies("2 3 1", "0 90\n0 60 180\n1 10\n1 20\n1 30"));
    for (const double h : {60., -60.}) EXPECT_NEAR(at(about_0, 90, h), 20, 1e-4);
    EXPECT_NEAR(at(about_0, 90, 120), 25, 1e-4);
    EXPECT_NEAR(at(about_0, 90, 240), 25, 1e-4);
    // LM-63-1995 allows 90 to 270. The mirrored angles are -30 and 30 here, without a knot at 0.
    const LightProfile about_90 = parsed(ies(
        "2 4 1", "0 90\n90 150 210 270\n1 10\n1 20\n1 40\n1 30", "1 1 1", "1", "IESNA:LM-63-1995"));
    for (const double h : {150., 30.}) EXPECT_NEAR(at(about_90, 90, h), 20, 1e-4) << h;
    for (const double h : {210., -30.}) EXPECT_NEAR(at(about_90, 90, h), 40, 1e-4) << h;
    for (const double h : {0., 180.}) EXPECT_NEAR(at(about_90, 90, h), 30, 1e-4) << h;
    EXPECT_NEAR(at(about_90, 90, 359.999), at(about_90, 90, 0), 0.01);
}

// Counter-clockwise from x to y, as seen from behind the lamp; a last angle below 360 is joined to
// the first.
TEST(Ies, AWholeTurnHasNoSymmetry) {
    const LightProfile profile = parsed(ies("2 4 1", "0 90\n0 90 180 270\n1 10\n1 20\n1 30\n1 40"));
    const auto along = [&](V3f d) { return profile.intensity(d); };
    EXPECT_NEAR(along(V3f(1, 0, 0)), 10, 1e-4);
    EXPECT_NEAR(along(V3f(0, 1, 0)), 20, 1e-4);
    EXPECT_NEAR(along(V3f(-1, 0, 0)), 30, 1e-4);
    EXPECT_NEAR(along(V3f(0, -1, 0)), 40, 1e-4);
    EXPECT_NEAR(along(V3f(0, 0, 1)), 1, 1e-4);
    EXPECT_NEAR(at(profile, 90, 315), 25, 1e-4);
    const LightProfile closed =
        parsed(ies("2 5 1", "0 90\n0 90 180 270 360\n1 10\n1 20\n1 30\n1 40\n1 10"));
    EXPECT_NEAR(closed.flux_lm(), profile.flux_lm(), 1e-4);
}

// Type B: planes about the axis x, in which vertical angles run towards it; horizontal angles turn
// clockwise, from f towards -y.
TEST(Ies, TypeBTurnsAboutTheAxisAcross) {
    const LightProfile profile = parsed(ies("3 3 2", "-90 0 90\n-90 0 90\n1 10 2\n1 20 2\n1 30 2"));
    const auto along = [&](V3f d) { return profile.intensity(unit(d)); };
    EXPECT_NEAR(along(V3f(0, 0, 1)), 20, 1e-4);
    EXPECT_NEAR(along(V3f(0, 1, 1e-6f)), 10, 1e-3);
    EXPECT_NEAR(along(V3f(0, -1, 1e-6f)), 30, 1e-3);
    EXPECT_NEAR(along(V3f(-1, 0, 1e-6f)), 1, 1e-3);
    EXPECT_NEAR(along(V3f(1, 0, 1e-6f)), 2, 1e-3);
    EXPECT_NEAR(along(V3f(1, 0, 1)), 11, 1e-4);
    EXPECT_EQ(along(V3f(0.3f, 0.1f, -1)), 0);
    // A quarter of the data, mirrored both ways.
    const LightProfile quarter = parsed(ies("2 2 2", "0 90\n0 90\n8 4\n2 6"));
    for (const float x : {-1.f, 1.f})
        for (const float y : {-1.f, 1.f})
            EXPECT_NEAR(quarter.intensity(unit(V3f(x, y, 1))),
                        quarter.intensity(unit(V3f(1, 1, 1))), 1e-5);
    // cos V over half a sphere: the integral of cos^2 V dV dH is pi^2 / 2.
    std::string angles, values;
    for (int v = -90; v <= 90; ++v) {
        angles += std::to_string(v) + " ";
        values += std::to_string(100 * std::cos(v * kRadians)) + " ";
    }
    const LightProfile cosine =
        parsed(ies("181 2 2", angles + "\n-90 90\n" + values + "\n" + values));
    EXPECT_NEAR(cosine.flux_lm(), 50 * std::numbers::pi * std::numbers::pi, 0.05);
}

TEST(Ies, TiltIsNotAppliedAndSaid) {
    const std::string body = "0 180\n0\n50 50";
    const auto with = [&](const std::string& tilt) {
        return parse_ies(ies("2 1 1", body, "1 1 1", "1", "IESNA91", tilt), "a.ies", "");
    };
    EXPECT_TRUE(with("TILT=NONE").remarks.empty());
    for (const char* tilt : {"TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8", "TILT=other.tlt"}) {
        const IesFile found = with(tilt);
        EXPECT_EQ(at(found.profile, 30, 0), 50) << tilt;
        ASSERT_EQ(found.remarks.size(), 1u);
        EXPECT_THAT(found.remarks[0], testing::HasSubstr("tilt"));
    }
}

TEST(Ies, WhatIsWrongIsNamedWithItsLine) {
    expect_refused("no profile at all", "no line TILT=");
    expect_refused("", "no line TILT=");
    expect_refused("IESNA91\nTILT=NONE", "line 2: ends before the number of lamps");
    expect_refused(ies("2 1 3", "0 180\n0\n5 5"), "type A");
    expect_refused(ies("2 1 1.5", "0 180\n0\n5 5"), "line 5: the photometric type");
    expect_refused(ies("2.5 1 1", "0 180\n0\n5 5"), "whole number");
    expect_refused(ies("1 1 1", "0\n0\n5"), "the number of vertical angles is 1");
    expect_refused(ies("1e9 1 1", "0 180\n0\n5 5"), "the number of vertical angles");
    expect_refused(ies("900000 900000 1", "0 180\n0\n5 5"), "vertical angles must increase");
    expect_refused(ies("2 900000 1", "0 180\n0 1 2 3"), "ends before horizontal angle");
    expect_refused(ies("3 1 1", "0 90 90\n0\n5 5 5"), "line 7: vertical angles must increase");
    expect_refused(ies("3 1 1", "0 90 90.0000001\n0\n5 5 5"), "vertical angles must increase");
    expect_refused(ies("2 1 1", "0 181\n0\n5 5"), "vertical angle is 181");
    expect_refused(ies("2 2 1", "0 180\n0 45\n5 5 5 5"), "cannot run from 0 to 45");
    expect_refused(ies("2 2 1", "0 180\n-10 355\n5 5 5 5"), "overlap");
    expect_refused(ies("2 1 1", "0 180\n0\n5 -5"), "line 9: an intensity is -5");
    expect_refused(ies("2 1 1", "0 180\n0\n5 five"), "\"five\" is no number");
    expect_refused(ies("2 1 1", "0 180\n0\n5"), "line 9: ends before an intensity");
    expect_refused(ies("2 1 1", "0 180\n0\n5 1e15", "1 1 1", "1e15"), "too great");
    expect_refused(ies("2 1 2", "0 90\n0\n5 5"), "two horizontal angles");
}

}  // namespace
}  // namespace petzval::io
