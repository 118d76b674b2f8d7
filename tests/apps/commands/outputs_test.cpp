// SPDX-License-Identifier: Apache-2.0
// Outputs: all are tried, none is an input, and what took hours is not lost.
#include <nlohmann/json.hpp>

#include "io/image/picture_files.h"
#include "tests/support/cli.h"
#include "tests/support/open_watch.h"
#include "tests/support/tiny_png.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CliOutputs : public CliTest {
  protected:
    // Files of other runs must not be taken for copies of this one.
    ProcessOptions in_folder_ = [this] {
        ProcessOptions options;
        options.folder = folder_.path;
        return options;
    }();

    static std::vector<std::string> lines_of(const std::string& text) {
        std::vector<std::string> lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) lines.push_back(line);
        return lines;
    }
    void expect_unharmed(const Words& words, const std::string& input, const std::string& part) {
        const std::string before = file_bytes(input);
        ASSERT_FALSE(before.empty());
        const std::string line = error_of(words, 2);
        EXPECT_NE(line.find(part), std::string::npos) << line << "\nwithout: " << part;
        EXPECT_TRUE(file_bytes(input) == before) << input;
    }
    void expect_render_unharmed(Words words, const std::string& input, const std::string& part) {
        if (std::find(words.begin(), words.end(), "-o") == words.end())
            words.insert(words.end(), {"-o", path("out.exr")});
        words.emplace_back("--quiet");
        expect_unharmed(render_words(words, scene_), input, part);
    }
};

// The EXR does not fit under the limit; the PNG and the statistics do.
TEST_F(CliOutputs, OneThatFailsDoesNotLoseTheOthers) {
    in_folder_.file_size_limit_bytes = 20000;
    const Words words = {"-o",      path("a.exr"),  "-o",      path("b.png"), "-o",   path("c.exr"),
                         "--stats", path("s.json"), "--quiet", "--size",      "64x64"};
    const Finished run = run_petzval(render_words(words, scene_), in_folder_);
    EXPECT_EQ(run.exit_code, 3) << run.err;
    const auto lines = lines_of(run.err);
    ASSERT_EQ(lines.size(), 2u) << run.err;
    for (const size_t i : {0, 1}) {
        const std::string name = path(i == 0 ? "a.exr" : "c.exr");
        EXPECT_EQ(lines[i], "petzval: error: " + name +
                                ": cannot be written: File too large; no copy could be kept "
                                "elsewhere either");
    }
    EXPECT_EQ(listing(), (std::set<std::string>{"b.png", "s.json", "studio.glb"}));
    EXPECT_EQ(io::read_picture(path("b.png")).width, 64);
    const json stats = json::parse(file_bytes(path("s.json")));
    ASSERT_EQ(stats.at("outputs").size(), 3u);
    EXPECT_EQ(stats.at("outputs")[0].at("file"), path("a.exr"));
    EXPECT_NE(stats.at("outputs")[0].at("error").get<std::string>().find("File too large"),
              std::string::npos);
    EXPECT_TRUE(stats.at("outputs")[1].at("error").is_null());
    EXPECT_EQ(stats.at("errors").size(), 2u);
}

TEST_F(CliOutputs, StatisticsThatFailDoNotLoseThePicture) {
    const Finished run = run_petzval(
        render_words({"-o", path("a.exr"), "--stats", "/dev/full", "--quiet"}, scene_), in_folder_);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(run.err,
              "petzval: error: /dev/full: cannot be written: No space left on device; a copy is "
              "in " +
                  fs::canonical(folder_.path).string() + "/full.rescue\n");
    EXPECT_EQ(io::read_picture(path("a.exr")).width, 16);
    EXPECT_EQ(json::parse(file_bytes(path("full.rescue"))).at("pixel_samples"), 16 * 16 * 4);
}

TEST_F(CliOutputs, AFolderThatGoesAwayWhileRendering) {
    fs::create_directory(path("sub"));
    fs::create_directory(path("here"));
    in_folder_.folder = path("here");
    Process render(
        render_words({"-o", path("sub/a.exr"), "-o", path("sub/b.png"), "-o", path("c.exr"),
                      "--stats", path("sub/s.json"), "--spp", "100000000", "--progress", "json"},
                     scene_),
        in_folder_);
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));
    fs::remove(path("sub"));
    render.signal(SIGINT);
    const Finished run = render.wait();
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_EQ(io::read_picture(path("here/a.partial.rescue.exr")).width, 16);
    EXPECT_EQ(io::read_picture(path("here/b.partial.rescue.exr")).width, 16);
    EXPECT_EQ(io::read_picture(path("c.partial.exr")).width, 16);
    EXPECT_EQ(json::parse(file_bytes(path("here/s.rescue.json"))).at("stopped_by"), "SIGINT");
    EXPECT_NE(run.err.find("a copy is in " + fs::canonical(path("here")).string() +
                           "/a.partial.rescue.exr"),
              std::string::npos)
        << run.err;
    EXPECT_FALSE(fs::exists(path("sub")));
}

