// SPDX-License-Identifier: Apache-2.0
// The rungs below a prescription: pinhole, thin lens and singlet, their irises, their exposure, and
// what a camera of the file asks for.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "camera/models/thin_lens_optics.h"
#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
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
    [[nodiscard]] io::Picture picture_of(const std::string& scene, const Words& more) {
        const Finished done = finished(scene, more);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return io::read_picture(path("out.exr"));
    }
    [[nodiscard]] std::string refusal(const Words& more) { return refusal(scene_, more); }
    [[nodiscard]] std::string refusal(const std::string& scene, const Words& more) {
        const Finished done = finished(scene, more);
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
    const io::Picture a = picture_of(full, {}), b = picture_of(plain, spoken);
    EXPECT_EQ(a.pixels, b.pixels);
    EXPECT_EQ(metadata_of(a, "petzval:aperture"), "polygon:6,10");
    // What the user says wins, wish by wish.
    const io::Picture c = picture_of(full, {"--aperture", "circle", "--focus", "3"});
    const io::Picture d = picture_of(plain, {"--lens", "tessar-100mm-f2.8", "--fstop", "4",
                                             "--focus", "3", "--sensor", "30x20"});
    EXPECT_EQ(c.pixels, d.pixels);
    EXPECT_NE(c.pixels, a.pixels);
    const io::Picture pinhole = picture_of(full, {"--lens", "pinhole"});
    EXPECT_EQ(pinhole.pixels, picture_of(plain, {"--sensor", "30x20"}).pixels);
    const io::Picture thin = picture_of(full, {"--lens", "thin"});
    EXPECT_EQ(thin.pixels, picture_of(plain, {"--fstop", "4", "--focus", "2", "--aperture",
                                              "polygon:6,10", "--sensor", "30x20"})
                               .pixels);
    // A radius goes with a thin lens, not with the file's lens of glass.
    EXPECT_NE(finished(full, {"--method", "lens-radius=0.02"}).err.find("leave out"),
              std::string::npos);
    const io::Picture radius = picture_of(full, {"--lens", "thin", "--method", "lens-radius=0.02"});
    EXPECT_EQ(radius.pixels, picture_of(plain, {"--method", "lens-radius=0.02", "--focus", "2",
                                                "--aperture", "polygon:6,10", "--sensor", "30x20"})
                                 .pixels);
    const std::string none = scene_with("none.gltf", {{"lens", "lens/none.json"}});
    const Finished lost = finished(none, {});
    EXPECT_EQ(lost.exit_code, 1);
    EXPECT_NE(lost.err.find("none.gltf: extras.petzval of camera \"wide\": "), std::string::npos)
        << lost.err;
    EXPECT_NE(lost.err.find("/lens/none.json: is neither a file nor a lens"), std::string::npos)
        << lost.err;
}

TEST_F(CliCamera, ExtrasGiveWayToWhatTheUserFixes) {
    // A camera that has no iris has no use for its focus, until the user gives it one.
    const std::string focus = scene_with("focus.gltf", {{"focus_m", 2}, {"aperture", "square"}});
    const std::string plain = scene_with("plain.gltf", nlohmann::json::object());
    EXPECT_EQ(picture_of(focus, {}).pixels, picture_of(plain, {}).pixels);
    EXPECT_EQ(picture_of(focus, {"--fstop", "2"}).pixels,
              picture_of(plain, {"--fstop", "2", "--focus", "2", "--aperture", "square"}).pixels);
    // A film and a focal length say what is in focus.
    const Words fixed = {"--fstop", "2", "--method", "film-distance=52", "--focal-length", "50"};
    EXPECT_EQ(picture_of(focus, fixed).pixels,
              picture_of(plain,
                         [&] {
                             Words words = fixed;
                             words.insert(words.end(), {"--aperture", "square"});
                             return words;
                         }())
                  .pixels);
}

