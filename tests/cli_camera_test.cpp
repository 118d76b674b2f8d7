// SPDX-License-Identifier: Apache-2.0
// The rungs below a prescription: pinhole, thin lens and singlet, their irises, their exposure, and
// what a camera of the file asks for.
#include <fmt/format.h>

#include <cmath>

#include "camera/thin_lens_optics.h"
#include "tests/support/cli.h"

namespace petzval {
namespace {

class CliCamera : public CliTest {
  protected:
    /// A file with nothing but a camera and its extras.petzval.
    [[nodiscard]] std::string scene_with(const char* name, const nlohmann::json& wishes) {
        TinyGltf file = walls();
        add_perspective(file, "wide", 0.7f);
        file.json["cameras"][0]["extras"]["petzval"] = wishes;
        return file.save_gltf(folder_.path / name).string();
    }
    [[nodiscard]] Finished finished(const std::string& scene, const Words& more) {
        Words words = more;
        words.insert(words.end(), {"-o", path("out.exr")});
        if (std::find(more.begin(), more.end(), "--background") == more.end())
            words.insert(words.end(), {"--background", "1,1,1"});
        return run_petzval(render_words(words, scene));
    }
    [[nodiscard]] Picture picture_of(const std::string& scene, const Words& more) {
        const Finished done = finished(scene, more);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return read_picture(path("out.exr"));
    }
    [[nodiscard]] std::string refusal(const Words& more) {
        const Finished done = finished(scene_, more);
        EXPECT_EQ(done.exit_code, 2) << done.err;
        return done.err;
    }
};

TEST_F(CliCamera, TheFilesCameraIsEnough) {
    const nlohmann::json wishes = {{"lens", "tessar-100mm-f2.8"},
                                   {"fstop", 4},
                                   {"focus_m", 2},
                                   {"aperture", "polygon:6,10"},
                                   {"sensor_mm", {30, 20}}};
    const std::string plain = scene_with("plain.gltf", nlohmann::json::object());
    const std::string full = scene_with("full.gltf", wishes);
    const Words spoken = {"--lens", "tessar-100mm-f2.8", "--fstop",      "4",        "--focus",
                          "2",      "--aperture",        "polygon:6,10", "--sensor", "30x20"};
    const Picture a = picture_of(full, {}), b = picture_of(plain, spoken);
    EXPECT_EQ(a.pixels, b.pixels);
    EXPECT_EQ(metadata_of(a, "petzval:aperture"), "polygon:6,10");
    // What the user says wins, wish by wish.
    const Picture c = picture_of(full, {"--aperture", "circle", "--focus", "3"});
    const Picture d = picture_of(plain, {"--lens", "tessar-100mm-f2.8", "--fstop", "4", "--focus",
                                         "3", "--sensor", "30x20"});
    EXPECT_EQ(c.pixels, d.pixels);
    EXPECT_NE(c.pixels, a.pixels);
    const Picture pinhole = picture_of(full, {"--lens", "pinhole"});
    EXPECT_EQ(pinhole.pixels, picture_of(plain, {"--sensor", "30x20"}).pixels);
    const Picture thin = picture_of(full, {"--lens", "thin"});
    EXPECT_EQ(thin.pixels, picture_of(plain, {"--fstop", "4", "--focus", "2", "--aperture",
                                              "polygon:6,10", "--sensor", "30x20"})
                               .pixels);
}

TEST_F(CliCamera, WishesThatAreNone) {
    const std::pair<nlohmann::json, std::string> cases[] = {
        {{{"lens", 5}}, "/cameras/0/extras/petzval/lens"},
        {{{"fstop", 0}}, "/cameras/0/extras/petzval/fstop"},
        {{{"focus_m", -1}}, "/cameras/0/extras/petzval/focus_m"},
        {{{"sensor_mm", {36}}}, "/cameras/0/extras/petzval/sensor_mm"},
        {{{"aperture", ""}}, "/cameras/0/extras/petzval/aperture"},
        {{{"zoom", 2}}, "zoom: is not known; in a camera's extras.petzval there may be lens"}};
    for (const auto& [wishes, words] : cases) {
        const Finished done = finished(scene_with("bad.gltf", wishes), {});
        EXPECT_EQ(done.exit_code, 1);
        EXPECT_NE(done.err.find(words), std::string::npos) << done.err;
    }
}

// 100 nits of sky through f/2 for 1/50 s on ISO 200: pi L / (4 N^2) t ISO / 78, with the angle at
// the film of a lens focused at 1 m.
TEST_F(CliCamera, PhotographicExposureFollowsIrisShutterAndSpeed) {
    const auto green = [&](Words words) {
        words.insert(words.end(), {"--look-at", "0,0,5,0,0,6", "--background", "100,100,100"});
        return double(value_at(picture_of(scene_, words), 3, 2, "G"));
    };
    const Words exposed = {"--exposure-mode", "photographic", "--shutter", "1/50", "--iso", "200"};
    const auto with = [&](Words more) {
        more.insert(more.end(), exposed.begin(), exposed.end());
        return green(more);
    };
    const double film_mm = image_distance_mm(50, 1000), radius_mm = 50 / 4.;
    const double sine = std::sin(std::atan(radius_mm / film_mm));
    const double expected = M_PI * sine * sine * 100 / 50 * 200 / 78;
    EXPECT_NEAR(with({"--focal-length", "50", "--fstop", "2", "--focus", "1"}) / expected, 1, 1e-4);
    EXPECT_NEAR(
        with({"--focal-length", "50", "--fstop", "2", "--focus", "1", "--aperture", "triangle"}) /
            expected,
        1, 1e-4);
    // Inside the round stop a triangle has 3 sqrt 3 / (4 pi) of its area.
    EXPECT_NEAR(with({"--focal-length", "50", "--fstop", "2", "--focus", "1", "--aperture",
                      "triangle", "--aperture-scale", "inscribed"}) /
                    expected,
                3 * std::sqrt(3.) / (4 * M_PI), 1e-4);
    EXPECT_NEAR(green({"--focal-length", "50", "--fstop", "2", "--focus", "1"}), 100, 1e-2);
    // A lens of glass at the same f-number, focused far away: a thin lens without its bellows.
    const double far = M_PI / 16 * 100 / 50 * 200 / 78;
    EXPECT_NEAR(with({"--lens", "double-gauss-100mm-f2", "--fstop", "2.8", "--focus", "1000",
                      "--chroma", "shared", "--spp", "1024"}) /
                    far,
                sqr(2 / 2.8), 0.03);
}

// Of film distance, distance in focus and focal length any two give the third.
TEST_F(CliCamera, TwoDistancesGiveTheThird) {
    const double film_mm = image_distance_mm(50, 1500);
    const std::string film = fmt::format("{:.9g}", film_mm);
    const Words view = {"--look-at", "0,0,0,0,0,-1", "--fstop", "1.4"};
    const auto picture = [&](Words more) {
        more.insert(more.begin(), view.begin(), view.end());
        return picture_of(scene_, more);
    };
    const Picture expected = picture({"--focal-length", "50", "--focus", "1.5"});
    const auto expect_same = [&](const Picture& p) {
        for (size_t i = 0; i < p.pixels.size(); ++i)
            ASSERT_NEAR(p.pixels[i], expected.pixels[i], 2e-4f) << i;
    };
    expect_same(picture({"--focal-length", "50", "--film-distance", film}));
    expect_same(picture({"--focus", "1.5", "--film-distance", film}));
}

TEST_F(CliCamera, ASingletWarnsWhereItsFormulaEnds) {
    const Words lens = {
        "--lens",    "singlet:schott:N-BK7,1", "--focal-length", "50", "--focus", "2",
        "--look-at", "0,0,0,0,0,-1",           "--fstop"};
    const auto err = [&](const char* fstop) {
        Words words = lens;
        words.emplace_back(fstop);
        const Finished done = finished(scene_, words);
        EXPECT_EQ(done.exit_code, 0);
        return done.err;
    };
    EXPECT_EQ(err("8").find("warning"), std::string::npos);
    EXPECT_NE(err("1.4").find("the formula of its spherical aberration is"), std::string::npos);
    EXPECT_NE(err("8").find("as lens singlet:schott:N-BK7,1 disperses"), std::string::npos);
}

TEST_F(CliCamera, RefusesWhatDoesNotGoTogether) {
    const std::pair<Words, std::string> cases[] = {
        {{"--lens", "pinhole", "--fstop", "2"}, "a pinhole has no iris"},
        {{"--aperture", "star:5"}, "a pinhole has no iris"},
        {{"--exposure-mode", "photographic"}, "give --fstop"},
        {{"--lens", "thin"}, "needs --fstop"},
        {{"--lens", "singlet:schott:N-BK7"}, "needs --fstop"},
        {{"--lens", "singlet:schott:N-BK", "--fstop", "4"}, "near are schott:N-BK7"},
        {{"--lens", "singlet:schott:N-BK7,x", "--fstop", "4"}, "\"x\" is no number"},
        {{"--lens", "singlet:schott:N-BK7,0,5", "--fstop", "4"}, "a radius is 0"},
        {{"--lens", "singlet:schott:N-BK7,1,2,3", "--fstop", "4"}, "too many numbers"},
        {{"--lens", "singlet:schott:N-BK7,-50,50", "--fstop", "4"}, "gather"},
        {{"--lens", "singlet:schott:N-BK7,50,-50", "--fstop", "4", "--focal-length", "5"},
         "follows from the radii"},
        {{"--lens", "singlet:schott:N-BK7,1", "--fstop", "0.7", "--focus", "1"}, "too wide"},
        {{"--fstop", "2", "--focal-length", "50", "--film-distance", "40"},
         "within the focal length"},
        {{"--fstop", "2", "--focal-length", "50", "--focus", "0.04"}, "within the focal length"},
        {{"--fstop", "2", "--film-distance", "50", "--fov", "20"}, "--fov"},
        {{"--fstop", "2", "--film-distance", "52", "--focal-length", "50", "--focus", "1"},
         "follows from --film-distance"},
        {{"--lens", "tessar-100mm-f2.8", "--lens-radius", "0.1"}, "--lens-radius"},
        {{"--shutter", "1/0", "--exposure-mode", "photographic"}, "--shutter"},
        {{"--fstop", "2", "--focus", "1", "--aperture", "star:2"}, "star"}};
    for (const auto& [words, part] : cases)
        EXPECT_NE(refusal(words).find(part), std::string::npos) << part << " by " << words[1];
}

}  // namespace
}  // namespace petzval
