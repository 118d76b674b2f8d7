// SPDX-License-Identifier: Apache-2.0
#include "io/lens/lens_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "camera/lens/paraxial.h"
#include "io/file/text_lines.h"
#include "io/lens/coat_file.h"
#include "io/lens/lens_formats.h"
#include "tests/support/lens_text.h"
#include "tests/support/text_mutation.h"

namespace petzval::io {
namespace {

using test::kDat;
using test::kZmx;
using test::LensText;
using test::with;

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
        const camera::FirstOrder lens = camera::first_order(camera::Lens(file.lens), kLineD_nm);
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
        const camera::Prescription lens = load_lens(row.name).lens;
        ASSERT_TRUE(lens.stated_focal_length_mm && lens.stated_fnumber &&
                    lens.stated_field_half_deg)
            << row.name;
        const camera::FirstOrder traced = camera::first_order(camera::Lens(lens), kLineD_nm);
        EXPECT_NEAR(traced.focal_length_mm / *lens.stated_focal_length_mm, 1, 0.006) << row.name;
        EXPECT_NEAR(traced.fnumber / *lens.stated_fnumber, 1, 0.006) << row.name;
    }
    const camera::Lens anamorphic(load_lens("schneider-anamorphic-31mm").lens);
    EXPECT_NEAR(camera::first_order(anamorphic, kLineD_nm, camera::Section::X).focal_length_mm, 31,
                0.5);
}

TEST(ShippedLenses, AreListedByName) {
    const auto list = list_lenses();
    ASSERT_EQ(list.size(), std::size(kShipped));
    for (size_t i = 0; i < list.size(); ++i) {
        EXPECT_EQ(list[i].name, kShipped[i].name);
        const camera::Prescription lens = load_lens(list[i].name).lens;
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
    const camera::Prescription lens = load_lens("nikkor-400mm-f2.8-fl").lens;
    ASSERT_TRUE(lens.focus_group);
    EXPECT_EQ(*lens.focus_group, (std::array{11, 15}));
    EXPECT_EQ(lens.surfaces[10].thickness_mm, 18.503);
    EXPECT_EQ(lens.surfaces[15].thickness_mm, 38.179);
    camera::Prescription close = lens;
    close.surfaces[10].thickness_mm += 15.27;
    close.surfaces[15].thickness_mm -= 15.27;
    const camera::ParaxialImage image = camera::image_of(camera::Lens(close), -2203.01, kLineD_nm);
    EXPECT_NEAR(image.from_last_vertex_mm, lens.surfaces[32].thickness_mm, 0.4);
    EXPECT_NEAR(image.magnification, -0.173, 0.001);
    EXPECT_FALSE(load_lens("takumar-50mm-f1.2").lens.focus_group);
}

TEST(ShippedLenses, AreFoundWhateverTheCase) {
    EXPECT_EQ(load_lens("Takumar-50mm-F1.2").lens.name, "takumar-50mm-f1.2");
    const std::string message = refusal([] { (void)load_lens("takumar-50mm"); });
    EXPECT_TRUE(has(message,
                    "takumar-50mm: is neither a file nor a lens; did you mean takumar-50mm-f1.2?"));
    EXPECT_THROW((void)load_lens("takumar-50mm"), ArgumentError);
    EXPECT_THROW((void)load_lens("../lenses/takumar-50mm-f1.2"), ArgumentError);
}

const char* const kJson = R"({"title": "A doublet", "focal_length": 100, "fnumber": 5, "notes": "x",
"field_half_angle_deg": 10, "image_circle": 30, "focus_group": [0, 2], "surfaces": [
{"radius": 50, "thickness": 6, "medium": {"nd": 1.5168, "vd": 64.17}, "semi_diameter": 12},
{"radius": -40, "thickness": 2, "medium": {"n": 1.62}, "semi_diameter": 12, "conic": -0.5},
{"radius": -150, "thickness": 5, "medium": null, "semi_diameter": 12, "asphere": {"4": 1e-7}},
{"radius": null, "thickness": 80, "medium": null, "semi_diameter": 8, "stop": true}]})";

