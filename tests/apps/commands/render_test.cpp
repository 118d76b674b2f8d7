// SPDX-License-Identifier: Apache-2.0
// What each option does, read back from the pictures that the program wrote.
#include "io/image/difference.h"
#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

class Cli : public CliTest {
  protected:
    /// Largest difference of the colours of two renders.
    double difference(const Words& a, const Words& b) {
        return io::compare(render(a, "a.exr"), render(b, "b.exr")).front().max_abs;
    }
    /// An environment that is red where z < 0 (ahead of the cameras) and blue behind.
    std::string red_and_blue() {
        io::Picture sky;
        sky.width = sky.full_width = 8;
        sky.height = sky.full_height = 4;
        sky.channels = {"R", "G", "B"};
        for (int i = 0; i < 32; ++i)
            for (const float v : {i % 8 < 4 ? 1.f : 0.f, 0.f, i % 8 < 4 ? 0.f : 1.f})
                sky.pixels.push_back(v);
        io::write_exr(path("sky.exr"), sky);
        return path("sky.exr");
    }
    static V3f corner(const io::Picture& p) {
        return {value_at(p, 0, 0, "R"), value_at(p, 0, 0, "G"), value_at(p, 0, 0, "B")};
    }
};

TEST_F(Cli, FrameAndSamples) {
    // With lamps alone; and under a sky, whose share a pilot of the whole frame learns.
    for (const Words& light : {Words{}, Words{"--env", red_and_blue()}}) {
        Words words = {"--size", "24x12", "--spp", "3"};
        words.insert(words.end(), light.begin(), light.end());
        const io::Picture whole = render(words, "whole.exr");
        EXPECT_EQ(V2i(whole.width, whole.height), V2i(24, 12));
        EXPECT_EQ(metadata_of(whole, "petzval:samples"), "0:3");
        words.insert(words.end(), {"--crop", "10,3,9,7"});
        const io::Picture part = render(words);
        ASSERT_EQ(V2i(part.width, part.height), V2i(9, 7));
        EXPECT_EQ(V2i(part.x, part.y), V2i(10, 3));
        EXPECT_EQ(V2i(part.full_width, part.full_height), V2i(24, 12));
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 9; ++x)
                for (const char* c : {"R", "G", "B", "A"})
                    ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 10, y + 3, c));
    }

    const io::Picture timed = render({"--time-limit", "0.1s"});
    EXPECT_GE(std::stoi(metadata_of(timed, "petzval:samples").substr(2)), 1) << "it ends at all";
    const io::Picture both = render({"--time-limit", "24h", "--spp", "2"});
    EXPECT_EQ(metadata_of(both, "petzval:samples"), "0:2");
}

TEST_F(Cli, EqualRendersAreEqualFiles) {
    const Words words = {"--size", "40x24", "--aov", "normal"};
    const auto with = [&](const std::string& option, const std::string& value) {
        Words all = words;
        all.insert(all.end(), {option, value});
        return render_bytes(all);
    };
    const std::string two = render_bytes(words);
    EXPECT_EQ(two, with("--threads", "1"));
    EXPECT_EQ(two, with("--threads", "5"));
    EXPECT_EQ(two, with("--seed", "0"));
    EXPECT_NE(two, with("--seed", "4294967295"));
}

TEST_F(Cli, Cameras) {
    const std::string wide = render_bytes({}), tele = render_bytes({"--camera", "tele"});
    EXPECT_EQ(wide, render_bytes({"--camera", "0"}));
    EXPECT_EQ(tele, render_bytes({"--camera", "1"}));
    EXPECT_NE(wide, tele);
    EXPECT_EQ(difference({}, {"--look-at", "0,0,0,0,0,-3", "--fov", "68.754935"}), 0.);
    EXPECT_EQ(difference({"--camera", "tele"}, {"--fov", "28.64789"}), 0.);

    // Orthographic: 3 m high, of which the wall is 2.
    const Words sharp = {"--transparent", "--method", "filter=box", "--spp", "64"};
    Words plan = sharp;
    plan.insert(plan.end(), {"--camera", "plan"});
    const io::Picture seen = render(plan);
    EXPECT_NEAR(mean_of(seen, "A"), 4. / 9, 0.01);
}

