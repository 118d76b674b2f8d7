// SPDX-License-Identifier: Apache-2.0
// Renders through lenses of glass, by the program.
#include <cmath>
#include <numbers>

#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliLens : public CliTest {
  protected:
    CliLens() { scene_ = TinyGltf().save_gltf(folder_.path / "empty.gltf").string(); }
    /// A uniform world of 1 nit through a lens.
    [[nodiscard]] io::Picture flat(const Words& more) {
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

float middle(const io::Picture& p, const char* channel) {
    double sum = 0;
    for (int y = 8; y < 12; ++y)
        for (int x = 12; x < 18; ++x) sum += value_at(p, x, y, channel);
    return static_cast<float>(sum / 24);
}

// Whatever the lens, its f-number and its iris: what fills the world with 1 shows as 1 in the
// middle.
TEST_F(CliLens, MidGreyIsMidGreyThroughEveryLens) {
    for (const Words& words :
         {Words{"--lens", "double-gauss-100mm-f2"},
          Words{"--lens", "double-gauss-100mm-f2", "--fstop", "8", "--aperture", "star:5"},
          Words{"--lens", "schneider-anamorphic-31mm", "--method", "dispersion=shared"},
          Words{"--lens", "tessar-100mm-f2.8", "--method", "dispersion=hero"}}) {
        const io::Picture p = flat(words);
        for (const char* c : {"R", "G", "B"})
            EXPECT_NEAR(middle(p, c), 1.f, 0.06f) << words[1] << ' ' << c;
        EXPECT_EQ(metadata_of(p, "petzval:lens"), words[1]);
    }
}

// The same words mean the same place, also where a group that focuses moves the entrance pupil.
TEST_F(CliLens, FocusMeansTheSameForRenderAndForTheBench) {
    const std::pair<const char*, const char*> cases[] = {
        {"nikkor-400mm-f2.8-fl", "8"},        {"nikkor-400mm-f2.8-fl", "infinity"},
        {"takumar-50mm-f1.2", "0.8m"},        {"takumar-50mm-f1.2", "infinity"},
        {"nikkor-retrofocus-28mm-f2.8", "1"}, {"double-gauss-100mm-f2", "2.5m"}};
    for (const auto& [lens, focus] : cases)
        for (const std::string by : {"paraxial", "traced"}) {
            if (by == "traced" && std::string(focus) != "infinity") continue;
            const io::Picture p =
                render({"--lens", lens, "--focus", focus, "--method", "focus-by=" + std::string(by),
                        "--background", "1,1,1", "--look-at", "0,0,0,0,0,-1", "--spp", "1",
                        "--spectral", "rgb"});
            const Finished bench = run_petzval(
                {"lens", "spot", lens, "--focus", focus, "--focus-by", by, "-o", path("spot.svg")});
            ASSERT_EQ(bench.exit_code, 0) << bench.err;
            // "film at 86.347998 mm"
            const double film_mm = std::stod(bench.out.substr(std::string("film at ").size()));
            EXPECT_NEAR(std::stod(metadata_of(p, "petzval:film_mm")), film_mm, 2e-5 * film_mm)
                << lens << ' ' << focus << ' ' << by;
        }
    // Neither focuses nearer than the lens can, nor takes other words.
    for (const auto& [lens, focus] : std::initializer_list<std::pair<const char*, const char*>>{
             {"nikkor-400mm-f2.8-fl", "3"},
             {"takumar-50mm-f1.2", "infinite"},
             {"takumar-50mm-f1.2", "0"},
             {"takumar-50mm-f1.2", "1mm"}}) {
        EXPECT_EQ(run({"--lens", lens, "--focus", focus}).exit_code, 2) << focus;
        static_cast<void>(
            error_of({"lens", "spot", lens, "--focus", focus, "-o", path("a.svg")}, 2));
    }
}

// A thin lens at infinity sees distant things as a pinhole does.
TEST_F(CliLens, AThinLensFocusesAtInfinity) {
    const Words at = {"--look-at", "0,0,0,0,0,-1", "--background", "1,1,1"};
    for (const char* lens : {"thin", "singlet:schott:N-BK7"}) {
        Words words = {"--lens", lens, "--fstop", "8", "--focus", "infinity"};
        words.insert(words.end(), at.begin(), at.end());
        const io::Picture p = render(words);
        EXPECT_EQ(metadata_of(p, "petzval:focus_m"), "inf") << lens;
        for (const float v : p.pixels) ASSERT_TRUE(std::isfinite(v)) << lens;
    }
}

TEST_F(CliLens, CornersAreDarkerAndOpaque) {
    const io::Picture p = flat({"--lens", "takumar-50mm-f1.2", "--method", "dispersion=shared"});
    EXPECT_LT(value_at(p, 0, 0, "G"), 0.4f);
    EXPECT_GT(value_at(p, 0, 0, "G"), 0.1f);
    EXPECT_EQ(value_at(p, 0, 0, "A"), 1.f);
}

// What is laid under a transparent picture is darkened as the lens darkens the sky.
TEST_F(CliLens, AlphaIsWhatTheLensKeepsBack) {
    const Words lens = {"--lens", "takumar-50mm-f1.2", "--method", "dispersion=shared"};
    Words photographic = lens;
    photographic.insert(photographic.end(), {"--exposure-mode", "photographic", "--iso", "400"});
    for (const Words& words : {lens, photographic}) {
        Words clear = words;
        clear.emplace_back("--transparent");
        const io::Picture sky = flat(words), under = flat(clear);
        const float white = value_at(sky, 15, 10, "G");
        for (const V2i& at : {V2i(0, 0), V2i(4, 9), V2i(15, 10)})
            EXPECT_NEAR(value_at(under, at.x, at.y, "A"),
                        1 - value_at(sky, at.x, at.y, "G") / white, 0.01)
                << at.x;
        EXPECT_GT(value_at(under, 0, 0, "A"), 0.6f);
    }
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
        return io::read_picture(path("out.exr"));
    };
    // How many pixels of the middle rows the near wall fills: those nearer to it than to the other.
    const auto width_px = [&](const io::Picture& p) {
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
    const double expected = 96 * 0.2 / std::tan(13 * std::numbers::pi / 180);
    EXPECT_NEAR(width_px(picture({"--fov", "26"})), expected, 1.5);
    const Words lens = {"--lens", "biotar-58mm-f1.4", "--method", "dispersion=shared", "--fstop",
                        "16",     "--focus",          "1000"};
    Words fitted = lens;
    fitted.insert(fitted.end(), {"--method", "fit=fov", "--fov", "26"});
    const io::Picture p = picture(fitted);
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
        const io::Picture p =
            flat({"--lens", "double-gauss-100mm-f2", "--method", "focus-by=" + std::string(by)});
        return std::stof(metadata_of(p, "petzval:film_mm"));
    };
    EXPECT_NEAR(film_mm("traced") - film_mm("paraxial"), -0.38, 0.02);
}

