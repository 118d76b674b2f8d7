// SPDX-License-Identifier: Apache-2.0
#include "io/spectra/spectra.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/colour.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::TemporaryFolder;

std::string file_of(const TemporaryFolder& folder, const std::string& text) {
    const auto path = folder / "mine.csv";
    test::write_text(path, text);
    return path.string();
}

std::array<double, 2> chromaticity(const V3d& xyz) {
    const double sum = xyz.x + xyz.y + xyz.z;
    return {xyz.x / sum, xyz.y / sum};
}

void expect_near(Rgb a, std::array<float, 3> b, float tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[size_t(i)], tolerance) << "channel " << i;
}

// ISO/CIE 11664-1:2019, table 1; the sums are those of CIE 015 for an equal-energy white.
TEST(StandardObserver, IsTheCies) {
    const auto xyz = standard_observer();
    EXPECT_EQ(xyz[1].at_nm(555), 1);
    EXPECT_FLOAT_EQ(xyz[0].at_nm(600), 1.0622f);
    EXPECT_FLOAT_EQ(xyz[1].at_nm(500), 0.3230f);
    EXPECT_FLOAT_EQ(xyz[2].at_nm(445), 1.7826f);
    const double sums[] = {106.8655, 106.8569, 106.8923};
    for (size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (const float value : xyz[i].value) sum += value;
        EXPECT_NEAR(sum, sums[i], 1e-4);
    }
}

// CIE 015: x and y of D65 0.31272, 0.32903; A 0.44758, 0.40745; FL11 0.3805, 0.3769, which the CIE
// sums at 5 nm: lines joined by straight lines at 1 nm give 0.3805, 0.3771.
TEST(Illuminants, HaveThePublishedChromaticities) {
    struct Case {
        const char* name;
        double x, y, tolerance;
    };
    const auto xyz = standard_observer();
    for (const auto& [name, x, y, tolerance] :
         {Case{"d65", 0.31272, 0.32903, 1e-4}, Case{"a", 0.44758, 0.40745, 1e-4},
          Case{"f11", 0.3805, 0.3769, 3e-4}}) {
        const auto found = chromaticity(respond(xyz, find_illuminant(name)));
        EXPECT_NEAR(found[0], x, tolerance) << name;
        EXPECT_NEAR(found[1], y, tolerance) << name;
    }
}

TEST(Illuminants, AreRelativeAndEndWhereTheyWereMeasured) {
    const SpectrumTable d65 = find_illuminant("D65"), f11 = find_illuminant("f11");
    EXPECT_NEAR(d65.at_nm(560) / d65.at_nm(460), 100 / 117.812, 1e-6);
    EXPECT_NEAR(d65.at_nm(562) / d65.at_nm(560), 0.992668, 1e-6);
    EXPECT_EQ(*std::max_element(d65.value.begin(), d65.value.end()), 1);
    EXPECT_GT(f11.at_nm(780), 0);
    EXPECT_EQ(f11.at_nm(781), 0);
    EXPECT_EQ(f11.at_nm(379), 0);
    EXPECT_GT(f11.at_nm(380), 0);
}

TEST(LightSpectrum, OneNitIsOneNit) {
    const auto xyz = standard_observer();
    for (const char* name : {"d65", "A", "F11"}) {
        const auto light = find_light_spectrum(name);
        ASSERT_TRUE(light) << name;
        EXPECT_NEAR(683.002 * integral_of_product(xyz[1], light->per_nit), 1, 1e-6) << name;
        EXPECT_NEAR(0.212639 * light->rgb[0] + 0.715169 * light->rgb[1] + 0.072192 * light->rgb[2],
                    1, 1e-4)
            << name;
    }
    EXPECT_FALSE(find_light_spectrum("e"));
    EXPECT_FALSE(find_light_spectrum(""));
    EXPECT_FALSE(find_light_spectrum("cie1931"));
}

// A: (0.44758, 0.40745) at Y = 1 through the inverse of IEC 61966-2-1's matrix.
TEST(LightSpectrum, HasItsColourRelativeToD65) {
    expect_near(find_light_spectrum("d65")->rgb, {1, 1, 1}, 1e-6f);
    expect_near(find_light_spectrum("a")->rgb, {1.8452f, 0.8260f, 0.2333f}, 2e-3f);
    EXPECT_EQ(find_light_spectrum("A")->name, "a");
}