TEST_F(Cli, Lens) {
    const io::Picture p = render({"--fstop", "2", "--focal-length", "50", "--sensor", "40x20"});
    EXPECT_EQ(metadata_of(p, "petzval:sensorWidth_mm"), "20.000000");
    EXPECT_EQ(metadata_of(p, "petzval:sensorHeight_mm"), "20.000000");
    EXPECT_EQ(metadata_of(p, "petzval:focalLength_mm"), "50.000000");
    EXPECT_EQ(metadata_of(p, "petzval:lensRadius_m"), "0.012500");
    EXPECT_NEAR(std::stod(metadata_of(p, "petzval:focus_m")), 2, 1e-5);
    // 2 atan(10 / S'), where 1 / S' = 1 / 50 - 1 / 2000: the film goes back to focus.
    EXPECT_NEAR(std::stod(metadata_of(p, "petzval:fov_deg")), 22.068414, 1e-4);
    EXPECT_EQ(metadata_of(render({"--focal-length", "50", "--sensor", "40x20"}), "petzval:fov_deg"),
              "22.619865");  // 2 atan(10 / 50)

    const auto focus_of = [&](const std::string& focus) {
        const io::Picture q = render({"--method", "lens-radius=0.1", "--focus", focus});
        EXPECT_EQ(metadata_of(q, "petzval:lensRadius_m"), "0.100000");
        return std::stod(metadata_of(q, "petzval:focus_m"));
    };
    EXPECT_NEAR(focus_of("3,8"), 1, 1e-5);  // on the small wall
    EXPECT_NEAR(focus_of("auto"), 2, 1e-5);
    EXPECT_EQ(focus_of("1.5m"), 1.5);

    // Out of focus the wall's edge is spread over more pixels.
    const auto mixed = [&](const std::string& focus) {
        const io::Picture q =
            render({"--method", "lens-radius=0.1", "--focus", focus, "--transparent", "--method",
                    "filter=box", "--size", "32x32", "--spp", "32"});
        int count = 0;
        for (int i = 0; i < 32 * 32; ++i) {
            const float alpha = value_at(q, i % 32, i / 32, "A");
            count += alpha > 0.02f && alpha < 0.98f;
        }
        return count;
    };
    EXPECT_GT(mixed("0.5"), 2 * mixed("2"));
}

TEST_F(Cli, EnvironmentAndBackground) {
    const std::string sky = red_and_blue();
    EXPECT_EQ(corner(render({"--env", sky})), V3f(1, 0, 0));
    EXPECT_EQ(corner(render({"--env", sky, "--env-rotate", "180"})), V3f(0, 0, 1));
    EXPECT_EQ(corner(render({"--env", sky, "--method", "env-strength=3"})), V3f(3, 0, 0));
    const io::Picture painted = render({"--env", sky, "--background", "0.25,0.5,2"});
    EXPECT_EQ(corner(painted), V3f(0.25f, 0.5f, 2));
    // The wall faces the blue half: lit by the environment, not by what is painted behind.
    EXPECT_GT(value_at(painted, 8, 8, "B"), 0.f);
    const io::Picture plain = render({"--background", "0.25,0.5,2"});
    EXPECT_EQ(corner(plain), V3f(0.25f, 0.5f, 2));
    EXPECT_EQ(value_at(plain, 0, 0, "A"), 1.f);
    const io::Picture clear = render({"--background", "0.25,0.5,2", "--transparent"});
    EXPECT_EQ(corner(clear), V3f(0, 0, 0));
    EXPECT_EQ(value_at(clear, 0, 0, "A"), 0.f);
    EXPECT_EQ(value_at(clear, 8, 8, "A"), 1.f);
    EXPECT_EQ(value_at(clear, 8, 8, "R"), value_at(plain, 8, 8, "R"));
}