// A lens that bends all wavelengths alike: index 1.5, f = 100 mm.
const char* const kGrey = R"({"name": "grey", "image_circle": 43.27, "surfaces": [
    {"radius": 100, "thickness": 0.5, "medium": {"n": 1.5}, "semi_diameter": 7},
    {"radius": -100, "thickness": 0, "medium": null, "semi_diameter": 7},
    {"radius": null, "thickness": 99, "medium": null, "semi_diameter": 6.25, "stop": true}]})";

TEST_F(CliLens, GlassReflectsWhereItIsAskedTo) {
    const std::string lens = text_file("grey.json", kGrey);
    const auto grey = [&](const char* coating) {
        return double(middle(flat({"--lens", lens, "--method", "coating=" + std::string(coating),
                                   "--ghosts", "off", "--fstop", "16"}),
                             "G"));
    };
    const double ideal = grey("ideal"), film = sqr((1.5 - 1.38 * 1.38) / (1.5 + 1.38 * 1.38));
    EXPECT_NEAR(ideal, 1, 2e-3);
    EXPECT_NEAR(grey("uncoated") / ideal, sqr(1 - 0.04), 2e-4);
    // At line d a quarter wave of 550 nm is a little thin.
    const double phase = std::numbers::pi * 550 / 587.5618, a = -0.38 / 2.38, b = -0.12 / 2.88;
    const double both = 2 * a * b * std::cos(phase);
    const double reflected = (a * a + b * b + both) / (1 + sqr(a * b) + both);
    EXPECT_GT(reflected, film);
    EXPECT_NEAR(grey("mgf2") / ideal, sqr(1 - reflected), 2e-4);
}

TEST_F(CliLens, DoublesAreAskedForAndAgree) {
    const std::string walls_file = walls().save_gltf(folder_.path / "walls.gltf").string();
    const auto picture = [&](const char* trace) {
        scene_ = walls_file;
        return render({"--lens", "double-gauss-100mm-f2", "--method",
                       "lens-precision=" + std::string(trace), "--background", "1,1,1", "--look-at",
                       "-0.4,0,0,-0.4,0,-1", "--focus", "1", "--spp", "64"});
    };
    const io::Picture in_floats = picture("float"), in_doubles = picture("double");
    EXPECT_NE(in_floats.pixels, in_doubles.pixels);
    double sum = 0;
    for (size_t i = 0; i < in_floats.pixels.size(); ++i)
        sum += std::fabs(double(in_floats.pixels[i]) - double(in_doubles.pixels[i]));
    EXPECT_LT(sum / double(in_floats.pixels.size()), 2e-3);
}

