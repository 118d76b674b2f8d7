// SPDX-License-Identifier: Apache-2.0
// Rendering to a noise from the command line: what is said, written and refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using testing::HasSubstr;

class CliNoise : public CliTest {
  protected:
    [[nodiscard]] Finished noisy(Words more, const std::string& out = "noise.exr") const {
        Words words{"render", scene_,       "--threads", "2",  "--size",
                    "48x32",  "--progress", "none",      "-o", path(out)};
        words.insert(words.end(), more.begin(), more.end());
        return run_petzval(words);
    }
    [[nodiscard]] static float number(const io::Picture& picture, const std::string& name) {
        for (const auto& [other, value] : picture.metadata)
            if (const float* number = std::get_if<float>(&value); number && other == name)
                return *number;
        return -1;
    }
};

TEST_F(CliNoise, IsReachedAndSaid) {
    const Finished run = noisy({"--noise", "10%", "--stats", path("stats.json")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("noise: "));
    const io::Picture picture = io::read_picture(path("noise.exr"));
    EXPECT_GT(number(picture, "petzval:noise"), 0);
    EXPECT_LE(number(picture, "petzval:noiseOfWorstCell"), 0.1f);
    for (const char* channel : {"samples.N", "stderr.R", "stderr.G", "stderr.B"})
        EXPECT_GE(io::channel_index(picture, channel), 0) << channel;
    std::ifstream file(path("stats.json"));
    EXPECT_EQ(nlohmann::json::parse(file)["noise"]["cells_left"], 0);
    const Finished said = run_petzval({"image", "noise", path("noise.exr"), "--regions", "2"});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(std::ranges::count(said.out, '\n'), 5);
}

// Hardly any of the pilot's pixels shows a lamp that is two kilometres away.
TEST_F(CliNoise, AFewLitPixelsTellTheFloor) {
    const Finished run = run_petzval(
        {"render", std::string(PETZVAL_ASSETS) + "/scenes/flying_lamp.glb", "--pose",
         "1,0,0,0,0,1,0,0,0,0,1,2000", "--size", "480x320", "--noise", "20%", "--spp", "16",
         "--progress", "none", "-o", path("far.exr"), "--stats", path("stats.json")});
    EXPECT_EQ(run.exit_code, 5) << run.err;
    std::ifstream file(path("stats.json"));
    EXPECT_GT(nlohmann::json::parse(file)["noise"]["floor_nits"], 0);
}

TEST_F(CliNoise, ABoundHasAnExitCodeOfItsOwn) {
    const Finished bounded = noisy({"--noise", "0.01%", "--spp", "16"});
    EXPECT_EQ(bounded.exit_code, 5) << bounded.err;
    EXPECT_THAT(bounded.err, HasSubstr(" parts are above 0.01 %"));
    const Finished late = noisy({"--noise", "0.01%", "--time-limit", "0.000001s"});
    EXPECT_EQ(late.exit_code, 5) << late.err;
    EXPECT_THAT(late.err, HasSubstr("noise: not known"));
}

TEST_F(CliNoise, IsPartOfACropOfWholeCells) {
    ASSERT_EQ(noisy({"--noise", "10%"}).exit_code, 0);
    ASSERT_EQ(noisy({"--noise", "10%", "--crop", "16,0,32,16"}, "crop.exr").exit_code, 0);
    const io::Picture whole = io::read_picture(path("noise.exr")),
                      crop = io::read_picture(path("crop.exr"));
    const size_t channels = whole.channels.size(), row = 32 * channels;
    ASSERT_EQ(crop.pixels.size(), 16 * row);
    for (size_t y = 0; y < 16; ++y)
        EXPECT_TRUE(std::equal(crop.pixels.begin() + std::ptrdiff_t(y * row),
                               crop.pixels.begin() + std::ptrdiff_t((y + 1) * row),
                               whole.pixels.begin() + std::ptrdiff_t((48 * y + 16) * channels)))
            << y;
    const Finished cut = noisy({"--noise", "10%", "--crop", "3,3,20,8"});
    EXPECT_EQ(cut.exit_code, 2);
    EXPECT_THAT(cut.err, HasSubstr("0,0,32,16 holds it"));
}

// Bands that machines share, of 53 rows.
TEST_F(CliNoise, BandsMergeToTheBytesOfOneRun) {
    const Words all = {"--noise", "10%", "--size", "40x53"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), all.begin(), all.end());
        return more;
    };
    const Finished whole = noisy(with({"--stats", path("whole.json")}));
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    Words merge = {"merge", "-o", path("merged.exr"), "--stats", path("merged.json")};
    for (const char* band : {"3/3", "1/3", "2/3"}) {
        const std::string state = std::string("band") + band[0] + ".state";
        ASSERT_EQ(noisy(with({"--crop", band}), state).exit_code, 0);
        merge.push_back(path(state));
    }
    const Finished merged = run_petzval(merge);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_THAT(merged.err, HasSubstr("noise: "));
    EXPECT_TRUE(file_bytes(path("noise.exr")) == file_bytes(path("merged.exr")));
    const auto noise = [&](const char* file) {
        return nlohmann::json::parse(file_bytes(path(file)))["noise"];
    };
    EXPECT_EQ(noise("whole.json"), noise("merged.json"));
    EXPECT_THAT(run_petzval({"resume", path("band1.state"), "--noise", "5%"}).exit_code,
                testing::AnyOf(0, 5));
    const Finished unlike = run_petzval(merge);
    EXPECT_EQ(unlike.exit_code, 1);
    EXPECT_THAT(unlike.err, HasSubstr("STATE --noise 5% brings the other one to the same"));
}

TEST_F(CliNoise, GoesOnToALowerOne) {
    ASSERT_EQ(noisy({"--noise", "20%"}, "kept.state").exit_code, 0);
    const Finished higher = run_petzval({"resume", path("kept.state"), "--noise", "30%"});
    EXPECT_EQ(higher.exit_code, 1);
    EXPECT_THAT(higher.err, HasSubstr("a higher one is reached already"));
    const Finished lower = run_petzval({"resume", path("kept.state"), "--noise", "10%"});
    EXPECT_EQ(lower.exit_code, 0) << lower.err;
    EXPECT_THAT(lower.err, HasSubstr("noise: "));
}

}  // namespace
}  // namespace petzval::apps
