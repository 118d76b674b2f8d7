// SPDX-License-Identifier: Apache-2.0
// Lenses in the formats of other programs: pbrt's description and Zemax's sequential lens.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "camera/lens/lens.h"
#include "tests/support/lens_text.h"

namespace petzval::io {
namespace {

using test::kDat;
using test::kZmx;
using test::LensText;
using test::with;

void expect_same_surfaces(const camera::Prescription& lens, const camera::Prescription& expected) {
    ASSERT_EQ(lens.surfaces.size(), expected.surfaces.size());
    for (size_t i = 0; i < lens.surfaces.size(); ++i) {
        const camera::LensSurface &a = lens.surfaces[i], &b = expected.surfaces[i];
        EXPECT_NEAR(a.curvature_1_mm, b.curvature_1_mm, 1e-14) << i;
        EXPECT_NEAR(a.thickness_mm, b.thickness_mm, 1e-12) << i;
        EXPECT_NEAR(a.semi_diameter_mm, b.semi_diameter_mm, 1e-12) << i;
        EXPECT_EQ(a.conic, b.conic) << i;
        EXPECT_EQ(a.stop, b.stop) << i;
        EXPECT_EQ(a.glass, b.glass) << i;
        ASSERT_EQ(a.asphere.size(), b.asphere.size()) << i;
        for (size_t k = 0; k < a.asphere.size(); ++k) {
            EXPECT_EQ(a.asphere[k][0], b.asphere[k][0]) << i;
            EXPECT_NEAR(a.asphere[k][1] / b.asphere[k][1], 1, 1e-12) << i;
        }
    }
}

TEST_F(LensText, PbrtsDescriptionIsReadBack) {
    camera::Prescription expected = load_lens("double-gauss-100mm-f2").lens;
    std::string text = "# a lens\r\n\n";
    for (camera::LensSurface& s : expected.surfaces) {
        const double n = s.glass ? s.glass->index(kLineD_nm) : 0;
        if (s.glass) s.glass = Glass{fmt::format("{}", n), IndexSeries{{{n, 0}}}};
        text += fmt::format("{}\t{} {} {} # surface\r\n",
                            s.curvature_1_mm == 0 ? 0 : 1 / s.curvature_1_mm, s.thickness_mm, n,
                            2 * s.semi_diameter_mm);
    }
    const LensFile file = read("gauss.dat", text);
    expect_same_surfaces(file.lens, expected);
    EXPECT_EQ(file.lens.name, "gauss");
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_TRUE(has(file.warnings[0], "no dispersion"));
}

// In inches, with an object and an image.
std::string zmx_of(const camera::Prescription& lens) {
    std::string text =
        "VERS 140124 258 36214\nMODE SEQ\nNAME A lens of  mine\nUNIT IN X W X CM MR CPMM\n"
        "FNUM 2.8 0\nGCAT OHARA SCHOTT\nFTYP 0 0 3 3 0 0 0\nXFLN 0 0 0\nYFLN 0 -40 57\n"
        "SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 "
        "\"\"\n";
    int number = 1;
    for (const camera::LensSurface& s : lens.surfaces) {
        text +=
            fmt::format("SURF {}\n  TYPE {}\n  CURV {} 0 0 0 0 \"\"\n  DISZ {}\n  DIAM {} 1 0 0\n",
                        number++, s.asphere.empty() ? "STANDARD" : "EVENASPH",
                        s.curvature_1_mm * 25.4, s.thickness_mm / 25.4, s.semi_diameter_mm / 25.4);
        if (s.stop) text += "  STOP\n";
        if (s.conic != 0) text += fmt::format("  CONI {}\n", s.conic);
        for (const auto& [power, a] : s.asphere)
            text += fmt::format("  PARM {} {}\n", power / 2, a * std::pow(25.4, power - 1));
        if (!s.glass) continue;
        const size_t colon = s.glass->name.find(':'), slash = s.glass->name.find('/');
        if (colon != std::string::npos)
            text += fmt::format("  GLAS {} 0 0 1.5 40 0 0 0\n", s.glass->name.substr(colon + 1));
        else
            text += fmt::format("  GLAS ___BLANK 1 0 {} {} 0 0 0\n", s.glass->name.substr(0, slash),
                                s.glass->name.substr(slash + 1));
    }
    return text + fmt::format(
                      "SURF {}\n  CURV 0\n  DISZ 0\n  DIAM 0.85 0 0 0\nTOL TOFF 0 0\n"
                      "MNUM 1 1\n",
                      number);
}

TEST_F(LensText, ZemaxsLensIsReadBack) {
    for (const char* name : {"canon-14mm-f2.8-asph", "double-gauss-100mm-f2"}) {
        const camera::Prescription expected = load_lens(name).lens;
        const std::string text = zmx_of(expected);
        std::string utf16 = "\xFF\xFE";
        for (const char c : text) (utf16 += c) += '\0';
        for (const std::string& bytes : {text, utf16}) {
            const LensFile file = read("a.ZMX", bytes);
            expect_same_surfaces(file.lens, expected);
            EXPECT_TRUE(file.warnings.empty());
            EXPECT_EQ(file.lens.title, "A lens of mine");
            EXPECT_EQ(*file.lens.stated_fnumber, 2.8);
            EXPECT_EQ(*file.lens.stated_field_half_deg, 57);
            EXPECT_NEAR(file.lens.image_circle_mm, 2 * 0.85 * 25.4, 1e-12);
        }
    }
}

TEST_F(LensText, ZemaxsStopBecomesAPlaneOfItsOwn) {
    const LensFile file = read("a.zmx", kZmx);
    const auto& surfaces = file.lens.surfaces;
    ASSERT_EQ(surfaces.size(), 3u) << "the plane in air is no surface";
    EXPECT_TRUE(surfaces[0].stop);
    EXPECT_EQ(surfaces[0].thickness_mm, 0);
    EXPECT_EQ(surfaces[0].semi_diameter_mm, 10);
    EXPECT_FALSE(surfaces[1].stop);
    EXPECT_EQ(surfaces[1].glass->name, "schott:N-BK7");
    EXPECT_EQ(surfaces[2].thickness_mm, 43);
    EXPECT_EQ(surfaces[2].asphere, (std::vector<std::array<double, 2>>{{4, 1e-6}}));
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_TRUE(has(file.warnings[0], "a.zmx: line 6: the stop is a curved surface"));

    const std::string behind = with(with(kZmx, "  STOP\n", ""), "  TYPE EV", "  STOP\n  TYPE EV");
    const auto moved = read("a.zmx", behind).lens.surfaces;
    ASSERT_EQ(moved.size(), 3u);
    EXPECT_TRUE(moved[2].stop);
    EXPECT_EQ(moved[1].thickness_mm, 0);
    EXPECT_EQ(moved[2].thickness_mm, 43);
    EXPECT_FALSE(moved[2].glass);
    EXPECT_NO_THROW(camera::Lens(read("a.zmx", behind).lens));
}

TEST_F(LensText, ZemaxsGlassesComeFromWhereTheyCan) {
    const auto glass_of = [&](const std::string& line) {
        return read("a.zmx", with(kZmx, "GLAS N-BK7 0 0 1.5 40", line));
    };
    EXPECT_EQ(glass_of("GLAS n-sf11").lens.surfaces[1].glass->name, "schott:N-SF11");
    const LensFile ohara = glass_of("GLAS S-BSL7 0 0 1.5 40");
    EXPECT_EQ(ohara.lens.surfaces[1].glass->name, "ohara:S-BSL7");
    EXPECT_TRUE(has(ohara.warnings[0], "takes ohara:S-BSL7: the file's catalogues"));
    const LensFile unknown = glass_of("GLAS NOGLASS 0 0 1.6 50");
    EXPECT_EQ(unknown.lens.surfaces[1].glass->name, "1.6/50");
    EXPECT_TRUE(has(unknown.warnings[0], "line 10: takes nd 1.6 and Vd 50: there is no one glass"));
    EXPECT_TRUE(has(glass_of("GLAS ___BLANK 1 0 1.6 50 0.01").warnings[0], "partial dispersion"));
    EXPECT_EQ(glass_of("GLAS ___BLANK 1 0 1.6 0").lens.surfaces[1].glass->index(400.), 1.6);

    const std::string agf = "NM N-BK7 5 0\nCD 1.7 0 0\nNM MINE 5 0\nCD 1.8 0 0\n";
    test::write_text(folder_ / "Schott.agf", agf);
    const std::vector<AgfCatalog> catalogs{AgfCatalog(folder_ / "Schott.agf")};
    test::write_text(folder_ / "a.zmx", kZmx);
    const auto first = load_lens((folder_ / "a.zmx").string(), catalogs).lens.surfaces[1].glass;
    EXPECT_EQ(first->index(500.), 1.7) << "the user's catalogue goes first";
}

TEST_F(LensText, RefusesZemaxsLensesThatItCannotFollow) {
    expect_refused(
        "a.zmx", kZmx,
        {{"MODE SEQ", "MODE NSC", "a.zmx: line 1: is not sequential"},
         {"UNIT MM", "UNIT FURLONG", "line 2: has a UNIT other than"},
         {"GCAT SCHOTT", "MNUM 3 1", "line 3: has several configurations"},
         {"TYPE EVENASPH", "TYPE COORDBRK", "line 13: has a surface of type COORDBRK"},
         {"TYPE EVENASPH", "TYPE TOROIDAL", "line 13: has a surface of type TOROIDAL"},
         {"PARM 2 1e-6", "PARM 9 1", "line 16: has a power of r"},
         {"PARM 2 1e-6", "PARM 2 x", "line 16: has no finite number after PARM"},
         {"PARM 2 1e-6", "OBSC 0 1", "line 16: has OBSC, which"},
         {"PARM 2 1e-6", "OBDC 1 0", "line 16: has an aperture beside the axis"},
         {"PARM 2 1e-6", "CLAP 1 5", "line 16: has an aperture with a hole"},
         {"GLAS N-BK7", "GLAS MIRROR", "line 10: has a mirror"},
         {"GLAS N-BK7", "GLAS N-BK77", "line 10: has the glass N-BK77, which no catalogue has"},
         {"N-BK7 0", "N-BK7 2", "line 10: takes its glass from another surface"},
         {"N-BK7 0 0 1.5 40", "___BLANK 1 0 0.5 40", "line 10: has a glass with nd 0.5"},
         {"N-BK7 0 0 1.5 40", "___BLANK 1 0 4 1", "line 10: has a glass whose Vd is too small"},
         {"  STOP\n", "", "a.zmx: has no stop (STOP)"},
         {"  TYPE EV", "  STOP\n  TYPE EV", "line 12: is a second stop; that at line 6"},
         {"CURV 0.02", "CURV", "line 8: has no finite number after CURV"},
         {"CURV 0.02", "CURV 1e9", "line 6: has a radius that is too small"},
         {"DIAM 10", "DIAM 0", "line 6: has an aperture of 0 mm"},
         {"DISZ 4", "DISZ INFINITY", "line 6: is at an infinite distance"},
         {"DISZ 4", "DISZ 1e6", "line 6: has a distance of more than"},
         {"SURF 4\n  DISZ 0", "SURF 4\n  CURV 0.1", "line 22: has a curved image"},
         {"DISZ INFINITY", "GLAS N-BK7", "line 5: has an object in glass"},
         {kZmx, "SURF 0\nSURF 1\n", "a.zmx: has no lens"}});
    const auto warnings = read("a.zmx", with(kZmx, "COMM a", "ABCD a")).warnings;
    EXPECT_TRUE(has(warnings.at(0), "line 20: ABCD is not known and left out"));
    // What is only stated changes no light.
    const std::string stated = "GCAT SCHOTT\nFNUM x 0\nFTYP\nYFLN 0 a";
    const auto lens = read("a.zmx", with(kZmx, "GCAT SCHOTT", stated));
    ASSERT_EQ(lens.warnings.size(), 4u);  // the last: its stop is a curved surface
    EXPECT_TRUE(has(lens.warnings[0], "line 4: FNUM has no finite number and is left out"));
    EXPECT_FALSE(lens.lens.stated_fnumber);
}

TEST_F(LensText, RefusesPbrtsDescriptionsThatAreWrong) {
    const auto surfaces = read("a.dat", kDat).lens.surfaces;
    ASSERT_EQ(surfaces.size(), 5u);
    EXPECT_TRUE(surfaces[2].stop);
    EXPECT_FALSE(surfaces[1].glass) << "index 1";
    const auto rounded = read("a.dat", with(kDat, "-50 2 1 20", "-50 2 0.9999 20")).lens.surfaces;
    EXPECT_FALSE(rounded[1].glass) << "air, rounded";
    const auto plane = read("a.dat", with(kDat, "\n60 ", "\n0 ")).lens.surfaces;
    EXPECT_FALSE(plane[3].stop) << "a plane of glass";
    expect_refused(
        "a.dat", kDat,
        {{"50 4 1.5 20", "50 4 1.5", "a.dat: line 2: has 3 columns; each surface has 4"},
         {"50 4 1.5 20", "50 4 1.5 20 1", "line 2: has 5 columns"},
         {"50 4 1.5 20", "50 4 1,5 20", "line 2: column 3 is not a finite number"},
         {"50 4 1.5 20", "50 4 inf 20", "line 2: column 3 is not a finite number"},
         {"50 4 1.5 20", "50 4 0.5 20", "line 2: has the index 0.5; it must be 0 for air"},
         {"50 4 1.5 20", "50 4 1.5 -20", "line 2: has an aperture of -20 mm"},
         {"50 4 1.5 20", "50 1e9 1.5 20", "line 2: has a thickness of"},
         {"50 4 1.5 20", "1e-9 4 1.5 20", "line 2: has a radius that is too small"},
         {"60 4 1.6", "0 4 0", "line 5: is a second stop (radius 0 in air); that at line 4"},
         {"\n0 3", "\n70 3", "a.dat: has no stop"},
         {kDat, "", "a.dat: is empty"},
         {kDat, "# none", "a.dat: has no stop"}});
}

// A scene may name any file of the machine as its lens.
TEST_F(LensText, ShowsNothingOfAFileThatIsNoLens) {
    for (const auto& [name, text] :
         std::vector<std::pair<std::string, std::string>>{{"a.json", R"({"hunter2": "hunter2"})"},
                                                          {"a.json", "hunter2"},
                                                          {"a.dat", "hunter2:x:0\n"},
                                                          {"a.dat", "hunter2 1 2 3\n"},
                                                          {"a.zmx", "hunter2 = 1\nhunter2\n"}}) {
        EXPECT_TRUE(has(refused(name, text), name)) << text;
        EXPECT_FALSE(has(refused(name, text), "hunter2")) << refused(name, text);
    }
}

}  // namespace
}  // namespace petzval::io