TEST_F(CliLens, AFilmLargerThanTheImageCircleIsSaid) {
    const Words lens = {"--lens", "tessar-100mm-f2.8", "--focus", "3", "--sensor"};
    const auto err = [&](const char* sensor) {
        Words words = lens;
        words.emplace_back(sensor);
        const Finished done = run(words);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done.err;
    };
    EXPECT_NE(err("120x120").find("covers a circle of 86.5 mm; the film's corners are 170 mm "),
              std::string::npos);
    EXPECT_EQ(err("36x24").find("covers"), std::string::npos);
}

// The picture is not that of a thin lens: a wall's edge is where the fisheye shows it.
TEST_F(CliLens, FocusIsOnWhatThePixelShows) {
    scene_ = walls().save_gltf(folder_.path / "walls.gltf").string();
    const Words lens = {"--lens",    "minolta-fisheye-16mm-f2.8",
                        "--look-at", "0,0,0,0,0,-1",
                        "--size",    "180x120",
                        "--crop",    "0,60,180,1",
                        "--method",  "dispersion=shared",
                        "--focus"};
    Words seen = lens;
    seen.insert(seen.end(), {"1", "--fstop", "22", "--aov", "position", "--spp", "16"});
    const io::Picture p = render(seen);
    int edge = 0;
    while (edge < 90 && std::fabs(value_at(p, edge, 0, "position.Z") + 1) > 0.01f) ++edge;
    ASSERT_GT(edge, 20);
    ASSERT_LT(edge, 80);
    const auto focused_on = [&](int x) {
        Words words = lens;
        words.insert(words.end(), {std::to_string(x) + ",60", "-o", path("out.exr")});
        return run_petzval(render_words(words, scene_));
    };
    const Finished wall = focused_on(edge + 2), nothing = focused_on(edge - 3);
    EXPECT_EQ(wall.exit_code, 0) << wall.err;
    EXPECT_NEAR(std::stof(metadata_of(io::read_picture(path("out.exr")), "petzval:focus_m")), 1,
                1e-4);
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_NE(nothing.err.find("nothing to focus on under pixel"), std::string::npos);
    EXPECT_NE(nothing.err.find("give --focus in metres, or a pixel"), std::string::npos)
        << nothing.err;
}

// Lanes that left the film went out or were lost to a cause; a thin lens has none to lose.
TEST_F(CliLens, StatsTellWhatBecameOfTheLanes) {
    const auto lanes = [&](const Words& more) {
        Words words = {"--stats", path("s.json")};
        words.insert(words.end(), more.begin(), more.end());
        (void)flat(words);
        return nlohmann::json::parse(file_bytes(path("s.json"))).at("lens_lanes");
    };
    const int samples = 30 * 20 * 256;
    const auto sum = [](const nlohmann::json& l) {
        int all = 0;
        for (const auto& [key, count] : l.items())
            if (key != "drawn") all += count.get<int>();
        return all;
    };
    const std::pair<Words, int> cases[] = {
        {{"--lens", "takumar-50mm-f1.2", "--method", "dispersion=split"}, 4},
        {{"--lens", "takumar-50mm-f1.2", "--method", "dispersion=hero"}, 1},
        {{"--lens", "takumar-50mm-f1.2", "--method", "dispersion=shared"}, 3},
        {{"--lens", "takumar-50mm-f1.2", "--method", "dispersion=split", "--method",
          "lens-precision=double"},
         4}};
    for (const auto& [words, each] : cases) {
        const nlohmann::json l = lanes(words);
        EXPECT_EQ(l.size(), 6u);
        EXPECT_EQ(l.at("drawn"), samples * each);
        EXPECT_EQ(sum(l), samples * each) << l;
        EXPECT_GT(l.at("vignetted"), samples * each / 10);
        EXPECT_GT(l.at("passed"), samples * each / 2);
    }
    const nlohmann::json wide = lanes(
        {"--lens", "canon-14mm-f2.8-asph", "--method", "dispersion=shared", "--sensor", "45x30"});
    for (const char* cause : {"vignetted", "totally_reflected", "missed"})
        EXPECT_GT(wide.at(cause), 0) << cause;
    EXPECT_EQ(sum(wide), wide.at("drawn"));
    const nlohmann::json beyond = lanes({"--lens", "double-gauss-100mm-f2", "--method",
                                         "dispersion=shared", "--sensor", "300x200"});
    EXPECT_GT(beyond.at("unreached"), samples);
    EXPECT_TRUE(lanes({"--lens", "thin", "--fstop", "2"}).is_null());
}

}  // namespace
}  // namespace petzval::apps