TEST_F(LensText, OurJsonIsRead) {
    const camera::Prescription lens = read("mine.json", kJson).lens;
    EXPECT_EQ(lens.name, "mine");
    EXPECT_EQ(lens.title, "A doublet");
    EXPECT_EQ(read("a.json", with(kJson, "A doublet", "A\\ndoublet")).lens.title, "A doublet");
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
    EXPECT_EQ(read("a.json", cylinder).lens.surfaces[1].profile, camera::Profile::CylinderX);
    const std::string minimal =
        R"({"surfaces": [{"radius": null, "thickness": 1, "medium": null, "semi_diameter": 1,
            "stop": true}]})";
    EXPECT_EQ(read("a.json", minimal).lens.image_circle_mm, 0);
}

TEST_F(LensText, CoatingsAreReadByNameAndByLayer) {
    EXPECT_EQ(read("a.json", kJson).lens.surfaces[0].coat,
              camera::SurfaceCoat(camera::Coating::Uncoated));
    const auto first = [&](const std::string& coating) {
        return with(kJson, "\"radius\": 50", "\"coating\": " + coating + ", \"radius\": 50");
    };
    const auto coat = [&](const char* coating) {
        return read("a.json", first(coating)).lens.surfaces[0].coat;
    };
    EXPECT_EQ(coat("\"Broadband\""), camera::SurfaceCoat(camera::Coating::Broadband));
    const char* const layers = R"({"layers": [{"thickness_nm": 99.6, "index": 1.38},
        {"thickness_nm": 0, "index": 2.1, "cauchy_um2": 0.01, "extinction": 0.002}]})";
    const camera::SurfaceCoat two = camera::LayerStack{{99.6, 1.38}, {0, 2.1, 0.01, 0.002}};
    EXPECT_EQ(coat(layers), two);
    test::write_text(folder_ / "two.json", layers);
    EXPECT_EQ(read_coat((folder_ / "two.json").string()), two);
    EXPECT_EQ(read_coat("MgF2"), camera::SurfaceCoat(camera::Coating::MgF2));
    EXPECT_TRUE(has(refusal([] { (void)read_coat("brodband"); }), "did you mean broadband?"));
    for (const auto& [bad, message] :
         {std::pair("\"filed\"", "/surfaces/0/coating: must be layers, or one of"),
          {"\"magic\"", "/surfaces/0/coating: must be layers, or one of ideal, uncoated"},
          {"7", "/surfaces/0/coating"},
          {R"({"layers": 3})", "/surfaces/0/coating/layers"},
          {R"({"layer": []})", "/surfaces/0/coating/layer: is not a key of a coating"},
          {R"({"layers": [{"index": 1.4}]})", "/layers/0: has no \"thickness_nm\""},
          {R"({"layers": [{"thickness_nm": -1, "index": 1.4}]})", "/layers/0/thickness_nm: must"},
          {R"({"layers": [{"thickness_nm": 1, "index": 0}]})", "/layers/0/index: must be from"}})
        EXPECT_TRUE(has(refused("a.json", first(bad)), message)) << bad;
    EXPECT_TRUE(has(refused("a.json", with(kJson, "\"stop\"", "\"coating\": \"mgf2\", \"stop\"")),
                    "/surfaces/3/coating: needs another medium on each side"));
}

TEST_F(LensText, TheExampleOfTheDocsIsALens) {
    const std::string docs = text_of_file(PETZVAL_ASSETS "/../docs/guide/lenses.md");
    const size_t begin = docs.find("```json\n") + 8;
    const camera::Prescription lens =
        read("a.json", docs.substr(begin, docs.find("```", begin) - begin)).lens;
    EXPECT_EQ(lens.name, "landscape");
    const camera::FirstOrder traced = camera::first_order(camera::Lens(lens), kLineD_nm);
    EXPECT_NEAR(traced.focal_length_mm, *lens.stated_focal_length_mm, 0.1);
    EXPECT_NEAR(traced.back_focus_mm, lens.surfaces.back().thickness_mm, 0.1);
    EXPECT_NEAR(traced.fnumber, *lens.stated_fnumber, 0.2);
}

