// SPDX-License-Identifier: Apache-2.0
// Diffraction, from the command line: what it changes, and what stays as it was.
#include "io/image/picture_files.h"
#include "tests/support/cli_spectral.h"

namespace petzval {
namespace {

/// Small lamps through an iris of five blades.
class CliDiffraction : public CliSpectral {
  protected:
    CliDiffraction() { scene_ = PETZVAL_ASSETS "/scenes/ornaments.glb"; }
    [[nodiscard]] static Words stopped_down(const Words& camera, const Words& more) {
        Words words = {"--focus", "1m", "--aperture", "polygon:5", "--size", "48x32"};
        words.insert(words.end(), camera.begin(), camera.end());
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    const Words thin_ = {"--lens", "thin", "--fstop", "64"},
                lens_ = {"--lens", "double-gauss-100mm-f2", "--fstop", "32"};
};

TEST_F(CliDiffraction, EqualRendersAreEqualFiles) {
    for (const Words& camera : {thin_, lens_}) {
        const auto with = [&](Words more) {
            more.insert(more.end(), {"--diffraction", "auto", "--aov", "normal,depth"});
            return stopped_down(camera, more);
        };
        const Picture whole = render(with({"--spp", "6"}), "whole.exr");
        const std::string bytes = file_bytes(path("whole.exr"));
        EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "1"})));
        EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "4"})));
        const Picture part = render(with({"--spp", "6", "--crop", "13,5,20,11"}));
        for (int y = 0; y < 11; ++y)
            for (int x = 0; x < 20; ++x)
                for (const char* c : {"R", "G", "B", "A", "normal.X", "depth.Z"})
                    ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 13, y + 5, c));
        for (const char* range : {"0:2", "2:6"})
            EXPECT_EQ(run_petzval(render_words(with({"--spp", range, "-o",
                                                     path(std::string(1, range[0]) + ".state")}),
                                               scene_))
                          .exit_code,
                      0);
        EXPECT_EQ(run_petzval({"merge", path("0.state"), path("2.state"), "-o", path("merged.exr"),
                               "--quiet"})
                      .exit_code,
                  0);
        EXPECT_TRUE(bytes == file_bytes(path("merged.exr")));
    }
}

// What is asked for where nothing is diffracted leaves every byte.
TEST_F(CliDiffraction, LeavesPicturesThatItDoesNotChange) {
    for (const Words& camera :
         {Words{"--lens", "pinhole"},
          // A scene without lamps, and an iris a thousand times as wide as a wave.
          Words{"--lens", "thin", "--fstop", "0.7", "--focus", "1m", "--aperture", "circle"}}) {
        const auto channels = [&](const char* use) {
            Words words = {"--size", "24x16", "--spp", "2", "--diffraction", use};
            words.insert(words.end(), camera.begin(), camera.end());
            return render(words).pixels;
        };
        scene_ = PETZVAL_ASSETS "/scenes/gem.glb";
        EXPECT_EQ(channels("auto"), channels("off"));
    }
}

// Far from a sun stars add light where there was less; the sum over the frame is nearly kept.
TEST_F(CliDiffraction, SpreadsTheLightOfLamps) {
    scene_ = PETZVAL_ASSETS "/scenes/low_sun.glb";
    for (const Words& camera : {thin_, lens_}) {
        const auto light = [&](const char* use) {
            const Picture p = render(stopped_down(camera, {"--spp", "128", "--diffraction", use}));
            double sum = 0;
            std::vector<float> values;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 48; ++x) {
                    values.push_back(value_at(p, x, y, "G"));
                    sum += double(values.back());
                }
            std::ranges::nth_element(values, values.begin() + 700);
            return std::array{sum, double(values[700])};
        };
        const auto [sum, median] = light("auto");
        const auto [plain_sum, plain_median] = light("off");
        // Few samples meet the sun: the camera's own test knows its light to 2 %.
        EXPECT_NEAR(sum / plain_sum, 1, 0.25);
        EXPECT_GT(median, 1.02 * plain_median);
    }
}

}  // namespace
}  // namespace petzval