TEST_F(CliCamera, ExtrasThatAreNone) {
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
    // Pixels beside the middle are a little darker through real lenses: that is measured apart.
    const Words even = {"--method", "natural-vignetting=off"};
    const auto with = [&](Words more) {
        more.insert(more.end(), exposed.begin(), exposed.end());
        if (std::find(more.begin(), more.end(), "double-gauss-100mm-f2") == more.end())
            more.insert(more.end(), even.begin(), even.end());
        return green(more);
    };
    const double film_mm = camera::image_distance_mm(50, 1000), radius_mm = 50 / 4.;
    const double sine = std::sin(std::atan(radius_mm / film_mm));
    const double expected = std::numbers::pi * sine * sine * 100 / 50 * 200 / 78;
    EXPECT_NEAR(with({"--focal-length", "50", "--fstop", "2", "--focus", "1"}) / expected, 1, 1e-4);
    EXPECT_NEAR(
        with({"--focal-length", "50", "--fstop", "2", "--focus", "1", "--aperture", "triangle"}) /
            expected,
        1, 1e-4);
    // Inside the round stop a triangle has 3 sqrt 3 / (4 pi) of its area.
    EXPECT_NEAR(with({"--focal-length", "50", "--fstop", "2", "--focus", "1", "--aperture",
                      "triangle", "--method", "aperture-scale=inscribed"}) /
                    expected,
                3 * std::sqrt(3.) / (4 * std::numbers::pi), 1e-4);
    EXPECT_NEAR(green({"--focal-length", "50", "--fstop", "2", "--focus", "1"}), 100, 1e-2);
    const double slow = std::sin(std::atan(50 / 16. / film_mm));
    EXPECT_NEAR(with({"--lens", "singlet:schott:N-BK7", "--method", "dispersion=shared",
                      "--focal-length", "50", "--fstop", "8", "--focus", "1"}) /
                    (expected * sqr(slow / sine)),
                1, 1e-4);
    // A lens of glass at the same f-number, focused far away: a thin lens without its bellows.
    const double far = std::numbers::pi / 16 * 100 / 50 * 200 / 78;
    EXPECT_NEAR(with({"--lens", "double-gauss-100mm-f2", "--fstop", "2.8", "--focus", "1000",
                      "--method", "dispersion=shared", "--spp", "1024"}) /
                    far,
                sqr(2 / 2.8), 0.03);
}

// Corners against the middle, in an even scene: cos^4 for a pinhole, Foote's closed form behind a
// round stop. On by itself in photographic exposure only.
TEST_F(CliCamera, CornersDarkenAsTheyDoBehindAStop) {
    const auto corner_over_middle = [&](Words words) {
        words.insert(words.end(), {"--look-at", "0,0,5,0,0,6", "--background", "100,100,100",
                                   "--size", "33x21", "--spp", "64"});
        const io::Picture p = picture_of(scene_, words);
        return double(value_at(p, 0, 0, "G")) / double(value_at(p, 16, 10, "G"));
    };
    const auto foote = [](double radius_mm, double distance_mm, double off_mm) {
        const double h2 = distance_mm * distance_mm, r2 = off_mm * off_mm;
        const double a2 = radius_mm * radius_mm, sum = h2 + r2 + a2;
        return 0.5 * (1 - (h2 + r2 - a2) / std::sqrt(sum * sum - 4 * r2 * a2));
    };
    // The corner pixel's middle on a film 36 mm wide.
    const double off_mm = 36. / 33 * std::hypot(16., 10.);
    const double film_mm = camera::image_distance_mm(28, 1000);
    const Words photographic = {"--exposure-mode", "photographic"};
    for (const std::string lens : {"thin", "singlet:schott:N-BK7"})
        for (const double fstop : {4., 8.}) {
            const Words words = {
                "--lens", lens,      "--focal-length",         "28",       "--focus",
                "1",      "--fstop", fmt::format("{}", fstop), "--method", "dispersion=shared"};
            const double radius_mm = 28 / (2 * fstop);
            const double expected =
                foote(radius_mm, film_mm, off_mm) / foote(radius_mm, film_mm, 0);
            ASSERT_LT(expected, 0.6);
            const auto with = [&](const Words& more) {
                Words all = words;
                all.insert(all.end(), more.begin(), more.end());
                return corner_over_middle(all);
            };
            EXPECT_NEAR(with(photographic) / expected, 1, 0.005) << lens << fstop;
            EXPECT_NEAR(with({"--method", "natural-vignetting=on"}) / expected, 1, 0.005);
            EXPECT_NEAR(
                with({"--exposure-mode", "photographic", "--method", "natural-vignetting=off"}), 1,
                1e-5);
            EXPECT_NEAR(with({}), 1, 1e-5);
        }
    const double half = std::tan(30 * std::numbers::pi / 180);  // --fov 60
    const double tangent = half * 2 / 21 * std::hypot(16., 10.);
    EXPECT_NEAR(corner_over_middle({"--fov", "60", "--method", "natural-vignetting=on"}) *
                    sqr(1 + tangent * tangent),
                1, 0.01);
    EXPECT_NEAR(corner_over_middle({"--fov", "60"}), 1, 1e-6);
}