TEST(TrainingReflectances, AreTheChartsPatches) {
    const auto patches = training_reflectances();
    ASSERT_EQ(patches.size(), 24u);
    for (const SpectrumTable& patch : patches)
        for (const float value : patch.value) {
            EXPECT_GT(value, 0);
            EXPECT_LT(value, 1);
        }
    EXPECT_FLOAT_EQ(patches[0].at_nm(380), 0.055f);
    EXPECT_FLOAT_EQ(patches[0].at_nm(370), 0.055f) << "held";
    EXPECT_FLOAT_EQ(patches[18].at_nm(400), 0.423f);
    EXPECT_FLOAT_EQ(patches[23].at_nm(385), 0.0315f);
}

TEST(Reflectances, AreTheChartsPatchesByName) {
    const std::vector<std::string> names = reflectance_names();
    ASSERT_EQ(names.size(), 24u);
    EXPECT_EQ(names[0], "colorchecker:dark_skin");
    EXPECT_EQ(names[20], "colorchecker:neutral_6.5");
    const auto patches = training_reflectances();
    for (size_t i = 0; i < names.size(); ++i) {
        const auto found = find_reflectance(names[i]);
        ASSERT_TRUE(found) << names[i];
        EXPECT_EQ(found->name, names[i]);
        EXPECT_EQ(found->share.value, patches[i].value) << names[i];
    }
    EXPECT_EQ(find_reflectance("ColorChecker:Cyan")->name, "colorchecker:cyan");
    for (const char* none : {"", "cyan", "colorchecker:", "wavelength_nm", "d65"})
        EXPECT_FALSE(find_reflectance(none)) << none;
}

// 8-bit sRGB that X-Rite prints for the chart, up to the differences between charts; cyan's red
// lies outside the gamut.
TEST(Reflectances, HaveTheirColoursUnderD65WithinTheGamut) {
    for (const auto& [name, r, g, b] :
         {std::tuple{"colorchecker:red", 175, 54, 60}, std::tuple{"colorchecker:blue", 56, 61, 150},
          std::tuple{"colorchecker:yellow", 231, 199, 31},
          std::tuple{"colorchecker:neutral_5", 122, 122, 121}}) {
        const Rgb rgb = find_reflectance(name)->rgb;
        const int srgb8[] = {r, g, b};
        for (int i = 0; i < 3; ++i) {
            EXPECT_GT(rgb[i], srgb_to_linear(float(srgb8[i] - 16) / 255)) << name << ' ' << i;
            EXPECT_LT(rgb[i], srgb_to_linear(float(srgb8[i] + 16) / 255)) << name << ' ' << i;
        }
    }
    EXPECT_EQ(find_reflectance("colorchecker:cyan")->rgb[0], 0);
}

TEST(Reflectances, OfAFileAreSharesOfLight) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& text) {
        return read_reflectance(folder / "mine.csv", {text.begin(), text.end()}, "mine");
    };
    const MeasuredReflectance mine = read("nm,r\n700,1\n400,0\n");
    EXPECT_EQ(mine.name, "mine");
    EXPECT_FLOAT_EQ(mine.share.at_nm(550), 0.5f);
    EXPECT_EQ(mine.share.at_nm(370), 0) << "held";
    EXPECT_EQ(mine.share.at_nm(800), 1) << "held";
    EXPECT_EQ(read("nm,r\n500,0.9\n600,-0.001\n").share.at_nm(650), 0) << "noise";
    expect_near(read("nm,r\n500,0.25\n").rgb, {0.25f, 0.25f, 0.25f}, 1e-6f);
    struct Wrong {
        const char *text, *expected;
    };
    for (const Wrong& wrong :
         {Wrong{"nm,r\n500,0.5\n# and\n600,1.01\n", "line 4: 1.01 in column r must not be above 1"},
          Wrong{"nm,r\n500,0.5\n600,-0.1\n", "line 3: -0.1 in column r must not be below 0"},
          Wrong{"um,r\n0.5,0.5\n0.6,0.6\n", "line 2: wavelengths 0.5 to 0.6 do not reach 360 to"},
          Wrong{"nm,r,g\n500,0.5,1\n", "number of columns is 3 and must be 2"},
          Wrong{"nm,r\n500,x\n", "line 2: column 2 is not a finite number"},
          Wrong{"", "line 1: ends without a row"}})
        EXPECT_TRUE(has(refusal([&] { (void)read(wrong.text); }),
                        (folder / "mine.csv").string() + ": " + wrong.expected));
}

