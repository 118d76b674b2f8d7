// SPDX-License-Identifier: Apache-2.0
// Ghosts, from the command line: what they add, and what they leave as it was.
#include "io/image/picture_files.h"
#include "tests/support/cli_spectral.h"

namespace petzval {
namespace {

/// Small lamps, through a traced lens of its year's coating.
class CliGhosts : public CliSpectral {
  protected:
    CliGhosts() { scene_ = PETZVAL_ASSETS "/scenes/ornaments.glb"; }
    [[nodiscard]] static Words coated(const Words& more) {
        Words words = {"--lens",   "double-gauss-100mm-f2", "--focus", "1m",
                       "--method", "coating=year",          "--size",  "48x32"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

TEST_F(CliGhosts, PictureWithoutTheirLayerIsThatOfALensWithout) {
    for (const Words& more : {Words{}, Words{"--spectral", "rgb"}, Words{"--method", "clamp=50"}}) {
        const auto with = [&](Words ghosts) {
            ghosts.insert(ghosts.end(), more.begin(), more.end());
            ghosts.insert(ghosts.end(), {"--spp", "9", "--method", "dispersion=hero"});
            return coated(ghosts);
        };
        const Picture both = render(with({"--aov", "ghosts"})),
                      off = render(with({"--ghosts", "off"})),
                      only = render(with({"--ghosts", "only", "--aov", "ghosts"}));
        double light = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x)
                for (const std::string c : {"R", "G", "B"}) {
                    const float ghosts = value_at(both, x, y, "ghosts." + c);
                    const float sum = value_at(both, x, y, c);
                    ASSERT_NEAR(sum - ghosts, value_at(off, x, y, c),
                                1e-5f * (std::fabs(sum) + std::fabs(ghosts)));
                    ASSERT_EQ(value_at(only, x, y, c), value_at(only, x, y, "ghosts." + c));
                    ASSERT_EQ(value_at(only, x, y, c), ghosts);
                    light += double(ghosts);
                }
        EXPECT_GT(light, 0);
    }
}

TEST_F(CliGhosts, EqualRendersAreEqualFiles) {
    const auto with = [&](const Words& more) {
        Words all = coated({"--aov", "ghosts,depth"});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const Picture whole = render(with({"--spp", "6"}), "whole.exr");
    const std::string bytes = file_bytes(path("whole.exr"));
    EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "1"})));
    EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "4"})));
    const Picture part = render(with({"--spp", "6", "--crop", "13,5,20,11"}));
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 20; ++x)
            for (const char* c : {"R", "G", "B", "A", "ghosts.R", "ghosts.G", "depth.Z"})
                ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 13, y + 5, c));
    for (const char* range : {"0:2", "2:6"})
        EXPECT_EQ(run_petzval(render_words(with({"--spp", range, "-o",
                                                 path(std::string(1, range[0]) + ".state")}),
                                           scene_))
                      .exit_code,
                  0);
    EXPECT_EQ(run_petzval(
                  {"merge", path("0.state"), path("2.state"), "-o", path("merged.exr"), "--quiet"})
                  .exit_code,
              0);
    EXPECT_TRUE(bytes == file_bytes(path("merged.exr")));
}

// Alpha and the other layers are those of the light in order.
TEST_F(CliGhosts, AlphaAndLayersStay) {
    const Words more = {"--spp", "8", "--transparent", "--aov", "normal,depth,ghosts"};
    Words off = more;
    off.insert(off.end(), {"--ghosts", "off"});
    const Picture with = render(coated(more)), without = render(coated(off));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            for (const char* c : {"A", "normal.X", "normal.Z", "depth.Z"})
                ASSERT_EQ(value_at(with, x, y, c), value_at(without, x, y, c));
            ASSERT_EQ(value_at(without, x, y, "ghosts.R"), 0.f);
        }
}

TEST_F(CliGhosts, SayWhereThereAreNone) {
    const auto expect = [&](const Words& words, const char* text) {
        Words all = words;
        all.insert(all.end(), {"-o", path("never.exr")});
        const Finished run = run_petzval(render_words(all, scene_));
        EXPECT_EQ(run.exit_code, 2) << run.err;
        EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
    };
    expect({"--lens", "double-gauss-100mm-f2", "--ghosts", "only"},
           "--ghosts only: shows light that two surfaces of the lens reflect");
    expect({"--lens", "thin", "--fstop", "2", "--focus", "1m", "--ghosts", "only"},
           "--ghosts only: needs a lens that is traced");
    expect({"--lens", "singlet:schott:N-BK7", "--fstop", "8", "--focus", "1m", "--ghosts", "only"},
           "--ghosts only: needs a lens that is traced");
    std::ofstream(path("bare.json"))
        << R"({"surfaces": [{"radius": 50, "thickness": 5, "semi_diameter": 8,
            "medium": {"n": 1.5}}, {"radius": -50, "thickness": 48, "semi_diameter": 8, "stop": true, "medium": null}]})";
    expect({"--lens", path("bare.json"), "--focus", "1m", "--method", "coating=year"},
           "states no year");
}

}  // namespace
}  // namespace petzval