TEST_F(CliOutputs, NoneIsAnInput) {
    io::Picture sky;
    sky.width = sky.full_width = 4;
    sky.height = sky.full_height = 2;
    sky.channels = {"R", "G", "B"};
    sky.pixels.assign(24, 1.f);
    io::write_exr(path("sky.exr"), sky);
    const std::string mask = path("iris.png"), lens = path("lens.json"), white = path("w.csv");
    const auto png = tiny_png(2, 2, std::vector<uint8_t>(16, 255));
    save_bytes(mask, png);
    fs::copy_file(PETZVAL_ASSETS "/lenses/tessar-100mm-f2.8.json", lens);
    fs::copy_file(PETZVAL_ASSETS "/spectra/a.csv", white);
    fs::copy_file(PETZVAL_ASSETS "/spectra/cie1931.csv", path("r.csv"));
    text_file("g.agf", "NM A 2 0 1.5 60 0 0\n");
    fs::create_symlink(path("sky.exr"), path("soft.exr"));
    fs::create_hard_link(path("sky.exr"), path("hard.exr"));
    fs::create_symlink(path("sky.exr"), path("a.partial.exr"));

    const Words env = {"--env", path("sky.exr")};
    const auto with = [&](const Words& more) {
        Words words = env;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const std::string is_env = "-o would overwrite the file of --env";
    for (const std::string& name :
         {path("sky.exr"), path("./sky.exr"), path("soft.exr"), path("hard.exr")})
        expect_render_unharmed(with({"-o", name}), path("sky.exr"), is_env);
    expect_render_unharmed(with({"-o", path("a.png")}), path("sky.exr"),
                           "the picture of a render that is stopped would overwrite");
    expect_render_unharmed({"--stats", scene_}, scene_, "--stats would overwrite the scene");
    expect_render_unharmed({"--lens", lens, "--stats", lens}, lens, "the file of --lens");
    expect_render_unharmed({"--lens", lens, "--aperture", mask, "-o", mask}, mask,
                           "the file of --aperture");
    expect_render_unharmed({"--glasses", path("g.agf"), "--stats", path("g.agf")}, path("g.agf"),
                           "the file of --glasses");
    expect_render_unharmed({"--illuminant", white, "--stats", white}, white,
                           "the file of --illuminant");
    expect_render_unharmed({"--response", path("r.csv"), "--stats", path("r.csv")}, path("r.csv"),
                           "the file of --response");
}

TEST_F(CliOutputs, NoneIsAFileThatTheSceneNames) {
    TinyGltf file = studio();
    save_bytes(folder_.path / "wood.png", tiny_png(2, 2, std::vector<uint8_t>(16, 200)));
    save_bytes(folder_.path / "data.json", file.bin);
    fs::copy_file(PETZVAL_ASSETS "/lenses/tessar-100mm-f2.8.json", path("lens.json"));
    file.json["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", "data.json"}}};
    file.json["images"] = {{{"uri", "wood.png"}}};
    file.json["cameras"][1]["extras"] = {{"petzval", {{"lens", "lens.json"}}}};
    scene_ = file.save_gltf(folder_.path / "files.gltf").string();
    expect_render_unharmed({"-o", path("wood.png")}, path("wood.png"), "a file of the scene");
    expect_render_unharmed({"--stats", path("data.json")}, path("data.json"),
                           "a file of the scene");
    expect_render_unharmed({"--stats", path("lens.json")}, path("lens.json"),
                           "a file of the scene's camera");
}