// ((n-1)^2 + k^2) / ((n+1)^2 + k^2), worked by hand from n and k of each row.
TEST(Metals, ReflectAsTheirIndexSays) {
    struct Row {
        const char* name;
        float nm, n, k, reflectance;
    };
    for (const auto& [name, nm, n, k, reflectance] :
         {Row{"ag", 459.201f, 0.144f, 2.56f, 0.926739f},
          Row{"al", 576.671f, 1.08f, 7.0f, 0.918989f},
          Row{"au", 450.852f, 1.502125f, 1.875875f, 0.385605f},
          Row{"cu", 688.801f, 0.213f, 4.05f, 0.952333f}}) {
        const auto metal = find_metal(name);
        ASSERT_TRUE(metal) << name;
        // The table has whole nanometres: a row in between is met within its neighbours' bend.
        EXPECT_NEAR(metal->n.at(nm), n, 4e-3) << name;
        EXPECT_NEAR(metal->k.at(nm), k, 4e-3) << name;
        const float a = metal->n.at(nm), b = metal->k.at(nm) * metal->k.at(nm);
        EXPECT_NEAR(((a - 1) * (a - 1) + b) / ((a + 1) * (a + 1) + b), reflectance, 1e-3) << name;
    }
    EXPECT_FALSE(find_metal("fe"));
    EXPECT_FALSE(find_metal("d65"));
    EXPECT_EQ(find_metal("AU")->name, "au");
}

// Linear sRGB of measured metals as tables for artists print it (S. Lagarde 2011, "Feeding a
// physically based shading model"): silver 0.972 0.960 0.915, aluminium 0.913 0.922 0.924, gold
// 1.022 0.782 0.344 before it is clipped, copper 0.955 0.638 0.538.
TEST(Metals, HaveTheColoursOfTheTables) {
    expect_near(colour_of(*find_metal("ag")), {0.972f, 0.960f, 0.915f}, 3e-3f);
    expect_near(colour_of(*find_metal("al")), {0.913f, 0.922f, 0.924f}, 3e-3f);
    expect_near(colour_of(*find_metal("au")), {1.022f, 0.782f, 0.344f}, 3e-3f);
    expect_near(colour_of(*find_metal("cu")), {0.955f, 0.638f, 0.538f}, 3e-3f);
}

TEST(Metals, AColourlessMirrorIsGrey) {
    Metal mirror{"mirror", {}, {}};
    mirror.n.value.fill(1.5f);
    expect_near(colour_of(mirror), {0.04f, 0.04f, 0.04f}, 1e-6f);
}

TEST(UserSpectra, AreReadFromAnyFile) {
    const TemporaryFolder folder;
    const SpectrumTable led =
        find_illuminant(file_of(folder, "# my lamp\nWavelength (nm),W\n350,0\n450,4\n650,2\n"));
    EXPECT_FLOAT_EQ(led.at_nm(400), 0.5f);
    EXPECT_FLOAT_EQ(led.at_nm(450), 1);
    EXPECT_FLOAT_EQ(led.at_nm(550), 0.75f);
    EXPECT_EQ(led.at_nm(651), 0);

    const auto rgb = find_response(file_of(folder, "nm,r,g,b\n400,0,0,2\n500,0,8,0\n600,4,0,0\n"));
    EXPECT_FLOAT_EQ(rgb[2].at_nm(400), 0.25f) << "one factor for all three";
    EXPECT_FLOAT_EQ(rgb[1].at_nm(500), 1);
    EXPECT_FLOAT_EQ(rgb[0].at_nm(550), 0.25f);
    EXPECT_EQ(rgb[0].at_nm(601), 0);
}

TEST(UserSpectra, MayHaveAnyUnit) {
    const TemporaryFolder folder;
    for (const char* value : {"3e300", "3e-300", "3"}) {
        const std::string row = std::string(",") + value + "\n";
        const SpectrumTable flat =
            find_illuminant(file_of(folder, "nm,v\n300" + row + "900" + row));
        for (const float v : flat.value) EXPECT_FLOAT_EQ(v, 1) << value;
    }
}