// On a surface of glass the stop is the plane through its vertex, on the side in air.
TEST_F(LensText, AStopOnGlassIsAPlaneThroughItsVertex) {
    const std::string none = with(kJson, ", \"stop\": true", "");
    const auto stop_at = [&](const char* radius) {
        return read("a.json", with(none, std::string("\"radius\": ") + radius,
                                   std::string("\"stop\": true, \"radius\": ") + radius));
    };
    for (const auto& [radius, stop, glass] :
         {std::tuple{"50,", 0, 1}, std::tuple{"-150", 3, 2}, std::tuple{"-40", 2, 1}}) {
        const LensFile file = stop_at(radius);
        const auto& surfaces = file.lens.surfaces;
        ASSERT_EQ(surfaces.size(), 5u);
        const camera::LensSurface &plane = surfaces[size_t(stop)],
                                  &curved = surfaces[size_t(glass)];
        EXPECT_TRUE(plane.stop);
        EXPECT_FALSE(curved.stop);
        EXPECT_EQ(plane.curvature_1_mm, 0);
        EXPECT_TRUE(plane.asphere.empty());
        EXPECT_NE(curved.curvature_1_mm, 0);
        EXPECT_EQ(plane.semi_diameter_mm, 12);
        EXPECT_EQ(surfaces[size_t(std::min(stop, glass))].thickness_mm, 0);
        ASSERT_EQ(file.warnings.size(), 1u);
        EXPECT_TRUE(has(file.warnings[0], ": the stop is a curved surface"));
        // The lens is as it was.
        const camera::Lens lens(file.lens), plain(read("a.json", kJson).lens);
        const camera::FirstOrder a = camera::first_order(lens, kLineD_nm),
                                 b = camera::first_order(plain, kLineD_nm);
        EXPECT_NEAR(a.focal_length_mm, b.focal_length_mm, 1e-9);
        EXPECT_EQ(*file.lens.focus_group, (std::array{0, 3}));
    }
    EXPECT_NEAR(camera::first_order(camera::Lens(stop_at("50,").lens), kLineD_nm).entrance_pupil_mm,
                0, 1e-12);
    // What moves to focus stays the same glass.
    const auto group = [&](const char* numbers, const char* radius) {
        const std::string text = with(none, "[0, 2]", numbers);
        return *read("a.json", with(text, std::string("\"radius\": ") + radius,
                                    std::string("\"stop\": true, \"radius\": ") + radius))
                    .lens.focus_group;
    };
    EXPECT_EQ(group("[0, 1]", "-40"), (std::array{0, 2}));
    EXPECT_EQ(group("[1, 2]", "-40"), (std::array{1, 3}));
    EXPECT_EQ(group("[0, 1]", "-150"), (std::array{0, 1}));
    EXPECT_EQ(group("[2, 3]", "-40"), (std::array{3, 4}));
    // A plane where the glass changes is none that anything is told of.
    const LensFile flat =
        read("a.json", with(kJson, "80, \"medium\": null", "80, \"medium\": {\"n\": 2}"));
    EXPECT_TRUE(flat.warnings.empty());
    ASSERT_EQ(flat.lens.surfaces.size(), 5u);
    EXPECT_TRUE(flat.lens.surfaces[3].stop);
}

TEST_F(LensText, GlassesOfOneMakerNeedNoMaker) {
    const LensFile file = read("a.json", with(kJson, "\"n\": 1.62", "\"glass\": \"n-bk7\""));
    EXPECT_EQ(file.lens.surfaces[1].glass->name, "schott:N-BK7");
}