TEST_F(Cli, DepthFilterSamplerLightChoiceTraversal) {
    EXPECT_EQ(mean_of(render({"--method", "max-depth=0"}), "G"), 0.);
    EXPECT_GT(mean_of(render({"--method", "max-depth=1"}), "G"), 0.01);

    std::set<std::string> pictures;
    const auto add = [&](const Words& words, const std::string& name, const std::string& value) {
        pictures.insert(render_bytes(words));
        EXPECT_EQ(metadata_of(io::read_picture(path("out.exr")), "petzval:" + name), value);
    };
    add({}, "filterRadius_px", "1.500000");
    add({"--method", "filter=gauss"}, "filter", "gauss");
    add({"--method", "filter=box"}, "filterRadius_px", "0.500000");
    add({"--method", "filter=box", "--method", "filter-radius=2"}, "filterRadius_px", "2.000000");
    add({"--method", "sampler=sobol"}, "sampler", "sobol");
    add({"--method", "sampler=independent"}, "sampler", "independent");
    add({"--method", "light-choice=uniform"}, "lightChoice", "uniform");
    add({"--method", "light-choice=power"}, "lightChoice", "power");
    EXPECT_EQ(pictures.size(), 8u);
    EXPECT_EQ(render_bytes({"--method", "sampler=owen", "--method", "filter=blackman-harris",
                            "--method", "light-choice=tree", "--method", "traversal=robust"}),
              render_bytes({}));
    EXPECT_LT(difference({"--method", "traversal=fast"}, {}), 1e-3);
}

TEST_F(Cli, DisplayPictures) {
    ASSERT_FALSE(render_bytes({"-o", path("a.png"), "-o", path("a.jpg"), "--exposure", "-1",
                               "--view", "ACES"})
                     .empty());
    EXPECT_EQ(io::read_picture(path("a.jpg")).width, 16);
    const auto view = [&](const std::string& exposure, const std::string& name) {
        const Finished run = run_petzval({"image", "view", path("out.exr"), "-o", path("b.png"),
                                          "--exposure", exposure, "--view", name});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return file_bytes(path("b.png"));
    };
    const std::string png = file_bytes(path("a.png"));
    EXPECT_EQ(png, view("-1", "ACES"));
    EXPECT_NE(png, view("0", "ACES"));
    EXPECT_NE(png, view("-1", "sRGB"));
    EXPECT_EQ(render_bytes({}), render_bytes({"--exposure", "3", "--view", "raw"}));
}

TEST_F(Cli, Layers) {
    const io::Picture p = render({"--size", "17x17", "--method", "filter=box", "--spp", "16",
                                  "--aov", "albedo,normal,depth,position,uv,emission,cost"});
    EXPECT_EQ(p.channels.size(), 4u + 3 + 3 + 1 + 3 + 2 + 3 + 1);
    const auto at = [&](const std::string& channel) { return value_at(p, 8, 8, channel); };
    EXPECT_NEAR(at("albedo.R"), 0.2, 1e-3);
    EXPECT_NEAR(at("albedo.G"), 0.4, 1e-3);
    EXPECT_NEAR(at("albedo.B"), 0.8, 1e-3);
    EXPECT_NEAR(at("normal.X"), 0, 1e-6);
    EXPECT_NEAR(at("normal.Z"), 1, 1e-6);
    EXPECT_NEAR(at("position.X"), 0, 0.02);
    EXPECT_NEAR(at("position.Z"), -2, 1e-5);
    EXPECT_NEAR(at("depth.Z"), 2, 2e-3);
    EXPECT_EQ(at("emission.R"), 0.f);
    EXPECT_GE(at("cost.N"), 1.f);
    // Depth is the distance from the lens, not along the axis.
    const double x = value_at(p, 12, 8, "position.X");
    EXPECT_NEAR(value_at(p, 12, 8, "depth.Z"), std::sqrt(x * x + 4), 5e-3);
    EXPECT_NEAR(value_at(p, 3, 8, "position.Z"), -1, 1e-5);
}