TEST(UserSpectra, AResponseThatShipsIsScaledLikeTheOthers) {
    EXPECT_EQ(find_response("CIE1931")[1].value, find_response("cie1931")[1].value);
    const float greatest = standard_observer()[2].at_nm(446);
    EXPECT_FLOAT_EQ(find_response("cie1931")[1].at_nm(555), 1 / greatest);
    EXPECT_FLOAT_EQ(find_response("cie1931")[2].at_nm(446), 1);
}

TEST(UserSpectra, RowsMayStandInAnyOrder) {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::string& text) {
        test::write_text(folder / "a.csv", text);
        return find_illuminant((folder / "a.csv").string()).value;
    };
    const auto sorted = read("nm,v\n400,1\n500,2\n600,4\n");
    EXPECT_EQ(read("nm,v\n600,4\n500,2\n400,1\n"), sorted);
    EXPECT_EQ(read("nm,v\n500,2\n600,4\n400,1\n"), sorted);
}

TEST(UserSpectra, NoiseBelowZeroIsZero) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "a.csv", "nm,v\n400,-0.001\n500,1\n600,-0.002\n");
    const auto values = find_illuminant((folder / "a.csv").string()).value;
    EXPECT_EQ(*std::min_element(values.begin(), values.end()), 0.f);
}

TEST(UserSpectra, ErrorsNameFileAndLine) {
    struct Case {
        bool response;
        std::string text, place, message;
    };
    const Case cases[] = {
        {false, "nm,v\n400,1\n,1\n", "line 3", "column 1 is not a finite number"},
        {false, "nm,v\n400,1\n500,1\n400,1\n", "line 4", "400 nm must be above 400 nm"},
        {false, "nm,v\n400,1\n400,1\n", "line 3", "400 nm must be above 400 nm"},
        {false, "nm,v\n0,1\n400,1\n", "line 2", "0 nm must be above 0 nm"},
        {false, "nm,v\n-5,1\n", "line 2", "-5 nm must be above 0 nm"},
        {false, "# c\nnm,v\n400,1\n500,-0.5\n", "line 4", "-0.5 in column v must not be below 0"},
        {false, "nm,a,b\n400,1,1\n", "", "number of columns is 3 and must be 2: wavelength in nm"},
        {false, "v\n400\n", "", "number of columns is 1 and must be 2"},
        {true, "nm,v\n400,1\n", "", "number of columns is 2 and must be 4"},
        {false, "um,v\n0.4,1\n0.7,1\n", "line 2", "0.4 to 0.7 do not reach 360 to 830 nm"},
        {false, "nm,v\n840,1\n900,1\n", "line 2", "840 to 900 do not reach"},
        {false, "nm,v\n400,0\n700,0\n", "line 2", "column v is 0 at every whole nm"},
        {false, "nm,v\n300,1\n340,0\n700,0\n", "line 2", "column v is 0 at every whole nm"},
        {false, "nm,v\n500.2,1\n500.8,1\n", "line 2", "column v is 0 at every whole nm"},
        {true, "nm,r,g,b\n400,1,0,1\n500,1,0,1\n", "line 2", "column g is 0 at every"},
        {false, "nm,v\n500.4,0\n500.5,9\n500.6,0\n532,0\n533,1\n534,0\n", "",
         "column v has lines too narrow for tables of 1 nm"},
    };
    const TemporaryFolder folder;
    for (const auto& [response, text, place, message] : cases) {
        const std::string path = file_of(folder, text);
        const std::string said = refusal([&] {
            if (response)
                (void)find_response(path);
            else
                (void)find_illuminant(path);
        });
        EXPECT_TRUE(said.starts_with(path + ": " + (place.empty() ? "" : place + ": "))) << said;
        EXPECT_TRUE(has(said, message));
    }
}

TEST(UserSpectra, WhatIsNeitherANameNorAFileIsToldTheNames) {
    EXPECT_THROW((void)find_illuminant("led"), ArgumentError);
    EXPECT_TRUE(has(refusal([] { (void)find_illuminant("led"); }), "led: is neither"));
    EXPECT_TRUE(has(refusal([] { (void)find_illuminant(""); }), "the names are d65, a, f11"));
    EXPECT_TRUE(has(refusal([] { (void)find_response("d65"); }), "the names are cie1931"));
    EXPECT_TRUE(has(refusal([] { (void)find_illuminant("/"); }), "is a folder"));
    EXPECT_EQ(illuminant_names(), "d65, a, f11");
    EXPECT_EQ(metal_names(), "ag, al, au, cu");
}

}  // namespace
}  // namespace petzval::io