TEST_F(LensText, WithoutAStopItIsWhereTheAxialLightIsLimited) {
    const auto stop_of = [&](const std::string& text) {
        const LensFile file = read("a.json", with(text, ", \"stop\": true", ""));
        EXPECT_TRUE(
            has(file.warnings.at(0), "a.json: /surfaces: none has \"stop\": true; the iris"));
        return camera::Lens(file.lens).stop();
    };
    // The beam narrows towards the focus. At the last surface it is 0.91 as wide as at the first.
    EXPECT_EQ(stop_of(kJson), 3);
    EXPECT_EQ(stop_of(with(kJson, "\"semi_diameter\": 8", "\"semi_diameter\": 10.5")), 3);
    EXPECT_EQ(stop_of(with(kJson, "\"semi_diameter\": 8", "\"semi_diameter\": 11.8")), 0);
    const LensFile single = read("a.json", R"({"surfaces": [
        {"radius": 50, "thickness": 4, "medium": {"n": 1.5}, "semi_diameter": 9},
        {"radius": null, "thickness": 90, "medium": null, "semi_diameter": 6}]})");
    EXPECT_EQ(camera::Lens(single.lens).stop(), 2);
    EXPECT_TRUE(has(single.warnings.at(0), "at number 1, counted from 0"));
    for (const std::string& warning : single.warnings)
        EXPECT_FALSE(has(warning, "curved")) << "that surface is plane";
}

TEST_F(LensText, RefusesJsonThatIsNoLens) {
    expect_refused(
        "a.json", kJson,
        {{"\"title\"", "\"titel\"", "a.json: /titel: is not a key of a lens here; the keys"},
         {"100", "0", "/focal_length: must be from"},
         {"\"fnumber\": 5", "\"fnumber\": \"5\"", "/fnumber: must be a number"},
         {"[0, 2]", "[2, 0]", "/focus_group: must be [first, last]"},
         {"[0, 2]", "[0, 4]", "/focus_group/1: there is no surface 4; the file has 4"},
         {"\"surfaces\"", "\"notes2\"", "a.json: has no \"surfaces\""},
         {"\"radius\": 50, ", "", "/surfaces/0: has no \"radius\""},
         {"\"radius\": 50", "\"radius\": 0", "/surfaces/0/radius: must not be 0; a plane"},
         {"\"radius\": 50", "\"radius\": 1e999", "beyond the range"},
         {"\"radius\": 50", "\"radiuss\": 50", "/surfaces/0/radiuss: is not a key"},
         {"\"thickness\": 6", "\"thickness\": 1e6", "/surfaces/0/thickness: must be from"},
         {"\"semi_diameter\": 12", "\"semi_diameter\": 0", "/surfaces/0/semi_diameter: must"},
         {", \"vd\": 64.17", "", "/surfaces/0/medium: must have glass, or nd and vd, or n"},
         {"\"vd\": 64.17", "\"vd\": 64, \"n\": 1", "/surfaces/0/medium: must have glass, or"},
         {"\"vd\": 64.17", "\"vd\": 0", "/surfaces/0/medium/vd: must be from 1"},
         {"1.5168, \"vd\": 64.17", "4, \"vd\": 1", "/surfaces/0/medium/vd: is too small"},
         {"\"n\": 1.62", "\"n\": 0.9", "/surfaces/1/medium/n: must be from 1 to 5"},
         {"\"n\": 1.62", "\"glass\": \"schot:NBK7\"",
          "/surfaces/1/medium/glass: there is no glass \"schot:NBK7\"; near are schott:N-BK7"},
         {"\"n\": 1.62", "\"glass\": \"F2\"",
          "/surfaces/1/medium/glass: the glass \"F2\" has several makers: say which of cdgm:F2"},
         {"{\"4\": 1e-7}", "{\"1\": 1e-7}", "/surfaces/2/asphere/1: is not a power of r"},
         {"{\"4\": 1e-7}", "{\"4.0\": 1}", "/surfaces/2/asphere/4.0: is not a power of r"},
         {"{\"4\": 1e-7}", "{\"4\": null}", "/surfaces/2/asphere/4: must be a number"},
         {"\"conic\": -0.5", "\"cylinder\": \"z\"", "/surfaces/1/cylinder: must be \"x\" or"},
         {"\"stop\": true", "\"stop\": 1", "/surfaces/3/stop: must be true or false"},
         {"\"conic\": -0.5", "\"stop\": true",
          "/surfaces/3/stop: is the second; /surfaces/1 is the stop already"}});
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
                const camera::Lens lens(read_text(test::mutated(text, random)).lens);
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
}  // namespace petzval::io
