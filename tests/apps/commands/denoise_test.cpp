// SPDX-License-Identifier: Apache-2.0
// Denoising from the command line: what is written, said and refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/cli.h"
#include "tests/support/pictures.h"

namespace petzval::apps {
namespace {

using testing::HasSubstr;

class CliDenoise : public CliTest {
  protected:
    [[nodiscard]] Finished denoised(Words more, const std::string& out = "a.exr") const {
        Words words{"render", scene_,   "--threads",  "2",    "--size", "64x48",  "--denoise",
                    "--env",  "studio", "--progress", "none", "-o",     path(out)};
        words.insert(words.end(), more.begin(), more.end());
        return run_petzval(words);
    }
    [[nodiscard]] nlohmann::json stats() const {
        std::ifstream file(path("stats.json"));
        return nlohmann::json::parse(file);
    }
};

TEST_F(CliDenoise, TheDenoisedPictureStandsBesideTheOther) {
    const Finished run = denoised({"--spp", "16", "--stats", path("stats.json")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("denoised: error "));
    const io::Picture picture = io::read_picture(path("a.exr"));
    for (const char* channel : {"R", "denoised.R", "denoised.G", "denoised.B", "denoised.error"})
        EXPECT_GE(io::channel_index(picture, channel), 0) << channel;
    const nlohmann::json json = stats()["denoised"];
    EXPECT_LE(json["picture"]["bounds"][0], json["picture"]["error"]);
    EXPECT_LE(json["picture"]["error"], json["picture"]["bounds"][1]);
    EXPECT_GT(json["noisy_picture"]["error"], 0);
}

// The whole as the render said it, then each region: 42 x 34 pixels have 6 x 5 blocks, the last
// ones of 2 pixels.
TEST_F(CliDenoise, AStateTellsItsErrorByRegion) {
    const Finished run = denoised({"--spp", "16", "--crop", "8,8,42,34"}, "a.state");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Finished said = run_petzval({"image", "noise", path("a.state"), "--regions", "2"});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(std::ranges::count(said.out, '\n'), 5);
    const std::string error = "denoised: error ";
    const size_t at = run.err.find(error) + error.size();
    EXPECT_THAT(said.out, HasSubstr(run.err.substr(at, run.err.find(", and", at) - at)));
    for (const char* region : {"\n8,8,24,16 ", "\n32,8,18,16 ", "\n8,24,24,18 ", "\n32,24,18,18 "})
        EXPECT_THAT(said.out, HasSubstr(region));
    const Finished one = run_petzval({"image", "noise", path("a.state"), "--regions", "1"});
    EXPECT_EQ(std::ranges::count(one.out, '\n'), 1);
    const Finished all = run_petzval({"image", "noise", path("a.state"), "--regions", "1000"});
    EXPECT_EQ(std::ranges::count(all.out, '\n'), 31);
}

TEST_F(CliDenoise, StatesWithoutTwoHalvesTellNoError) {
    const auto complaint = [&](Words more) {
        Words words{"render", scene_, "--size", "16x16", "--quiet", "-o", path("plain.state")};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(run_petzval(words).exit_code, 0);
        const Finished plain = run_petzval({"image", "noise", path("plain.state")});
        EXPECT_EQ(plain.exit_code, 1);
        return plain.err;
    };
    EXPECT_THAT(complaint({"--spp", "1"}), HasSubstr("render it with --denoise"));
    EXPECT_THAT(complaint({"--noise", "90%"}), HasSubstr("petzval merge"));
    EXPECT_THAT(complaint({"--spp", "0:1", "--denoise"}), HasSubstr("has no samples"));
}

// The display of a render, and of its EXR file.
TEST_F(CliDenoise, ADisplayShowsTheDenoisedPicture) {
    ASSERT_EQ(denoised({"--spp", "4", "-o", path("a.png")}).exit_code, 0);
    const Finished view = run_petzval({"image", "view", path("a.exr"), "-o", path("view.png")});
    ASSERT_EQ(view.exit_code, 0);
    EXPECT_THAT(view.err, HasSubstr("shows the denoised picture"));
    EXPECT_EQ(io::read_picture(path("view.png")).pixels, io::read_picture(path("a.png")).pixels);
    ASSERT_EQ(run_petzval({"render", scene_, "--size", "64x48", "--env", "studio", "--spp", "4",
                           "--quiet", "-o", path("noisy.exr"), "-o", path("noisy.png")})
                  .exit_code,
              0);
    EXPECT_NE(io::read_picture(path("a.png")).pixels, io::read_picture(path("noisy.png")).pixels);
    const Finished noisy =
        run_petzval({"image", "view", path("noisy.exr"), "-o", path("noisy_view.png")});
    EXPECT_EQ(noisy.err, "");
}

// Y is shown where a picture has it, whatever stands beside it.
TEST_F(CliDenoise, AGreyPictureOfAnotherProgramIsShownAsItIs) {
    io::write_exr(path("grey.exr"), test::picture(1, 1, {"Y"}, {0.2f}));
    io::write_exr(path("both.exr"),
                  test::picture(1, 1, {"Y", "denoised.R", "denoised.G", "denoised.B"},
                                {0.2f, 0.9f, 0.5f, 0.1f}));
    for (const char* name : {"grey", "both"}) {
        const Finished run =
            run_petzval({"image", "view", path(name) + ".exr", "-o", path(name) + ".png"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
    }
    EXPECT_EQ(io::read_picture(path("both.png")).pixels, io::read_picture(path("grey.png")).pixels);
}

TEST_F(CliDenoise, ACropHasTheBytesOfTheFrame) {
    ASSERT_EQ(denoised({"--spp", "16"}).exit_code, 0);
    ASSERT_EQ(denoised({"--spp", "16", "--crop", "20,10,21,13"}, "crop.exr").exit_code, 0);
    const io::Picture whole = io::read_picture(path("a.exr")),
                      crop = io::read_picture(path("crop.exr"));
    ASSERT_EQ(crop.channels, whole.channels);
    const size_t channels = whole.channels.size();
    const auto red = static_cast<size_t>(io::channel_index(whole, "denoised.R"));
    for (size_t y = 0; y < 13; ++y)
        for (size_t x = 0; x < 21; ++x)
            for (size_t c = red; c < red + 3; ++c)
                ASSERT_EQ(crop.pixels[(y * 21 + x) * channels + c],
                          whole.pixels[((y + 10) * 64 + x + 20) * channels + c]);
}

// Ranges of samples, and parts of the frame, that machines share.
TEST_F(CliDenoise, StatesMergeToTheBytesOfOneRun) {
    ASSERT_EQ(denoised({"--spp", "8"}).exit_code, 0);
    const auto merged = [&](const Words& states) {
        Words words{"merge"};
        for (const auto& state : states) words.push_back(path(state));
        words.insert(words.end(), {"-o", path("merged.exr")});
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return file_bytes(path("merged.exr"));
    };
    const Finished part = denoised({"--spp", "0:3"}, "1.state");
    ASSERT_EQ(part.exit_code, 0);
    EXPECT_THAT(part.err, testing::Not(HasSubstr("denoised: error")));
    ASSERT_EQ(denoised({"--spp", "3:8"}, "2.state").exit_code, 0);
    EXPECT_EQ(merged({"1.state", "2.state"}), file_bytes(path("a.exr")));
    ASSERT_EQ(denoised({"--spp", "0:8", "--crop", "0,0,64,20"}, "3.state").exit_code, 0);
    ASSERT_EQ(denoised({"--spp", "0:8", "--crop", "0,20,64,28"}, "4.state").exit_code, 0);
    EXPECT_EQ(merged({"3.state", "4.state"}), file_bytes(path("a.exr")));
    ASSERT_EQ(denoised({"--spp", "0:8", "--crop", "0,20,30,28"}, "5.state").exit_code, 0);
    ASSERT_EQ(denoised({"--spp", "0:8", "--crop", "30,20,30,28"}, "6.state").exit_code, 0);
    const Finished apart =
        run_petzval({"merge", path("5.state"), path("6.state"), "-o", path("merged.exr")});
    EXPECT_EQ(apart.exit_code, 1);
    EXPECT_THAT(apart.err, HasSubstr("give those of all of the frame"));
}

TEST_F(CliDenoise, RendersUntilItsErrorIsBelowANoise) {
    const Finished run = denoised({"--noise", "5%", "--stats", path("stats.json")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_LE(stats()["denoised"]["picture"]["bounds"][1], 0.05);
    const Finished bounded = denoised({"--noise", "0.01%", "--spp", "16"});
    EXPECT_EQ(bounded.exit_code, 5) << bounded.err;
    // A state goes on to a lower one, to the bytes of one run.
    ASSERT_EQ(denoised({"--noise", "20%"}, "kept.state").exit_code, 0);
    ASSERT_EQ(denoised({"--noise", "20%"}).exit_code, 0);
    ASSERT_EQ(run_petzval({"merge", path("kept.state"), "-o", path("merged.exr")}).exit_code, 0);
    EXPECT_EQ(file_bytes(path("merged.exr")), file_bytes(path("a.exr")));
    const Finished on = run_petzval({"resume", path("kept.state"), "--noise", "5%"});
    ASSERT_EQ(on.exit_code, 0) << on.err;
    ASSERT_EQ(run_petzval({"merge", path("kept.state"), "-o", path("merged.exr")}).exit_code, 0);
    ASSERT_EQ(denoised({"--noise", "5%"}).exit_code, 0);
    EXPECT_EQ(file_bytes(path("merged.exr")), file_bytes(path("a.exr")));
}

// The picture with bins is that of a render without denoising, and the denoised bins are those of
// the full frame, of one run, and of all of its parts.
TEST_F(CliDenoise, BinsAreDenoisedToo) {
    const Words bins{"--bins", "400:700:100", "--spp", "16"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), bins.begin(), bins.end());
        return more;
    };
    ASSERT_EQ(denoised(bins).exit_code, 0);
    const io::Picture whole = io::read_picture(path("a.exr"));
    Words plain{"render", scene_,   "--threads", "2",  "--size",         "64x48",
                "--env",  "studio", "--quiet",   "-o", path("plain.exr")};
    plain.insert(plain.end(), bins.begin(), bins.end());
    ASSERT_EQ(run_petzval(plain).exit_code, 0);
    const io::Picture noisy = io::read_picture(path("plain.exr"));
    ASSERT_EQ(denoised(with({"--crop", "20,10,21,13"}), "crop.exr").exit_code, 0);
    const io::Picture crop = io::read_picture(path("crop.exr"));
    const auto value = [](const io::Picture& of, const std::string& channel, size_t x, size_t y) {
        const auto at = static_cast<size_t>(io::channel_index(of, channel));
        return of.pixels[(y * size_t(of.width) + x) * of.channels.size() + at];
    };
    int differ = 0, found = 0;
    for (const std::string& channel : noisy.channels) {
        if (!channel.starts_with("S0.")) continue;
        const std::string denoised = "denoised." + channel;
        ++found;
        ASSERT_GE(io::channel_index(whole, denoised), 0) << denoised;
        for (size_t y = 0; y < 13; ++y)
            for (size_t x = 0; x < 21; ++x) {
                const float here = value(whole, denoised, x + 20, y + 10);
                ASSERT_GE(here, 0);
                ASSERT_EQ(value(crop, denoised, x, y), here);
                ASSERT_EQ(value(whole, channel, x + 20, y + 10),
                          value(noisy, channel, x + 20, y + 10));
                differ += here != value(noisy, channel, x + 20, y + 10);
            }
    }
    EXPECT_EQ(found, 3);
    EXPECT_GT(differ, 0);
    const Finished spectrum = run_petzval({"image", "spectrum", path("a.exr"), "30,20"});
    EXPECT_THAT(spectrum.out,
                HasSubstr(fmt::format("550 {:.9g} {:.9g}\n", value(whole, "S0.550,0nm", 30, 20),
                                      value(whole, "denoised.S0.550,0nm", 30, 20))));
    const Finished plain_spectrum = run_petzval({"image", "spectrum", path("plain.exr"), "30,20"});
    EXPECT_THAT(plain_spectrum.out,
                HasSubstr(fmt::format("550 {:.9g}\n", value(noisy, "S0.550,0nm", 30, 20))));
    Words words{"merge", path("1.state"), path("2.state"), "-o", path("merged.exr")};
    ASSERT_EQ(denoised({"--bins", "400:700:100", "--spp", "0:7"}, "1.state").exit_code, 0);
    ASSERT_EQ(denoised({"--bins", "400:700:100", "--spp", "7:16"}, "2.state").exit_code, 0);
    ASSERT_EQ(run_petzval(words).exit_code, 0);
    EXPECT_EQ(file_bytes(path("merged.exr")), file_bytes(path("a.exr")));
}

TEST_F(CliDenoise, WhatDoesNotGoTogetherIsRefused) {
    const std::pair<Words, const char*> wrong[] = {
        {{"--noise", "5%", "--crop", "0,0,16,16"}, "the error is that of the full frame"},
        {{"--spp", "1"}, "needs two halves of samples"}};
    for (const auto& [words, why] : wrong) {
        const Finished run = denoised(words);
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_THAT(run.err, HasSubstr(why));
    }
}

}  // namespace
}  // namespace petzval::apps
