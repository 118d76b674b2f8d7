// SPDX-License-Identifier: Apache-2.0
// Diffraction, from the command line: what it changes, and what stays as it was.
#include "io/image/picture_files.h"
#include "tests/support/cli_spectral.h"

namespace petzval::apps {
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
    for (const Words& camera : {thin_, lens_})
        expect_equal_renders(
            [&](Words more) {
                more.insert(more.end(), {"--diffraction", "auto", "--aov", "normal,depth"});
                return stopped_down(camera, more);
            },
            {"R", "G", "B", "A", "normal.X", "depth.Z"});
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
            const io::Picture p =
                render(stopped_down(camera, {"--spp", "128", "--diffraction", use}));
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
}  // namespace petzval::apps
