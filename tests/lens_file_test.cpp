// SPDX-License-Identifier: Apache-2.0
#include "io/lens_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "camera/paraxial.h"
#include "io/lens_formats.h"
#include "io/text_lines.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_mutation.h"

namespace petzval {
namespace {

// Focal length, back focus and f-number at line d, worked by another program.
struct FirstOrderData {
    const char* name;
    double focal_length_mm, back_focus_mm, fnumber;
};
const FirstOrderData kShipped[] = {
    {"angenieux-50mm-f1.1", 49.96987, 27.98855, 1.1},
    {"biotar-58mm-f1.4", 57.94982, 37.89064, 1.4},
    {"canon-14mm-f2.8-asph", 14.27938, 36.30148, 2.8},
    {"cooke-triplet-50mm-f5", 50.02135, 42.43644, 5.0},
    {"double-gauss-100mm-f2", 100.00372, 61.4875, 2.0},
    {"kodak-petzval-100mm-f2", 99.98376, 56.45265, 2.0},
    {"kreitzer-telephoto-400mm-f5.6", 400.30242, 75.98955, 5.6},
    {"minolta-fisheye-16mm-f2.8", 16.00253, 37.19336, 2.8},
    {"nikkor-400mm-f2.8-fl", 391.99361, 74.20877, 2.89},
    {"nikkor-retrofocus-28mm-f2.8", 27.95265, 36.65801, 2.8},
    {"noct-nikkor-58mm-f0.95", 59.62043, 0.99254, 0.98},
    {"petzval-portrait-100mm-f3.6", 100.22286, 58.88563, 3.6},
    {"phone-f3.5-asph", 5.55507, 0.56784, 3.5},
    {"primoplan-58mm-f1.5", 58.09251, 30.17182, 1.5},
    {"schneider-anamorphic-31mm", 60.55457, 43.35452, 2.2},
    {"takumar-50mm-f1.2", 50.00034, 31.71867, 1.2},
    {"tessar-100mm-f2.8", 99.99622, 79.8087, 2.8},
    {"werfel-double-gauss-100mm-f1.25", 100.14546, 56.45975, 1.25},
};

TEST(ShippedLenses, HaveTheFirstOrderDataOfAnotherProgram) {
    for (const auto& [name, focal_length_mm, back_focus_mm, fnumber] : kShipped) {
        const LensFile file = load_lens(name);
        EXPECT_EQ(file.lens.name, name);
        EXPECT_TRUE(file.warnings.empty()) << name;
        EXPECT_GT(file.lens.image_circle_mm, 0) << name;
        const FirstOrder lens = first_order(Lens(file.lens), kLineD_nm);
        // The other program takes another fluorite than Nikon's.
        const bool fluorite = std::string(name).starts_with("nikkor-400mm");
        EXPECT_NEAR(lens.focal_length_mm / focal_length_mm, 1, fluorite ? 1e-4 : 1e-6) << name;
        EXPECT_NEAR(lens.back_focus_mm, back_focus_mm, fluorite ? 0.03 : 1e-4) << name;
        EXPECT_NEAR(lens.fnumber / fnumber, 1, 1e-5) << name;
        EXPECT_NEAR(file.lens.surfaces.back().thickness_mm, lens.back_focus_mm, 1e-4) << name;
    }
}

TEST(ShippedLenses, AreAsTheirFilesState) {
    for (const FirstOrderData& row : kShipped) {
        const Prescription lens = load_lens(row.name).lens;
        ASSERT_TRUE(lens.stated_focal_length_mm && lens.stated_fnumber &&
                    lens.stated_field_half_deg)
            << row.name;
        const FirstOrder traced = first_order(Lens(lens), kLineD_nm);
        EXPECT_NEAR(traced.focal_length_mm / *lens.stated_focal_length_mm, 1, 0.006) << row.name;
        EXPECT_NEAR(traced.fnumber / *lens.stated_fnumber, 1, 0.006) << row.name;
    }
    const Lens anamorphic(load_lens("schneider-anamorphic-31mm").lens);
    EXPECT_NEAR(first_order(anamorphic, kLineD_nm, Section::X).focal_length_mm, 31, 0.5);
}

TEST(ShippedLenses, AreListedByName) {
    const auto list = list_lenses();
    ASSERT_EQ(list.size(), std::size(kShipped));
    for (size_t i = 0; i < list.size(); ++i) {
        EXPECT_EQ(list[i].name, kShipped[i].name);
        const Prescription lens = load_lens(list[i].name).lens;
        EXPECT_EQ(list[i].title, lens.title);
        EXPECT_TRUE(lens.source.starts_with(list[i].patent)) << lens.source;
        EXPECT_EQ(list[i].focal_length_mm, *lens.stated_focal_length_mm);
        EXPECT_EQ(list[i].fnumber, *lens.stated_fnumber);
        EXPECT_EQ(list[i].field_half_deg, *lens.stated_field_half_deg);
        EXPECT_TRUE(list[i].grade == "A" || list[i].grade == "B") << list[i].name;
    }
}

// The patent: the group behind surface 10 (from 0) moves to the film by 15.27 mm for 2.6 m.
TEST(ShippedLenses, FocusByTheGroupOfThePatent) {
    const Prescription lens = load_lens("nikkor-400mm-f2.8-fl").lens;
    ASSERT_TRUE(lens.focus_group);
    EXPECT_EQ(*lens.focus_group, (std::array{11, 15}));
    EXPECT_EQ(lens.surfaces[10].thickness_mm, 18.503);
    EXPECT_EQ(lens.surfaces[15].thickness_mm, 38.179);
    Prescription close = lens;
    close.surfaces[10].thickness_mm += 15.27;
    close.surfaces[15].thickness_mm -= 15.27;
    const ParaxialImage image = image_of(Lens(close), -2203.01, kLineD_nm);
    EXPECT_NEAR(image.from_last_vertex_mm, lens.surfaces[32].thickness_mm, 0.4);
    EXPECT_NEAR(image.magnification, -0.173, 0.001);
    EXPECT_FALSE(load_lens("takumar-50mm-f1.2").lens.focus_group);
}

TEST(ShippedLenses, AreFoundWhateverTheCase) {
    EXPECT_EQ(load_lens("Takumar-50mm-F1.2").lens.name, "takumar-50mm-f1.2");
    const std::string message = refusal([] { (void)load_lens("takumar-50mm"); });
    EXPECT_TRUE(
        has(message, "takumar-50mm: is neither a file nor a lens; the lenses are angenieux-"));
    EXPECT_THROW((void)load_lens("takumar-50mm"), ArgumentError);
    EXPECT_THROW((void)load_lens("../lenses/takumar-50mm-f1.2"), ArgumentError);
}

class LensText : public testing::Test {
  protected:
    LensFile read(const std::string& name, const std::string& bytes) {
        test::write_bytes(folder_ / name, {bytes.begin(), bytes.end()});
        return load_lens((folder_ / name).string());
    }
    std::string refused(const std::string& name, const std::string& text) {
        return refusal([&] { (void)read(name, text); });
    }
    test::TemporaryFolder folder_;
};

void expect_same_surfaces(const Prescription& lens, const Prescription& expected) {
    ASSERT_EQ(lens.surfaces.size(), expected.surfaces.size());
    for (size_t i = 0; i < lens.surfaces.size(); ++i) {
        const LensSurface &a = lens.surfaces[i], &b = expected.surfaces[i];
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
    Prescription expected = load_lens("double-gauss-100mm-f2").lens;
    std::string text = "# a lens\r\n\n";
    for (LensSurface& s : expected.surfaces) {
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
std::string zmx_of(const Prescription& lens) {
    std::string text =
        "VERS 140124 258 36214\nMODE SEQ\nNAME A lens of  mine\nUNIT IN X W X CM MR CPMM\n"
        "FNUM 2.8 0\nGCAT OHARA SCHOTT\nFTYP 0 0 3 3 0 0 0\nXFLN 0 0 0\nYFLN 0 -40 57\n"
        "SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0 \"\"\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 "
        "\"\"\n";
    int number = 1;
    for (const LensSurface& s : lens.surfaces) {
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
        const Prescription expected = load_lens(name).lens;
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

const char* const kZmx =
    "MODE SEQ\nUNIT MM\nGCAT SCHOTT\nSURF 0\n  DISZ INFINITY\n"
    "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 4\n  GLAS N-BK7 0 0 1.5 40\n  DIAM 10\n"
    "SURF 2\n  TYPE EVENASPH\n  CURV -0.02\n  PARM 1 0\n  PARM 2 1e-6\n  DISZ 3\n  DIAM 10\n"
    "SURF 3\n  COMM a plane in air\n  DISZ 40\n"
    "SURF 4\n  DISZ 0\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
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
    EXPECT_NO_THROW(Lens(read("a.zmx", behind).lens));
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
    test::write_bytes(folder_ / "Schott.agf", {agf.begin(), agf.end()});
    const std::vector<AgfCatalog> catalogs{AgfCatalog(folder_ / "Schott.agf")};
    test::write_bytes(folder_ / "a.zmx", {kZmx, kZmx + std::string(kZmx).size()});
    const auto first = load_lens((folder_ / "a.zmx").string(), catalogs).lens.surfaces[1].glass;
    EXPECT_EQ(first->index(500.), 1.7) << "the user's catalogue goes first";
}

// What stands in the file, what is put there, and the message.
struct Fault {
    const char *from, *to, *message;
};

TEST_F(LensText, RefusesZemaxsLensesThatItCannotFollow) {
    for (const auto& [from, to, message] :
         {Fault{"MODE SEQ", "MODE NSC", "a.zmx: line 1: is not sequential"},
          Fault{"UNIT MM", "UNIT FURLONG", "line 2: has a UNIT other than"},
          Fault{"GCAT SCHOTT", "MNUM 3 1", "line 3: has several configurations"},
          Fault{"TYPE EVENASPH", "TYPE COORDBRK", "line 13: has a surface of type COORDBRK"},
          Fault{"TYPE EVENASPH", "TYPE TOROIDAL", "line 13: has a surface of type TOROIDAL"},
          Fault{"PARM 2 1e-6", "PARM 9 1", "line 16: has a power of r"},
          Fault{"PARM 2 1e-6", "PARM 2 x", "line 16: has no finite number after PARM"},
          Fault{"PARM 2 1e-6", "OBSC 0 1", "line 16: has OBSC, which"},
          Fault{"PARM 2 1e-6", "OBDC 1 0", "line 16: has an aperture beside the axis"},
          Fault{"PARM 2 1e-6", "CLAP 1 5", "line 16: has an aperture with a hole"},
          Fault{"GLAS N-BK7", "GLAS MIRROR", "line 10: has a mirror"},
          Fault{"GLAS N-BK7", "GLAS N-BK77",
                "line 10: has the glass N-BK77, which no catalogue has"},
          Fault{"N-BK7 0", "N-BK7 2", "line 10: takes its glass from another surface"},
          Fault{"N-BK7 0 0 1.5 40", "___BLANK 1 0 0.5 40", "line 10: has a glass with nd 0.5"},
          Fault{"N-BK7 0 0 1.5 40", "___BLANK 1 0 4 1",
                "line 10: has a glass whose Vd is too small"},
          Fault{"  STOP\n", "", "a.zmx: has no stop (STOP)"},
          Fault{"  TYPE EV", "  STOP\n  TYPE EV", "line 12: is a second stop; that at line 6"},
          Fault{"CURV 0.02", "CURV", "line 8: has no finite number after CURV"},
          Fault{"CURV 0.02", "CURV 1e9", "line 6: has a radius that is too small"},
          Fault{"DIAM 10", "DIAM 0", "line 6: has an aperture of 0 mm"},
          Fault{"DISZ 4", "DISZ INFINITY", "line 6: is at an infinite distance"},
          Fault{"DISZ 4", "DISZ 1e6", "line 6: has a distance of more than"},
          Fault{"SURF 4\n  DISZ 0", "SURF 4\n  CURV 0.1", "line 22: has a curved image"},
          Fault{"DISZ INFINITY", "GLAS N-BK7", "line 5: has an object in glass"},
          Fault{kZmx, "SURF 0\nSURF 1\n", "a.zmx: has no lens"}})
        EXPECT_TRUE(has(refused("a.zmx", with(kZmx, from, to)), message)) << to;
    const auto warnings = read("a.zmx", with(kZmx, "COMM a", "ABCD a")).warnings;
    EXPECT_TRUE(has(warnings.at(0), "line 20: ABCD is not known and left out"));
}

const char* const kDat =
    "# radius thickness index diameter\n50 4 1.5 20\n-50 2 1 20\n0 3 0 15\n60 4 1.6 18\n-60 40 0 "
    "18\n";

TEST_F(LensText, RefusesPbrtsDescriptionsThatAreWrong) {
    const auto surfaces = read("a.dat", kDat).lens.surfaces;
    ASSERT_EQ(surfaces.size(), 5u);
    EXPECT_TRUE(surfaces[2].stop);
    EXPECT_FALSE(surfaces[1].glass) << "index 1";
    const auto plane = read("a.dat", with(kDat, "\n60 ", "\n0 ")).lens.surfaces;
    EXPECT_FALSE(plane[3].stop) << "a plane of glass";
    for (const auto& [from, to, message] :
         {Fault{"50 4 1.5 20", "50 4 1.5", "a.dat: line 2: has 3 columns; each surface has 4"},
          Fault{"50 4 1.5 20", "50 4 1.5 20 1", "line 2: has 5 columns"},
          Fault{"50 4 1.5 20", "50 4 1,5 20", "line 2: \"1,5\" is not a finite number"},
          Fault{"50 4 1.5 20", "50 4 inf 20", "line 2: \"inf\" is not a finite number"},
          Fault{"50 4 1.5 20", "50 4 0.5 20", "line 2: has the index 0.5; it must be 0 for air"},
          Fault{"50 4 1.5 20", "50 4 1.5 -20", "line 2: has an aperture of -20 mm"},
          Fault{"50 4 1.5 20", "50 1e9 1.5 20", "line 2: has a thickness of"},
          Fault{"50 4 1.5 20", "1e-9 4 1.5 20", "line 2: has a radius that is too small"},
          Fault{"60 4 1.6", "0 4 0", "line 5: is a second stop (radius 0 in air); that at line 4"},
          Fault{"\n0 3", "\n70 3", "a.dat: has no stop"}, Fault{kDat, "", "a.dat: has no stop"}})
        EXPECT_TRUE(has(refused("a.dat", with(kDat, from, to)), message)) << to;
}

const char* const kJson = R"({"title": "A doublet", "focal_length": 100, "fnumber": 5, "notes": "x",
"field_half_angle_deg": 10, "image_circle": 30, "focus_group": [0, 2], "surfaces": [
{"radius": 50, "thickness": 6, "medium": {"nd": 1.5168, "vd": 64.17}, "semi_diameter": 12},
{"radius": -40, "thickness": 2, "medium": {"n": 1.62}, "semi_diameter": 12, "conic": -0.5},
{"radius": -150, "thickness": 5, "medium": null, "semi_diameter": 12, "asphere": {"4": 1e-7}},
{"radius": null, "thickness": 80, "medium": null, "semi_diameter": 8, "stop": true}]})";

TEST_F(LensText, OurJsonIsRead) {
    const Prescription lens = read("mine.json", kJson).lens;
    EXPECT_EQ(lens.name, "mine");
    EXPECT_EQ(lens.title, "A doublet");
    EXPECT_EQ(*lens.stated_focal_length_mm, 100);
    EXPECT_EQ(*lens.stated_field_half_deg, 10);
    EXPECT_EQ(*lens.focus_group, (std::array{0, 2}));
    ASSERT_EQ(lens.surfaces.size(), 4u);
    EXPECT_EQ(lens.surfaces[0].glass, (Glass{"1.5168/64.17", glass_like(1.5168, 64.17)}));
    EXPECT_EQ(lens.surfaces[1].glass->index(400.), 1.62);
    EXPECT_EQ(lens.surfaces[1].conic, -0.5);
    EXPECT_EQ(lens.surfaces[2].asphere, (std::vector<std::array<double, 2>>{{4, 1e-7}}));
    EXPECT_TRUE(lens.surfaces[3].stop);
    const std::string cylinder = with(kJson, "\"conic\": -0.5", R"("cylinder": "x")");
    EXPECT_EQ(read("a.json", cylinder).lens.surfaces[1].profile, Profile::CylinderX);
    const std::string minimal =
        R"({"surfaces": [{"radius": null, "thickness": 1, "medium": null, "semi_diameter": 1,
            "stop": true}]})";
    EXPECT_EQ(read("a.json", minimal).lens.image_circle_mm, 0);
}

