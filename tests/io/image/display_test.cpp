// SPDX-License-Identifier: Apache-2.0
#include "io/image/display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "core/spectrum/colour.h"
#include "io/base/error.h"
#include "io/file/assets.h"
#include "tests/support/ocio_config.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::held;
using test::picture;

std::vector<float> shown(const std::vector<float>& rgb, const std::string& view, float ev = 0.f) {
    const Picture linear = picture(int(rgb.size() / 3), 1, {"R", "G", "B"}, rgb);
    return held(to_display(linear, ev, view, AlphaUse::Keep)).pixels;
}
float shown_grey(float value, const std::string& view, float ev = 0.f) {
    const auto rgb = shown({value, value, value}, view, ev);
    EXPECT_NEAR(rgb[0], rgb[1], 2e-6f * (1 + rgb[0]));
    EXPECT_NEAR(rgb[2], rgb[1], 2e-6f * (1 + rgb[1]));
    return rgb[1];
}

TEST(Display, ListsItsViewsDefaultFirst) {
    EXPECT_EQ(display_views(), (std::vector<std::string>{"sRGB", "ACES", "raw"}));
    EXPECT_EQ(display_views().front(), kDefaultView);
}

TEST(Display, NamesTheViewsWhereOneIsUnknown) {
    try {
        (void)shown({0, 0, 0}, "filmic");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("\"filmic\"; there are sRGB, ACES, raw"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_EQ(find_view(""), kDefaultView);
    EXPECT_EQ(find_view("aces"), "ACES");
    EXPECT_EQ(find_view("srgb display/RAW"), "raw");
}

// OpenColorIO makes the line and the power meet without a kink, the standard's rounded 12.92 does
// not: they differ by 1.2e-5, far below an 8-bit step.
TEST(Display, SrgbIsTheInverseOfItsDecoding) {
    for (int i = 0; i <= 255; ++i) {
        const float encoded = float(i) / 255.f;
        EXPECT_NEAR(shown_grey(srgb_to_linear(encoded), "sRGB"), encoded, 1.5e-5f) << i;
    }
    const auto rgb = shown({1.f, 0.f, 0.2f}, "sRGB");  // no channel leaks into another
    EXPECT_NEAR(rgb[0], 1.f, 1e-6f);
    EXPECT_NEAR(rgb[1], 0.f, 1e-6f);
    EXPECT_NEAR(rgb[2], 1.055f * std::pow(0.2f, 1 / 2.4f) - 0.055f, 1e-6f);
}

TEST(Display, ExposureCountsInStops) {
    EXPECT_NEAR(shown_grey(0.05f, "sRGB", 2.f), shown_grey(0.2f, "sRGB"), 1e-6f);
    EXPECT_FLOAT_EQ(shown_grey(3.f, "raw", -1.f), 1.5f);
}

TEST(Display, RawLeavesTheNumbers) {
    const std::vector<float> values{-1.f, 0.f, 0.3f, 1.f, 7.f, 1e6f};
    EXPECT_EQ(shown(values, "raw"), values);
}

// Academy S-2014-004 (RRT 1.0) and the ODT of ACES 1.0 for 48 nits: 0.18 becomes 4.8 nits and
// 0.18 * 2^6.5 becomes 48 nits, 0.18 * 2^-6.5 becomes 0.02; 0.02 to 48 nits are coded linearly as
// 0 to 1, and luminance is raised to 0.9811 for the dim surround of video.
TEST(Display, AcesMeetsItsAnchors) {
    const float mid = std::pow((4.8f - 0.02f) / (48.f - 0.02f), 0.9811f);
    EXPECT_NEAR(srgb_to_linear(shown_grey(0.18f, "ACES")), mid, 2e-4f);
    EXPECT_NEAR(shown_grey(0.18f * std::exp2(6.5f), "ACES"), 1.f, 1e-3f);
    EXPECT_NEAR(shown_grey(0.18f * std::exp2(-6.5f), "ACES"), 0.f, 1e-3f);
}

TEST(Display, AcesGreysRise) {
    float before = -1.f;
    for (float stops = -6.f; stops < 7.f; stops += 0.125f) {
        const float value = shown_grey(0.18f * std::exp2(stops), "ACES");
        EXPECT_GT(value, before) << stops;
        before = value;
    }
}

TEST(Display, AcesKeepsTheOrderOfTheChannels) {
    const std::vector<float> dim{0.3f, 0.1f, 0.02f, 0.02f, 0.3f, 0.1f, 0.1f, 0.02f, 0.3f};
    const auto out = shown(dim, "ACES");
    for (size_t i = 0; i < dim.size(); i += 3)
        for (size_t a = 0; a < 3; ++a)
            for (size_t b = 0; b < 3; ++b)
                EXPECT_EQ(dim[i + a] > dim[i + b], out[i + a] > out[i + b]) << i << a << b;
    // Far above white, colours pale.
    const auto bright = shown({30.f, 10.f, 2.f}, "ACES");
    EXPECT_GT(bright[2] / bright[0], 2 * out[2] / out[0]);
}

TEST(Display, AlphaDividesForPngAndStaysForBlack) {
    const Picture p = picture(2, 1, {"A", "depth.Z", "R", "G", "B"},
                              {0.5f, 9.f, 0.1f, 0.2f, 0.4f, 0.f, 9.f, 0.f, 0.f, 0.f});
    const Picture kept = held(to_display(p, 0.f, "raw", AlphaUse::Keep));
    EXPECT_EQ(kept.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(kept.pixels, (std::vector<float>{0.2f, 0.4f, 0.8f, 0.5f, 0, 0, 0, 0}));
    const Picture black = held(to_display(p, 0.f, "raw", AlphaUse::OnBlack));
    EXPECT_EQ(black.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(black.pixels, (std::vector<float>{0.1f, 0.2f, 0.4f, 0, 0, 0}));
    const Picture curve = held(to_display(p, 3.f, "sRGB", AlphaUse::Keep));
    EXPECT_FLOAT_EQ(curve.pixels[3], 0.5f) << "alpha has neither exposure nor curve";
}

TEST(Display, ShowsGreyAndRefusesWhatHasNoColour) {
    const Picture y = picture(1, 1, {"Y"}, {0.3f});
    const Picture grey = held(to_display(y, 0.f, "raw", AlphaUse::Keep));
    EXPECT_EQ(grey.pixels, (std::vector<float>{0.3f, 0.3f, 0.3f}));
    EXPECT_THROW((void)to_display(picture(1, 1, {"depth.Z"}), 0.f, "raw", AlphaUse::Keep),
                 InputError);
}

class ForeignConfig : public ::testing::Test {
  protected:
    test::TemporaryFolder folder_;
    std::filesystem::path config(const std::string& text, const char* name = "config.ocio") const {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    static std::vector<float> red(const std::string& view, const std::filesystem::path& by) {
        const Picture p = picture(1, 1, {"R", "G", "B"}, {2.f, 0.f, 0.f});
        return held(to_display(p, -1.f, view, AlphaUse::Keep, by)).pixels;
    }
    static std::string complaint(const std::string& view, const std::filesystem::path& by) {
        try {
            static_cast<void>(find_view(view, by));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(ForeignConfig, ListsAndFindsItsViews) {
    const auto aces = config(test::aces_config());
    EXPECT_EQ(display_views(aces),
              (std::vector<std::string>{"Rec709", "Working", "Numbers", "Cinema/Half"}));
    EXPECT_EQ(find_view("", aces), "Rec709");
    EXPECT_EQ(find_view("working", aces), "Working");
    EXPECT_EQ(find_view("Monitor/Working", aces), "Working");
    EXPECT_EQ(find_view("half", aces), "Cinema/Half");
    EXPECT_NE(complaint("Numbres", aces)
                  .find("there are Rec709, Working, Numbers, Cinema/Half; did you mean Numbers?"),
              std::string::npos)
        << complaint("Numbres", aces);
}

// Columns of the matrix from Rec. 709 to ACEScg as ACES publishes it: the light is converted into
// the configuration's own space, and not taken for it.
TEST_F(ForeignConfig, LightIsConvertedFromRec709) {
    const std::array<float, 3> red_in_acescg{0.613097f, 0.070194f, 0.020616f};
    const std::string own =
        "  - !<ColorSpace>\n    name: Own\n    to_scene_reference: !<GroupTransform>\n      "
        "children:\n"
        "        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD, direction: "
        "inverse}\n        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}\n";
    for (const auto& by : {config(test::aces_config(), "interchange.ocio"),
                           config(test::aces_config("", test::kNamedRec709), "alias.ocio"),
                           config(test::aces_config("  lin_rec709: Own\n", own), "role.ocio")}) {
        const auto working = red("Working", by), back = red("Rec709", by), half = red("Half", by);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(working[i], red_in_acescg[i], 1e-4f) << i;
            EXPECT_NEAR(back[i], i == 0 ? 1.f : 0.f, 1e-4f) << i;
        }
        EXPECT_NEAR(half[0], 0.439633f / 2, 1e-4f);
        EXPECT_EQ(red("Numbers", by), (std::vector<float>{1, 0, 0})) << "data are not converted";
    }
}

TEST_F(ForeignConfig, RefusesWhatDoesNotSayWhereItsColoursAre) {
    const std::string why = complaint("", config(test::aces_config("")));
    EXPECT_NE(why.find("config.ocio: does not say which of its colour spaces is linear Rec. 709"),
              std::string::npos)
        << why;
    EXPECT_NE(why.find("lin_rec709"), std::string::npos) << why;
    EXPECT_NE(complaint("", config("nonsense")).find("config.ocio: cannot be used: "),
              std::string::npos);
    EXPECT_NE(complaint("", folder_ / "none.ocio").find("none.ocio: cannot be used: "),
              std::string::npos);
}

TEST(Assets, AreFoundInTheSourceTreeOrNamed) {
    EXPECT_TRUE(std::filesystem::exists(asset("color/config.ocio")));
    EXPECT_THROW((void)asset("color/none.ocio"), InputError);
}

}  // namespace
}  // namespace petzval::io
