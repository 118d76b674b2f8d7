// SPDX-License-Identifier: Apache-2.0
// Rays to targets, from the command line: what they change and what they leave.
#include "io/image/difference.h"
#include "io/image/picture_files.h"
#include "tests/support/cli_spectral.h"

namespace petzval::apps {
namespace {

/// Lamps far out of focus, through a thin lens and a traced one.
class CliTargets : public CliSpectral {
  protected:
    CliTargets() { scene_ = PETZVAL_ASSETS "/scenes/ornaments.glb"; }
    [[nodiscard]] static Words thin(Words more) {
        Words words = {"--lens",  "thin", "--fov",  "26",    "--method", "lens-radius=0.045",
                       "--focus", "1m",   "--size", "64x42", "--spp",    "5"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    [[nodiscard]] static Words traced(Words more) {
        Words words = {"--lens",  "takumar-50mm-f1.2",
                       "--focus", "0.4m",
                       "--fstop", "1.2",
                       "--size",  "64x42",
                       "--spp",   "5"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

TEST_F(CliTargets, EqualRendersAreEqualFiles) {
    for (const auto& lens : {thin, traced}) {
        const Words words = lens({"--method", "targets=auto"});
        const auto with = [&](const Words& more) {
            Words all = words;
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        const io::Picture whole = render(words, "whole.exr");
        const std::string bytes = file_bytes(path("whole.exr"));
        EXPECT_TRUE(bytes == render_bytes(with({"--threads", "1"})));
        EXPECT_TRUE(bytes == render_bytes(with({"--threads", "4"})));
        EXPECT_FALSE(bytes == render_bytes(lens({"--method", "targets=off"})));
        const io::Picture part = render(with({"--crop", "13,5,40,31"}));
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 40; ++x)
                for (const char* c : {"R", "G", "B"})
                    ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 13, y + 5, c));
    }
}

// They come from ordinary rays, with their whole weight.
TEST_F(CliTargets, AlphaAndLayersStay) {
    const Words layers = {"--transparent", "--aov", "normal,depth,albedo"};
    for (const auto& lens : {thin, traced}) {
        Words off = layers, automatic = layers;
        off.insert(off.end(), {"--method", "targets=off"});
        automatic.insert(automatic.end(), {"--method", "targets=auto"});
        const io::Picture without = render(lens(off), "off.exr"),
                          with = render(lens(automatic), "auto.exr");
        ASSERT_EQ(with.channels, without.channels);
        bool differs = false;
        for (int y = 0; y < with.height; ++y)
            for (int x = 0; x < with.width; ++x)
                for (const std::string& c : with.channels) {
                    const bool equal = value_at(with, x, y, c) == value_at(without, x, y, c);
                    if (c == "R" || c == "G" || c == "B")
                        differs = differs || !equal;
                    else
                        ASSERT_TRUE(equal) << c << ' ' << x << ' ' << y;
                }
        EXPECT_TRUE(differs);
    }
}

TEST_F(CliTargets, NoByteChangesWhereThereAreNone) {
    scene_ = PETZVAL_ASSETS "/scenes/gem.glb";  // its lamps are large
    for (const Words& lens :
         {Words{"--lens", "pinhole"}, Words{"--fstop", "8", "--focus", "auto"}}) {
        Words words = lens;
        words.insert(words.end(), {"--size", "40x24", "--spp", "2"});
        const auto pixels = [&](const char* use) {
            Words all = words;
            all.insert(all.end(), {"--method", "targets=" + std::string(use)});
            return render(all).pixels;
        };
        EXPECT_TRUE(pixels("auto") == pixels("off"));
    }
}

TEST_F(CliTargets, AreCounted) {
    const auto rays = [&](const char* use) {
        static_cast<void>(render(
            thin({"--method", "targets=" + std::string(use), "--stats", path("stats.json")})));
        return json::parse(file_bytes(path("stats.json")))["rays"];
    };
    EXPECT_EQ(rays("off")["to_targets"], 0);
    const json with = rays("auto");
    EXPECT_GT(with["to_targets"], 100);
    EXPECT_EQ(with["camera"].get<int>(), with["to_targets"].get<int>() + 64 * 42 * 5);
}

// Against many samples without targets.
TEST_F(CliTargets, AreNearerToTheTruth) {
    const auto rendered = [&](const char* use, const char* samples, const char* name) {
        return render(
            thin({"--method", "targets=" + std::string(use), "--spp", samples, "--size", "128x84"}),
            name);
    };
    const io::Picture reference = rendered("off", "1024", "reference.exr");
    const auto error = [&](const char* use) {
        return *io::compare(rendered(use, "64", "one.exr"), reference).front().symmetric_mse;
    };
    EXPECT_LT(error("auto"), 0.75 * error("off"));
}

TEST_F(CliTargets, OtherWordsAreRefused) {
    EXPECT_NE(error_of({"render", scene_, "-o", path("x.exr"), "--method", "targets=some"}, 2)
                  .find("none of auto, off"),
              std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