TEST_F(LensText, TheExampleOfTheDocsIsALens) {
    const std::string docs = text_of_file(PETZVAL_ASSETS "/../docs/lenses.md");
    const size_t begin = docs.find("```json\n") + 8;
    const Prescription lens =
        read("a.json", docs.substr(begin, docs.find("```", begin) - begin)).lens;
    EXPECT_EQ(lens.name, "landscape");
    const FirstOrder traced = first_order(Lens(lens), kLineD_nm);
    EXPECT_NEAR(traced.focal_length_mm, *lens.stated_focal_length_mm, 0.1);
    EXPECT_NEAR(traced.back_focus_mm, lens.surfaces.back().thickness_mm, 0.1);
    EXPECT_NEAR(traced.fnumber, *lens.stated_fnumber, 0.2);
}

TEST_F(LensText, RefusesJsonThatIsNoLens) {
    for (const auto& [from, to, message] :
         {Fault{"\"title\"", "\"titel\"", "a.json: /titel: is not a key of a lens here; the keys"},
          Fault{"A doublet", "A\\ndoublet", "/title: must be one line"},
          Fault{"100", "0", "/focal_length: must be from"},
          Fault{"\"fnumber\": 5", "\"fnumber\": \"5\"", "/fnumber: must be a number"},
          Fault{"[0, 2]", "[2, 0]", "/focus_group: must be [first, last]"},
          Fault{"[0, 2]", "[0, 4]", "/focus_group/1: there is no surface 4; the file has 4"},
          Fault{"\"surfaces\"", "\"notes2\"", "/notes2: is not a key"},
          Fault{"\"radius\": 50, ", "", "/surfaces/0: has no \"radius\""},
          Fault{"\"radius\": 50", "\"radius\": 0", "/surfaces/0/radius: must not be 0; a plane"},
          Fault{"\"radius\": 50", "\"radius\": 1e999", "beyond the range"},
          Fault{"\"radius\": 50", "\"radiuss\": 50", "/surfaces/0/radiuss: is not a key"},
          Fault{"\"thickness\": 6", "\"thickness\": 1e6", "/surfaces/0/thickness: must be from"},
          Fault{"\"semi_diameter\": 12", "\"semi_diameter\": 0", "/surfaces/0/semi_diameter: must"},
          Fault{", \"vd\": 64.17", "", "/surfaces/0/medium: must have glass, or nd and vd, or n"},
          Fault{"\"vd\": 64.17", "\"vd\": 64, \"n\": 1", "/surfaces/0/medium: must have glass, or"},
          Fault{"\"vd\": 64.17", "\"vd\": 0", "/surfaces/0/medium/vd: must be from 1"},
          Fault{"1.5168, \"vd\": 64.17", "4, \"vd\": 1", "/surfaces/0/medium/vd: is too small"},
          Fault{"\"n\": 1.62", "\"n\": 0.9", "/surfaces/1/medium/n: must be from 1 to 5"},
          Fault{
              "\"n\": 1.62", "\"glass\": \"schot:NBK7\"",
              "/surfaces/1/medium/glass: there is no glass \"schot:NBK7\"; near are schott:N-BK7"},
          Fault{"\"n\": 1.62", "\"glass\": \"N-BK7\"", "no glass \"N-BK7\"; near are schott:N-BK7"},
          Fault{"{\"4\": 1e-7}", "{\"1\": 1e-7}", "/surfaces/2/asphere/1: is not a power of r"},
          Fault{"{\"4\": 1e-7}", "{\"4.0\": 1}", "/surfaces/2/asphere/4.0: is not a power of r"},
          Fault{"{\"4\": 1e-7}", "{\"4\": null}", "/surfaces/2/asphere/4: must be a number"},
          Fault{"\"conic\": -0.5", "\"cylinder\": \"z\"", "/surfaces/1/cylinder: must be \"x\" or"},
          Fault{"\"stop\": true", "\"stop\": 1", "/surfaces/3/stop: must be true or false"},
          Fault{"\"stop\": true", "\"stop\": false", "a.json: /surfaces: have no stop"},
          Fault{"\"radius\": null", "\"radius\": 9", "/surfaces/3/stop: must be a plane"},
          Fault{"\"conic\": -0.5", "\"stop\": true", "/surfaces/1/stop: must be a plane"},
          Fault{"80, \"medium\": null", "80, \"medium\": {\"n\": 2}",
                "/surfaces/3/medium: must not change at the stop"}})
        EXPECT_TRUE(has(refused("a.json", with(kJson, from, to)), message)) << to;
    const std::string two = with(kJson, "\"radius\": -150", "\"stop\": true, \"radius\": null");
    EXPECT_TRUE(has(refused("a.json", with(with(two, ", \"asphere\": {\"4\": 1e-7}", ""),
                                           "{\"n\": 1.62}", "null")),
                    "/surfaces/3/stop: is the second; /surfaces/2 is the stop already"));
    EXPECT_TRUE(has(refused("a.json", R"({"surfaces": []})"), "/surfaces: must hold 1 to 250"));
    EXPECT_TRUE(has(refused("a.json", "{}"), "has no \"surfaces\""));
    EXPECT_TRUE(has(refused("a.lens", kJson), "is not a lens by its ending"));
}