TEST_F(Cli, Stats) {
    ASSERT_FALSE(render_bytes({"--stats", path("s.json")}).empty());
    const json s = json::parse(file_bytes(path("s.json")));
    for (const char* key : {"load_s", "bvh_build_s", "render_wall_s", "render_cpu_s",
                            "rays_per_cpu_s", "samples_per_cpu_s", "peak_memory_mib"})
        EXPECT_GT(s.at(key).get<double>(), 0) << key;
    for (const char* key : {"camera_s", "traversal_s", "texture_s", "shading_s"})
        EXPECT_GE(s.at("cpu_time").at(key).get<double>(), 0) << key;
    EXPECT_EQ(s.at("size_px"), json({16, 16}));
    EXPECT_EQ(s.at("pixel_samples"), 16 * 16 * 4);
    EXPECT_EQ(s.at("samples_per_pixel"), 4);
    EXPECT_EQ(s.at("threads"), 2);
    EXPECT_EQ(s.at("rays").at("camera"), 16 * 16 * 4);
    EXPECT_EQ(s.at("rays").at("all"), s.at("rays").at("camera").get<int>() +
                                          s.at("rays").at("bounce").get<int>() +
                                          s.at("rays").at("shadow").get<int>());
    EXPECT_EQ(s.at("bad_samples"), 0);
    EXPECT_EQ(s.at("too_bright_samples"), 0);
}

TEST_F(Cli, SamplesThatAreTooBrightAreCountedAsSuch) {
    const auto run = [&](const Words& more) {
        Words words = {"--background",  "1e16,1e16,1e16", "-o",
                       path("out.exr"), "--stats",        path("s.json")};
        words.insert(words.end(), more.begin(), more.end());
        return run_petzval(render_words(words, scene_));
    };
    const Finished bright = run({});
    EXPECT_EQ(bright.exit_code, 0);
    json s = json::parse(file_bytes(path("s.json")));
    const int count = s.at("too_bright_samples").get<int>();
    EXPECT_GT(count, 0);
    EXPECT_EQ(s.at("bad_samples"), 0);
    EXPECT_NE(bright.err.find("warning: " + std::to_string(count) +
                              " samples were brighter than 1.4e+14 nits, which is more than a "
                              "film holds; they are left out, the first is sample 0 of pixel "),
              std::string::npos)
        << bright.err;
    EXPECT_EQ(bright.err.find("not finite"), std::string::npos) << bright.err;

    const Finished clamped = run({"--method", "clamp=1e12"});
    EXPECT_EQ(clamped.exit_code, 0) << clamped.err;
    EXPECT_EQ(clamped.err.find("brighter than"), std::string::npos) << clamped.err;
    s = json::parse(file_bytes(path("s.json")));
    EXPECT_EQ(s.at("too_bright_samples"), 0);
}