TEST_F(CliOutputs, NoneIsWrittenTwice) {
    fs::create_directory(path("sub"));
    fs::create_directory_symlink(path("sub"), path("link"));
    fs::create_symlink("b.exr", path("c.exr"));
    const std::string twice = "would overwrite what -o writes";
    expect_refused(2, {{{"-o", path("b.exr"), "-o", path("./b.exr")}, twice},
                       {{"-o", path("b.exr"), "-o", path("c.exr")}, twice},
                       {{"-o", path("sub/b.exr"), "-o", path("link/b.exr")}, twice},
                       {{"-o", path("b.exr"), "--stats", path("sub/../b.exr")}, "--stats " + twice},
                       {{"-o", path("b.exr"), "-o", path("b.partial.exr")}, twice}});
    // Formats of one name share a picture of what was stopped.
    EXPECT_FALSE(render_bytes({"-o", path("b.png"), "-o", path("./b.exr")}, "d.exr").empty());
    // Nothing is lost in a device.
    EXPECT_EQ(
        run_petzval(render_words({"-o", path("e.exr"), "--stats", "/dev/null", "--quiet"}, scene_))
            .exit_code,
        0);
}

TEST_F(CliOutputs, OfOtherCommandsNoneIsAnInput) {
    const std::string lens = path("lens.json"), rays = path("rays.csv");
    fs::copy_file(PETZVAL_ASSETS "/lenses/tessar-100mm-f2.8.json", lens);
    text_file("rays.csv", "x,y,z,dx,dy,dz,nm\n0,0,-10,0,0,1,550\n");
    fs::create_symlink(lens, path("lens.svg"));
    fs::create_symlink(lens, path("lens.csv"));
    save_bytes(folder_.path / "a.png", tiny_png(2, 2, std::vector<uint8_t>(16, 9)));
    const std::string is_lens = "would overwrite the lens";
    expect_unharmed({"lens", "draw", lens, "-o", path("lens.svg")}, lens, is_lens);
    expect_unharmed({"lens", "spot", lens, "-o", path("lens.svg")}, lens, is_lens);
    expect_unharmed({"lens", "mtf", lens, "-o", path("a.svg"), "--csv", path("lens.csv")}, lens,
                    is_lens);
    expect_unharmed({"lens", "mtf", lens, "-o", path("b.svg"), "--csv", path("./b.svg")}, lens,
                    "--csv would overwrite what -o writes");
    expect_unharmed({"lens", "trace", lens, "--rays", rays, "-o", rays}, rays,
                    "the file of --rays");
    expect_unharmed({"lens", "trace", lens, "--rays", rays, "-o", lens}, lens, is_lens);
    expect_unharmed({"image", "view", path("a.png"), "-o", path("./a.png")}, path("a.png"),
                    "the picture to show");
    fs::create_symlink(path("a.png"), path("plot.png"));
    expect_unharmed({"image", "spectrum", path("a.png"), "0,0", "-o", path("plot.png")},
                    path("a.png"), "the picture to read");
}

TEST_F(CliOutputs, AChartSparesItsInputs) {
    fs::create_directories(path("pictures"));
    TinyGltf file = studio();
    save_bytes(folder_.path / "pictures/wood.png", tiny_png(2, 2, std::vector<uint8_t>(16, 200)));
    file.json["images"] = {{{"uri", "pictures/wood.png"}}};
    const std::string scene = file.save_gltf(folder_.path / "files.gltf").string();
    expect_unharmed({"chart", scene, "-o", folder_.path.string(), "--axis", "lights", "--budget",
                     "10s", "--size", "8x8", "--quiet"},
                    path("pictures/wood.png"), "the report would overwrite a file of the scene");
    fs::copy_file(PETZVAL_ASSETS "/spectra/a.csv", path("points.csv"));
    expect_unharmed({"chart", scene_, "-o", folder_.path.string(), "--illuminant",
                     path("points.csv"), "--axis", "lights", "--quiet"},
                    path("points.csv"), "the report would overwrite the file of --illuminant");
}

TEST_F(CliOutputs, APictureThatAFormatCannotHoldIsRefusedBefore) {
    EXPECT_NE(error_of({"render", scene_, "-o", path("a.jpg"), "--size", "65536x1", "--quiet"}, 3)
                  .find("65500 pixels on a side"),
              std::string::npos);
}

TEST_F(CliOutputs, OfALensAPlotThatFailsDoesNotLoseTheTable) {
    in_folder_.file_size_limit_bytes = 3000;
    const Finished run = run_petzval({"lens", "distortion", "tessar-100mm-f2.8", "--field", "5,10",
                                      "-o", path("d.svg"), "--csv", path("d.csv")},
                                     in_folder_);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("d.svg: cannot be written: File too large"), std::string::npos)
        << run.err;
    EXPECT_EQ(listing(), (std::set<std::string>{"d.csv", "studio.glb"}));
}

}  // namespace
}  // namespace petzval::apps