TEST_F(LensText, RefusesMoreThanALensHolds) {
    std::string dat = "0 1 0 10\n";
    for (int i = 0; i < 64; ++i) dat += fmt::format("50 1 1.{} 10\n", 500 + i);
    EXPECT_TRUE(has(refused("a.dat", dat), "has 65 surfaces and 64 glasses; a lens may have 250"));
    std::string many = "0 1 0 10\n";
    for (int i = 0; i < 250; ++i) many += "50 1 1.5 10\n";
    EXPECT_TRUE(has(refused("a.dat", many), "has 251 surfaces"));
}

TEST_F(LensText, MutationsAreReadOrRefused) {
    LensGlasses none({});
    const std::string zmx = with(kZmx, "N-BK7 0 0 1.5 40", "___BLANK 1 0 1.5168 64.17");
    using Read = std::function<LensFile(const std::string&)>;
    struct Format {
        std::string text;
        Read read;
    };
    for (const auto& [text, read_text] :
         {Format{kJson, [&](auto& t) { return read_lens_json(t, "a.json", "a", none); }},
          Format{kDat, [&](auto& t) { return read_lens_dat(t, "a.dat", "a"); }},
          Format{zmx, [&](auto& t) { return read_lens_zmx(t, "a.zmx", "a", none); }}}) {
        std::mt19937 random(20240204);
        int read_well = 0, refused_at_all = 0;
        for (int i = 0; i < 2000; ++i) {
            try {
                const Lens lens(read_text(test::mutated(text, random)).lens);
                EXPECT_TRUE(std::isfinite(lens.film_mm()));
                ++read_well;
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                ++refused_at_all;
            }
        }
        EXPECT_GT(read_well, 20) << text;
        EXPECT_GT(refused_at_all, 100) << text;
    }
}

}  // namespace
}  // namespace petzval
