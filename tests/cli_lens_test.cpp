// SPDX-License-Identifier: Apache-2.0
// Renders through lenses of glass, by the program.
#include "tests/support/cli.h"

namespace petzval {
namespace {

class CliLens : public CliTest {
  protected:
    CliLens() { scene_ = TinyGltf().save_gltf(folder_.path / "empty.gltf").string(); }
    /// A uniform world of 1 nit through a lens.
    [[nodiscard]] Picture flat(const Words& more) {
        Words words = {"--background", "1,1,1",  "--look-at", "0,0,0,0,0,-1", "--focus",
                       "100m",         "--size", "30x20",     "--spp",        "256"};
        words.insert(words.end(), more.begin(), more.end());
        return render(words);
    }
    [[nodiscard]] Finished run(const Words& more) {
        Words words = render_words({"-o", path("out.exr"), "--background", "1,1,1"}, scene_);
        words.insert(words.end(), more.begin(), more.end());
        return run_petzval(words);
    }
};

float middle(const Picture& p, const char* channel) {
    double sum = 0;
    for (int y = 8; y < 12; ++y)
        for (int x = 12; x < 18; ++x) sum += value_at(p, x, y, channel);
    return static_cast<float>(sum / 24);
}

// Within three standard errors of the noisiest, one wavelength a path.
// Whatever the lens, its f-number and its iris: what fills the world with 1 shows as 1 in the
// middle.
TEST_F(CliLens, MidGreyIsMidGreyThroughEveryLens) {
    for (const Words& words :
         {Words{"--lens", "double-gauss-100mm-f2"},
          Words{"--lens", "double-gauss-100mm-f2", "--fstop", "8", "--aperture", "star:5"},
          Words{"--lens", "schneider-anamorphic-31mm", "--chroma", "shared"},
          Words{"--lens", "tessar-100mm-f2.8", "--chroma", "single"}}) {
        const Picture p = flat(words);
        for (const char* c : {"R", "G", "B"})
            EXPECT_NEAR(middle(p, c), 1.f, 0.06f) << words[1] << ' ' << c;
        EXPECT_EQ(metadata_of(p, "petzval:lens"), words[1]);
    }
}

TEST_F(CliLens, CornersAreDarkerAndOpaque) {
    const Picture p = flat({"--lens", "takumar-50mm-f1.2", "--chroma", "shared"});
    EXPECT_LT(value_at(p, 0, 0, "G"), 0.4f);
    EXPECT_GT(value_at(p, 0, 0, "G"), 0.1f);
    EXPECT_EQ(value_at(p, 0, 0, "A"), 1.f);
}

TEST_F(CliLens, RefusesWhatALensCannotDo) {
    const std::pair<Words, std::string> cases[] = {
        {{"--lens", "takumar"}, "takumar"},
        {{"--lens", "tessar-100mm-f2.8", "--fov", "40"}, "--fov"},
        {{"--lens", "tessar-100mm-f2.8", "--focus", "0.01m"}, "--focus"},
        {{"--lens", "tessar-100mm-f2.8", "--focus", "3m", "--aperture", "blob"}, "blob"},
    };
    for (const auto& [words, part] : cases) {
        const Finished refused = run(words);
        EXPECT_NE(refused.exit_code, 0) << part;
        EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
    }
    const Finished wide = run({"--lens", "tessar-100mm-f2.8", "--fstop", "1", "--focus", "3m"});
    EXPECT_EQ(wide.exit_code, 0) << wide.err;
    EXPECT_NE(wide.err.find("opens to f/"), std::string::npos) << wide.err;
}

// Stopped down, focused far away and scaled to the camera's angle of view a lens sees what a
// pinhole sees.
TEST_F(CliLens, FitsTheAngleOfView) {
    const std::string walls_file = walls().save_gltf(folder_.path / "walls.gltf").string();
    const auto picture = [&](const Words& more) {
        Words words = {"--look-at",    "-0.4,0,0,-0.4,0,-1",
                       "--background", "1,1,1",
                       "--size",       "144x96",
                       "--spp",        "16",
                       "-o",           path("out.exr")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished done = run_petzval(render_words(words, walls_file));
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return read_picture(path("out.exr"));
    };
    // How many pixels of the middle rows the near wall fills: those nearer to it than to the other.
    const auto width_px = [&](const Picture& p) {
        const auto at = [&](int x) {
            double sum = 0;
            for (int y = 40; y < 56; ++y) sum += value_at(p, x, y, "R");
            return sum;
        };
        const double half = (at(72) + at(20)) / 2;
        int width = 0;
        for (int x = 16; x < 128; ++x) width += at(x) > half;
        return width;
    };
    const double expected = 96 * 0.2 / std::tan(13 * M_PI / 180);
    EXPECT_NEAR(width_px(picture({"--fov", "26"})), expected, 1.5);
    const Words lens = {"--lens", "biotar-58mm-f1.4", "--chroma", "shared", "--fstop",
                        "16",     "--focus",          "1000"};
    Words fitted = lens;
    fitted.insert(fitted.end(), {"--fit", "fov", "--fov", "26"});
    const Picture p = picture(fitted);
    EXPECT_NEAR(width_px(p), expected, 1.5);
    EXPECT_NEAR(std::stof(metadata_of(p, "petzval:fov_deg")), 26, 1e-3);
    EXPECT_GT(width_px(picture(lens)), expected + 5);
    fitted.back() = "100";
    const Finished wide = run(fitted);
    EXPECT_EQ(wide.exit_code, 2);
    EXPECT_NE(wide.err.find("does not see 100 degrees"), std::string::npos) << wide.err;
}

// The spot of a fast lens is smallest in front of where rays near the axis meet.
TEST_F(CliLens, FocusByTracedRaysMovesTheFilm) {
    const auto film_mm = [&](const char* by) {
        const Picture p = flat({"--lens", "double-gauss-100mm-f2", "--focus-by", by});
        return std::stof(metadata_of(p, "petzval:film_mm"));
    };
    EXPECT_NEAR(film_mm("traced") - film_mm("paraxial"), -0.38, 0.02);
}

}  // namespace
}  // namespace petzval