TEST_F(Cli, ProgressStyles) {
    const std::string dark = walls().save_glb(folder_.path / "dark.glb").string();
    const auto stderr_of = [&](const Words& more) {
        Words words = {"-o", path("out.exr")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_petzval(render_words(words, dark));
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_EQ(run.out, "");
        return run.err;
    };
    EXPECT_NE(stderr_of({"--progress", "bar"}).find("\r\033[K[##########"), std::string::npos);
    EXPECT_NE(stderr_of({"--progress", "lines"}).find("\n100.0 %"), std::string::npos);
    EXPECT_NE(stderr_of({}).find("\n100.0 %"), std::string::npos);  // a pipe is no terminal
    const std::string none = stderr_of({"--progress", "none"});
    EXPECT_EQ(none.find('%'), std::string::npos);
    EXPECT_NE(none.find("petzval: nothing lights this scene"), std::string::npos);
    EXPECT_EQ(stderr_of({"--progress", "json", "--quiet"}), "");
}

TEST_F(Cli, StatsOfARunHaveASchema) {
    const std::string dark = walls().save_glb(folder_.path / "dark.glb").string();
    ASSERT_EQ(run_petzval(render_words({"-o", path("out.exr"), "--stats", path("s.json"), "--fstop",
                                        "2", "--lens", "tessar-100mm-f2.8", "--quiet"},
                                       dark))
                  .exit_code,
              0);
    const json s = json::parse(file_bytes(path("s.json")));
    EXPECT_EQ(s.at("schema"), "petzval.stats");
    EXPECT_EQ(s.at("version"), 1);
    EXPECT_TRUE(s.at("stopped_by").is_null());
    for (const char* phase : {"loading", "bvh", "planning", "rendering", "writing"})
        EXPECT_GT(s.at("phase_s").at(phase), 0) << phase;
    EXPECT_EQ(s.at("phase_s").at("denoising"), 0);
    EXPECT_EQ(s.at("phase_s").size(), 6u);
    EXPECT_EQ(s.at("outputs").size(), 1u);
    EXPECT_NE(s.at("notices").dump().find("nothing lights this scene"), std::string::npos);
    const std::string warnings = s.at("warnings").dump();
    EXPECT_NE(warnings.find("opens to f/2.89 at most"), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("an f-number is 1 / (2 sin u')"), std::string::npos) << warnings;
    EXPECT_EQ(s.at("errors"), json::array());
}

TEST_F(Cli, WhatIsChosenCanBePassedBack) {
    const std::string dark = walls().save_glb(folder_.path / "dark.glb").string();
    const Finished first = run_petzval(
        render_words({"-o", path("a.exr"), "--fstop", "1.3", "--progress", "none"}, dark));
    ASSERT_EQ(first.exit_code, 0) << first.err;
    // Every option in the notices, with the word after it.
    Words words = {"-o", path("b.exr"), "--fstop", "1.3"};
    std::string text = first.err;
    const size_t others = text.find("; give --env");
    ASSERT_NE(others, std::string::npos) << first.err;
    text.erase(others, text.find('\n', others) - others);
    for (char& c : text)
        if (c == '(' || c == ')') c = ' ';
    std::istringstream in(text);
    for (std::string word, value; in >> word;)
        if (word.starts_with("--") && in >> value) words.insert(words.end(), {word, value});
    ASSERT_EQ(words.size(), 4u + 8) << first.err;  // env, look-at, fov, focus
    words.insert(words.end(), {"--progress", "none"});
    const Finished second = run_petzval(render_words(words, dark));
    EXPECT_EQ(second.err, "petzval: spectral: rgb, as nothing here depends on wavelength\n");
    EXPECT_TRUE(file_bytes(path("a.exr")) == file_bytes(path("b.exr")));
}

TEST_F(Cli, AnEmptySceneIsItsBackground) {
    const std::string empty = TinyGltf().save_gltf(folder_.path / "empty.gltf").string();
    const Finished run = run_petzval(render_words(
        {"-o", path("out.exr"), "--background", "1,2,3", "--progress", "none"}, empty));
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("petzval: warning: the scene is empty"), std::string::npos) << run.err;
    EXPECT_EQ(corner(io::read_picture(path("out.exr"))), V3f(1, 2, 3));
}

TEST_F(Cli, NamesWithSpacesBeforeTheScene) {
    const Finished run = run_petzval({"render", "-o", path("a b.exr"), "--output", path("[c].png"),
                                      scene_, "--size", "4x4", "--spp", "1", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(io::read_picture(path("a b.exr")).width, 4);
    EXPECT_EQ(io::read_picture(path("[c].png")).width, 4);
}

TEST_F(Cli, InfoVersionAndHelp) {
    const Finished info = run_petzval({"info", scene_});
    EXPECT_EQ(info.exit_code, 0);
    EXPECT_EQ(info.err, "");
    for (const char* line :
         {"holds\n", "  triangles: 4 stored, 4 placed\n", "2 point",
          "  camera 0: wide, perspective, 68.75 deg vertical\n",
          "  camera 2: plan, orthographic, 3 x 3 m\n",
          "lights: 2 point, 0 spot, 0 directional, 0 emissive meshes\n",
          "  bounds: 2 x 2 x 1 m, from -1,-1,-2 to 1,1,-1\n", "  --focus auto, camera 0: 2 m\n",
          "  --focus auto, camera 1: 2 m\n", "extensions\n",
          "  KHR_lights_punctual     rendered      in 3 objects\n"})
        EXPECT_NE(info.out.find(line), std::string::npos) << line << info.out;

    const Finished version = run_petzval({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("petzval ")) << version.out;
    EXPECT_EQ(run_petzval({"--help"}).exit_code, 0);
    const Finished help = run_petzval({"render", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("--look-at"), std::string::npos);
}

TEST_F(Cli, TheBuiltInScene) {
    const std::string scene = PETZVAL_ASSETS "/scenes/first_light.glb";
    const Finished run = run_petzval(
        {"render", scene, "-o", path("out.exr"), "--size", "16x9", "--spp", "1", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_GT(mean_of(io::read_picture(path("out.exr")), "G"), 0);
}

}  // namespace
}  // namespace petzval::apps