// An object in the focal plane has no image, in whatever digits it is said.
TEST_F(CliCamera, TheFocalLengthIsTooNear) {
    for (const auto& [focal, focus] :
         {std::pair{"50", "0.05"}, {"35.1", "0.0351"}, {"85", "0.085"}, {"24.3", "0.0243"}})
        for (const char* lens : {"thin", "singlet:schott:N-BK7"})
            EXPECT_NE(
                refusal({"--lens", lens, "--fstop", "8", "--focal-length", focal, "--focus", focus})
                    .find("within the focal length"),
                std::string::npos)
                << lens << ' ' << focal;
}

// Of film distance, distance in focus and focal length any two give the third.
TEST_F(CliCamera, TwoDistancesGiveTheThird) {
    const double film_mm = camera::image_distance_mm(50, 1500);
    const std::string film = fmt::format("{:.9g}", film_mm);
    const Words view = {"--look-at", "0,0,0,0,0,-1", "--fstop", "1.4"};
    const auto picture = [&](Words more) {
        more.insert(more.begin(), view.begin(), view.end());
        return picture_of(scene_, more);
    };
    const io::Picture expected = picture({"--focal-length", "50", "--focus", "1.5"});
    const auto expect_same = [&](const io::Picture& p) {
        for (size_t i = 0; i < p.pixels.size(); ++i)
            ASSERT_NEAR(p.pixels[i], expected.pixels[i], 2e-4f) << i;
    };
    expect_same(picture({"--focal-length", "50", "--method", "film-distance=" + film}));
    expect_same(picture({"--focus", "1.5", "--method", "film-distance=" + film}));
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

// A flat back is the front of the lens turned round: as bendings 1 and -1.
TEST_F(CliCamera, TheFirstRadiusFacesTheScene) {
    const double radius_mm = 100 * (1.5168 - 1);
    const auto picture = [&](const std::string& lens, Words more) {
        more.insert(more.end(), {"--lens", "singlet:schott:N-BK7," + lens, "--fstop", "5", "--fov",
                                 "1", "--focus", "1", "--method", "dispersion=shared", "--look-at",
                                 "-0.2,0,0,-0.2,0,-1", "--spp", "64"});
        return picture_of(scene_, more);
    };
    const auto error_of = [&](const io::Picture& a, const io::Picture& b) {
        double sum = 0;
        for (size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::fabs(double(a.pixels[i]) - double(b.pixels[i]));
        return sum / double(a.pixels.size());
    };
    const io::Picture front = picture(fmt::format("{:.9g},inf", radius_mm), {});
    const io::Picture back = picture(fmt::format("inf,{:.9g}", -radius_mm), {});
    const io::Picture bent = picture("1", {"--focal-length", "100"});
    const io::Picture turned = picture("-1", {"--focal-length", "100"});
    EXPECT_LT(error_of(front, bent), 1e-5);
    EXPECT_LT(error_of(back, turned), 1e-5);
    EXPECT_GT(error_of(front, back), 1e-3);
    // Without a number it is equiconvex.
    const auto plain = [&](const char* lens) {
        return picture_of(scene_, {"--lens", lens, "--fstop", "5", "--focal-length", "100",
                                   "--focus", "1", "--method", "dispersion=shared"});
    };
    EXPECT_EQ(plain("singlet:schott:N-BK7").pixels, plain("singlet:schott:N-BK7,0").pixels);
}

TEST_F(CliCamera, ASharedRayNeedsNoWavelengths) {
    const Words lens = {"--lens",  "singlet:schott:N-BK7", "--fstop", "8", "--focus", "2",
                        "--method"};
    const auto err = [&](const char* dispersion) {
        Words words = lens;
        words.push_back("dispersion=" + std::string(dispersion));
        const Finished done = finished(scene_, words);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done.err;
    };
    EXPECT_NE(err("auto").find("spectral: wavelengths"), std::string::npos);
    EXPECT_NE(err("shared").find("spectral: rgb"), std::string::npos);
}

TEST_F(CliCamera, DispersionModesCastTheirRays) {
    for (const std::string& lens :
         {std::string("singlet:schott:N-BK7"), std::string("kodak-petzval-100mm-f2")})
        for (const auto& [mode, least, most] :
             {std::tuple{"split", 3.7, 4.}, {"hero", 0.9, 1.}, {"shared", 0.9, 1.}}) {
            Words words = {"--lens",   lens,
                           "--fstop",  "4",
                           "--focus",  "2",
                           "--sensor", "30x20",
                           "--size",   "60x40",
                           "--stats",  path("s.json"),
                           "--method", "dispersion=" + std::string(mode)};
            if (lens.starts_with("singlet")) words.insert(words.end(), {"--focal-length", "100"});
            const Finished done = finished(scene_, words);
            EXPECT_EQ(done.exit_code, 0) << done.err;
            const auto s = nlohmann::json::parse(file_bytes(path("s.json")));
            const double rays =
                s["rays"]["camera"].get<double>() / s["pixel_samples"].get<double>();
            EXPECT_GE(rays, least) << lens << ' ' << mode;
            EXPECT_LE(rays, most) << lens << ' ' << mode;
        }
}

TEST_F(CliCamera, RefusesWhatHasNoEffect) {
    const Words thin = {"--lens", "thin", "--fstop", "2", "--focus", "1"};
    const Words singlet = {"--lens", "singlet:schott:N-BK7", "--fstop", "8", "--focus", "1"};
    const Words pinhole = {"--lens", "pinhole"};
    const std::pair<std::string, std::string> surfaces[] = {{"coating", "uncoated"},
                                                            {"lens-precision", "double"},
                                                            {"focus-by", "traced"},
                                                            {"fit", "fov"}};
    for (const Words& camera : {thin, singlet, pinhole})
        for (const auto& [method, value] : surfaces) {
            Words words = camera;
            words.insert(words.end(), {"--method", method + "=" + value});
            const std::string err = refusal(words);
            EXPECT_NE(err.find("--method " + method + ": needs a lens that is traced"),
                      std::string::npos)
                << err;
        }
    const std::pair<Words, std::string> cases[] = {
        {{"--method", "iris-sampling=rejection"}, "--method iris-sampling: a pinhole has no iris"},
        {{"--method", "aperture-scale=inscribed"},
         "--method aperture-scale: a pinhole has no iris"},
        {{"--exposure-mode", "normalised", "--iso", "400"}, "but with photographic"},
        {{"--exposure-mode", "normalised", "--shutter", "1/50"}, "but with --at"},
        {{"--lens", "tessar-100mm-f2.8", "--method", "natural-vignetting=on"},
         "always has its own"},
        {{"--camera", "plan", "--method", "natural-vignetting=on"}, "is orthographic"},
        {{"--camera", "plan", "--focus", "2"}, "is orthographic"},
        {{"--camera", "plan", "--aperture", "square"}, "is orthographic"},
        {{"--camera", "plan", "--method", "film-distance=50"}, "is orthographic"},
        {{"--camera", "plan", "--sensor", "36x24"}, "is orthographic"}};
    for (const auto& [words, part] : cases) {
        const std::string err = refusal(words);
        EXPECT_NE(err.find(part), std::string::npos) << err;
    }
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
        {{"--lens", "singlet:schott:N-BK7,0mm,-5mm", "--fstop", "4"}, "a radius is 0"},
        {{"--lens", "singlet:schott:N-BK7,1mm", "--fstop", "4"}, "the bending has no unit"},
        {{"--lens", "singlet:schott:N-BK7,1,2,3", "--fstop", "4"}, "too many numbers"},
        {{"--lens", "singlet:schott:N-BK7,50,", "--fstop", "4"}, "nothing follows the last comma"},
        {{"--lens", "singlet:F2", "--fstop", "4"}, "several makers: say which of cdgm:F2"},
        {{"--lens", "singlet:schott:N-BK7,-50,50", "--fstop", "4"}, "gather"},
        {{"--lens", "singlet:schott:N-BK7,50,-50", "--fstop", "4", "--focal-length", "5"},
         "follows from the radii"},
        {{"--lens", "singlet:schott:N-BK7,1", "--fstop", "0.7", "--focus", "1"}, "too wide"},
        {{"--fstop", "2", "--focal-length", "50", "--method", "film-distance=40"},
         "within the focal length"},
        {{"--fstop", "2", "--focal-length", "50", "--focus", "0.04"}, "within the focal length"},
        {{"--fstop", "2", "--method", "film-distance=50", "--fov", "20"}, "--fov"},
        {{"--fstop", "2", "--method", "film-distance=52", "--focal-length", "50", "--focus", "1"},
         "follows from --method film-distance"},
        {{"--lens", "tessar-100mm-f2.8", "--method", "lens-radius=0.1"}, "--method lens-radius"},
        {{"--shutter", "1/0", "--exposure-mode", "photographic"}, "--shutter"},
        {{"--fstop", "2", "--focus", "1", "--aperture", "star:2"}, "star"}};
    for (const auto& [words, part] : cases)
        EXPECT_NE(refusal(words).find(part), std::string::npos) << part << " by " << words[1];
}

}  // namespace
}  // namespace petzval::apps
