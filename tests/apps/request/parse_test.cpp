// SPDX-License-Identifier: Apache-2.0
// Spellings of values.
#include "apps/request/parse.h"

#include <gtest/gtest.h>

#include <cmath>

namespace petzval::apps {
namespace {

float focus_m(const std::string& text) {
    const Focus focus = parse_focus("--focus", text);
    return std::get<FocusDistance>(focus).m;
}

TEST(Parse, FocusTakesUnitsAndInfinity) {
    const std::pair<const char*, float> cases[] = {
        {"1.5", 1.5f},   {"1.5m", 1.5f},    {"2mm", 0.002f},  {"30cm", 0.3f}, {"2km", 2000.f},
        {"5ft", 1.524f}, {"12in", 0.3048f}, {"+1.5 m", 1.5f}, {"30CM", 0.3f}, {"1e3mm", 1.f}};
    for (const auto& [text, m] : cases) EXPECT_EQ(focus_m(text), m) << text;
    for (const char* text : {"infinity", "Infinity", "inf", "INF", "∞"})
        EXPECT_TRUE(std::isinf(focus_m(text))) << text;
    EXPECT_TRUE(std::holds_alternative<FocusAuto>(parse_focus("--focus", "Auto")));
    const Focus pixel = parse_focus("--focus", "10,79");
    EXPECT_EQ(std::get<FocusPixel>(pixel).y, 79);
    EXPECT_EQ(parse_pixel("pixel", "10, 79"), V2i(10, 79));
    EXPECT_EQ(std::get<Rect>(parse_crop("--crop", "1, 2, 3, 4")).x1, 4);
    const auto band = std::get<FrameBand>(parse_crop("--crop", "2 / 3"));
    EXPECT_EQ(band.part, 2);
    EXPECT_EQ(band.of, 3);
    for (const char* text :
         {"", "m", "0", "-1m", "1.5 x", "1,5m", "-1,8", "nan", "infinite", "1e-9", "1e9km"})
        EXPECT_THROW((void)parse_focus("--focus", text), ValueError) << text;
}

TEST(Parse, PosesAreRotations) {
    const M44f pose = parse_pose("--pose", "0,0,1,1, 0,1,0,2, -1,0,0,3");
    EXPECT_EQ(V3f(pose[3][0], pose[3][1], pose[3][2]), V3f(1, 2, 3));
    EXPECT_EQ(V3f(pose[2][0], pose[2][1], pose[2][2]), V3f(1, 0, 0));
    EXPECT_EQ(parse_pose("--pose", text_of_pose(pose)), pose);
    for (const char* text :
         {"1,0,0,0,0,1,0,0,0,0,1", "1,0,0,0,0,1,0,0,0,0,-1,0", "2,0,0,0,0,1,0,0,0,0,1,0",
          "1,0,0.1,0,0,1,0,0,0,0,1,0", "1,0,0,1e13,0,1,0,0,0,0,1,0", "1,0,0,nan,0,1,0,0,0,0,1,0",
          "0,0,0,0,0,0,0,0,0,0,0,0"})
        EXPECT_THROW((void)parse_pose("--pose", text), ValueError) << text;
}

TEST(Parse, DurationsAddUp) {
    const std::pair<const char*, double> cases[] = {
        {"90", 90},   {"90s", 90},       {"1.5m", 90},       {"1m30s", 90},     {"1h", 3600},
        {"2h", 7200}, {"1h30m", 5400},   {"1h 30min", 5400}, {"1H30M5S", 5405}, {"500ms", 0.5},
        {"1:30", 90}, {"1:02:03", 3723}, {"90:00", 5400},    {"1e3", 1000}};
    for (const auto& [text, s] : cases)
        EXPECT_EQ(parse_duration_s("--time-limit", text), s) << text;
    for (const char* text : {"", "0", "0s", "-5", "10d", "s", "1h30", "30s1m", "1m2m", "1:60",
                             "1:5", "1:2:3:4", "1:", "1e300", "1e300h", "inf", "1.2.3s"})
        EXPECT_THROW((void)parse_duration_s("--time-limit", text), ValueError) << text;
}

TEST(Parse, SizesTakeWhateverStandsForTimes) {
    for (const char* text : {"1920x1080", "1920X1080", "1920×1080", "1920 x 1080"})
        EXPECT_EQ(parse_size("--size", text), V2i(1920, 1080)) << text;
    for (const char* text : {"36x24", "36x24mm", "36mmx24mm", "3.6cmx2.4cm", "36×24"})
        EXPECT_EQ(parse_sensor("--sensor", text, 1, 100), V2f(36, 24)) << text;
    for (const char* text : {"1920", "0x10", "10x", "10x10x10", "1.5x2", "65537x1"})
        EXPECT_THROW((void)parse_size("--size", text), ValueError) << text;
}

std::string samples_refused(const std::string& text) {
    try {
        (void)parse_samples("--spp", text, 100);
    } catch (const ValueError& error) {
        return error.what();
    }
    return "none";
}

TEST(Parse, SamplesAreARange) {
    EXPECT_EQ(parse_samples("--spp", "8:16", 100).first, 8u);
    for (const char* text : {"", "0", "-4", "x", "8:4", "0:101", "1:2:3"})
        EXPECT_EQ(samples_refused(text),
                  std::string("--spp: \"") + text +
                      "\" is not a range A:B of samples, from A to before B, with A < B <= 100");
}

TEST(Parse, OtherValuesTakeTheirUnits) {
    EXPECT_EQ(parse_lengths_m("--look-at", "0,1.5m,30cm,-2mm,0,1ft", 6),
              (std::vector<float>{0, 1.5f, 0.3f, -0.002f, 0, 0.3048f}));
    EXPECT_THROW((void)parse_numbers("--background", "1m,1,1", 3), ValueError);
    for (const char* text : {"0.01", "1/100", "1/100s", "10ms", "10 ms"})
        EXPECT_EQ(parse_shutter("--shutter", text).value, double(0.01f)) << text;
    EXPECT_TRUE(parse_shutter("--shutter", "180deg").is_angle);
    EXPECT_EQ(parse_share("--tolerance", "1 %"), 0.01);
    for (const char* text : {"8GB", "8gb", "8 GB", "8000mb"})
        EXPECT_EQ(parse_memory_bytes("--max-memory", text), 8'000'000'000u) << text;
    EXPECT_EQ(parse_memory_bytes("--max-memory", "1kib"), 1024u);
    for (const char* text : {"8", "GB", "-1GB", "8G", "1e30TB"})
        EXPECT_THROW((void)parse_memory_bytes("--max-memory", text), ValueError) << text;
    const Bins bins = parse_bins("--bins", "380nm:730nm:10nm");
    EXPECT_EQ(bins.count, 35);
    EXPECT_EQ(parse_number("--film-shift", "-0.1cm", {-10, 10, kMillimetres}), -1);
    EXPECT_EQ(parse_number("--field", "10°", {0, 90, kDegrees}), 10);
    std::vector<Aov> layers;
    for (const char* text : {"depth,Albedo", "depth"}) add_aovs("--aov", text, layers);
    EXPECT_EQ(layers, (std::vector<Aov>{*aov_from_name("depth"), *aov_from_name("albedo")}));
}

TEST(Parse, FramesAreARangeWithinItsLimits) {
    EXPECT_EQ(parse_frames("--frames", "1:7:3"), (std::vector<int>{1, 4, 7}));
    EXPECT_EQ(parse_frames("--frames", "1:6:3"), (std::vector<int>{1, 4}));
    EXPECT_EQ(parse_frames("--frames", "10000000"), std::vector<int>{10'000'000});
    EXPECT_EQ(parse_frames("--frames", "0:99999").size(), 100'000u);
    for (const char* text : {"", "-1", "10000001", "2:1", "1:2:0", "1:2:1:1", "0:100000"})
        EXPECT_THROW((void)parse_frames("--frames", text), ValueError) << text;
}

// The number in a text; nothing where it is refused.
template <class Parse>
std::optional<double> read(const Parse& parse, const std::string& text) {
    try {
        return parse(text);
    } catch (const ValueError&) {
        return std::nullopt;
    }
}

TEST(Parse, NumbersLieInTheirRanges) {
    const auto fnumber = [](const std::string& text) {
        return parse_fnumber("--fstop", text, {0.1, 100});
    };
    for (const char* text : {"2", "f/2", "F/2", "f2", "F2", "f:2", "ƒ/2", "1:2"})
        EXPECT_EQ(read(fnumber, text), 2) << text;
    for (const char* text : {"", "f", "f/", "2f", "f/0", "nan", "1:1:2"})
        EXPECT_FALSE(read(fnumber, text)) << text;
    const auto mm = [](const std::string& text) {
        return parse_number("--x", text, {0, 1e4, kMillimetres});
    };
    EXPECT_EQ(read(mm, "50"), 50);
    EXPECT_EQ(read(mm, "50mm"), 50);
    EXPECT_EQ(read(mm, "3.5 cm"), 35);
    EXPECT_EQ(read(mm, "2in"), 50.8);
    EXPECT_FALSE(read(mm, "11m"));
    EXPECT_EQ(parse_number("--orbit", "-90°", {-360, 360, kDegrees}), -90);
    for (const char* text : {"1.5EV", "+1.5 ev", "1.5"})
        EXPECT_EQ(parse_number("--x", text, {-9, 9, kStops}), 1.5) << text;
    const auto whole = [](const std::string& text) {
        return double(parse_whole_number("--x", text, 1, 100));
    };
    // A leading zero makes no number octal.
    EXPECT_EQ(read(whole, "010"), 10);
    EXPECT_EQ(read(whole, "+7"), 7);
    for (const char* text : {"0x10", "1e1", "1.0", "-1", "101", ""})
        EXPECT_FALSE(read(whole, text)) << text;
}

}  // namespace
}  // namespace petzval::apps
