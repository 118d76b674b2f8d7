// SPDX-License-Identifier: Apache-2.0
// Sequences of pictures: each is that of a command of its own, and what is there is not done again.
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class Sequences : public CliTest {
  protected:
    // Without a camera, so that the view is found; the lens is focused by itself.
    std::string walls_ = walls().save_glb(folder_.path / "walls.glb").string();
    const Words small_ = {"--size", "24x16", "--spp", "4", "--env", "studio"};

    [[nodiscard]] Words words(const std::string& scene, const Words& more) const {
        Words all = {"render", scene};
        all.insert(all.end(), small_.begin(), small_.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Finished run(const std::string& scene, const Words& more, int exit_code = 0) {
        const Finished done = run_petzval(words(scene, more));
        EXPECT_EQ(done.exit_code, exit_code) << done.err;
        return done;
    }
    /// A word behind another in what was printed, as a value of an option in brackets.
    static std::string after(const std::string& text, const std::string& option) {
        const size_t at = text.find(option + " ");
        if (at == text.npos) return "";
        const size_t begin = at + option.size() + 1;
        return text.substr(begin, text.find_first_of(" )\n", begin) - begin);
    }
    void expect_same(const std::string& a, const std::string& b) {
        EXPECT_FALSE(file_bytes(path(a)).empty()) << a;
        EXPECT_TRUE(file_bytes(path(a)) == file_bytes(path(b))) << a << ' ' << b;
    }
    [[nodiscard]] std::filesystem::file_time_type time_of(const std::string& name) const {
        return std::filesystem::last_write_time(path(name));
    }
};

TEST_F(Sequences, ASweepIsEachValueByItself) {
    const Finished sweep = run(studio().save_glb(folder_.path / "s.glb").string(),
                               {"--sweep", "fstop=1.4,2,f/8", "--focus", "auto", "-o",
                                path("s_#.exr"), "--camera", "wide"});
    const std::string focus = after(sweep.err, "--focus");
    int i = 0;
    for (const char* fstop : {"1.4", "2", "8"}) {
        run(path("s.glb"), {"--fstop", fstop, "--focus", i == 0 ? "auto" : focus, "--camera",
                            "wide", "-o", path("one.exr")});
        expect_same("one.exr", "s_" + std::to_string(++i) + ".exr");
    }
    EXPECT_EQ(sweep.err.find("focus: ", sweep.err.find("focus: ") + 1), std::string::npos)
        << "it is found once: " << sweep.err;
}

TEST_F(Sequences, AListOfCamerasIsASweep) {
    run(scene_, {"--sweep", "camera=wide;plan;tele", "-o", path("c_#.exr")});
    int i = 0;
    for (const char* name : {"wide", "plan", "tele"}) {
        run(scene_, {"--camera", name, "-o", path("one.exr")});
        expect_same("one.exr", "c_" + std::to_string(++i) + ".exr");
    }
}

// The scene is another one for each value: nothing of the one before may stay.
TEST_F(Sequences, ASweepOverTheLight) {
    run(scene_, {"--sweep", "env-strength=1,4", "-o", path("l_#.exr"), "--camera", "wide"});
    run(scene_, {"--method", "env-strength=4", "-o", path("one.exr"), "--camera", "wide"});
    expect_same("one.exr", "l_2.exr");
}

TEST_F(Sequences, ATurntableIsAnOrbitForEachView) {
    const Finished table = run(walls_, {"--turntable", "4", "-o", path("t_#.exr")});
    for (int i = 0; i < 4; ++i) {
        run(walls_, {"--orbit", std::to_string(90 * i), "-o", path("one.exr")});
        const io::Picture alone = io::read_picture(path("one.exr")),
                          view = io::read_picture(path("t_" + std::to_string(i + 1) + ".exr"));
        EXPECT_EQ(alone.pixels, view.pixels) << i;
    }
}

// The scene seen from all around: what is in the picture at one angle is in it at all of them.
TEST_F(Sequences, ATurntableCutsNothingOff) {
    TinyGltf bar;  // long, and flat
    add_wall(bar, -5, -0.2f, 5, 0.2f, 0, {0.8f, 0.8f, 0.8f});
    bar.json["materials"][0]["doubleSided"] = true;
    const std::string scene = bar.save_glb(folder_.path / "bar.glb").string();
    run(scene, {"--turntable", "7", "-o", path("b_#.exr"), "--aov", "depth", "--size", "48x32"});
    for (int i = 1; i <= 7; ++i) {
        const io::Picture view = io::read_picture(path("b_" + std::to_string(i) + ".exr"));
        const int depth = io::channel_index(view, "depth.Z");
        ASSERT_GE(depth, 0);
        int inside = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x) {
                const bool rim = x == 0 || y == 0 || x == 47 || y == 31;
                const float met =
                    view.pixels[size_t(y * 48 + x) * view.channels.size() + size_t(depth)];
                EXPECT_FALSE(rim && met > 0) << i << ": " << x << ',' << y;
                inside += met > 0;
            }
        EXPECT_GT(inside, 8) << i;
    }
}

// A camera that orbits by 90 degrees stands to the right of what it looks at: +x is right of +z.
TEST_F(Sequences, AnOrbitTurnsCounterClockwiseFromAbove) {
    run(walls_, {"--look-at", "0,0,3,0,0,-1", "--orbit", "90", "-o", path("o.exr")});
    std::string eye;
    for (const auto& [name, value] : io::read_picture(path("o.exr")).metadata)
        if (name == "petzval:cameraEye_m") eye = std::get<std::string>(value);
    float x = 0, y = 0, z = 0;
    ASSERT_EQ(sscanf(eye.c_str(), "%f,%f,%f", &x, &y, &z), 3) << eye;
    EXPECT_NEAR(x, 4, 1e-5f);
    EXPECT_NEAR(y, 0, 1e-5f);
    EXPECT_NEAR(z, -1, 1e-5f);
    run(walls_, {"--look-at", "0,0,3,0,0,-1", "--orbit", "90", "--method", "orbit-about=1,7,3",
                 "-o", path("o.exr")});
    for (const auto& [name, value] : io::read_picture(path("o.exr")).metadata)
        if (name == "petzval:cameraEye_m") eye = std::get<std::string>(value);
    ASSERT_EQ(sscanf(eye.c_str(), "%f,%f,%f", &x, &y, &z), 3) << eye;
    EXPECT_NEAR(x, 1, 1e-5f);
    EXPECT_NEAR(z, 4, 1e-5f);
}

TEST_F(Sequences, WhatIsThereIsNotRenderedAgain) {
    const Words asked = {"--sweep",       "fov=30,40,50", "-o",          path("s_#.exr"),  "-o",
                         path("s_#.png"), "--look-at",    "0,0,1,0,0,0", "--skip-existing"};
    run(walls_, asked);
    const auto exr = time_of("s_1.exr"), png = time_of("s_1.png"), third = time_of("s_3.exr");
    std::filesystem::remove(path("s_2.png"));
    std::ofstream(path("s_3.png")) << "half a pict";
    const Finished again = run(walls_, asked);
    EXPECT_NE(again.err.find("s_1.exr is there already"), std::string::npos) << again.err;
    EXPECT_EQ(again.err.find("s_2.exr is there already"), std::string::npos) << again.err;
    EXPECT_EQ(time_of("s_1.exr"), exr);
    EXPECT_EQ(time_of("s_1.png"), png);
    EXPECT_GT(time_of("s_3.exr"), third) << "one of its pictures was broken";
    EXPECT_TRUE(std::filesystem::exists(path("s_2.png")));

    std::string png_bytes = file_bytes(path("s_2.png"));
    png_bytes.resize(png_bytes.size() * 3 / 4);  // its head says that it is the same
    std::ofstream(path("s_2.png"), std::ios::binary) << png_bytes;
    EXPECT_EQ(run(walls_, asked).err.find("s_2.png is there already"), std::string::npos);
    EXPECT_EQ(io::read_picture(path("s_2.png")).width, 24);

    // What they follow from has changed: none is taken for the same.
    const auto renders = [&](const std::string& scene, const Words& more) {
        Words all = asked;
        all.insert(all.end(), more.begin(), more.end());
        return run(scene, all).err.find("is there already") == std::string::npos;
    };
    EXPECT_TRUE(renders(walls_, {"--seed", "1"}));
    EXPECT_TRUE(renders(walls_, {}));
    EXPECT_TRUE(renders(walls_, {"--spp", "8"}));
    EXPECT_TRUE(renders(walls_, {}));
    EXPECT_TRUE(renders(walls_, {"--crop", "0,0,8,8"}));
    EXPECT_TRUE(renders(walls_, {}));
    EXPECT_TRUE(renders(walls_, {"--view", "ACES"})) << "of PNG";
    EXPECT_TRUE(renders(walls_, {}));
    EXPECT_FALSE(renders(walls_, {"--threads", "1", "--stats", path("x_#.json")}));
    TinyGltf other = walls();
    other.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.1, 0.1, 1};
    other.save_glb(folder_.path / "walls.glb");
    EXPECT_TRUE(renders(walls_, {}));
}

// How many samples there are is not known before: any number of them will do.
TEST_F(Sequences, WhatATimeLimitEndedIsThere) {
    const Words asked = {"--look-at", "0,0,1,0,0,0",  "--size",         "8x8", "--env",
                         "studio",    "--time-limit", "0.2s",           "-o",  path("t.exr"),
                         "-o",        path("t.png"),  "--skip-existing"};
    const auto rendered = [&](const Words& more) {
        Words all = {"render", walls_};
        all.insert(all.end(), asked.begin(), asked.end());
        all.insert(all.end(), more.begin(), more.end());
        const Finished done = run_petzval(all);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done.err.find("is there already") == std::string::npos;
    };
    EXPECT_TRUE(rendered({}));
    EXPECT_FALSE(rendered({}));
    EXPECT_TRUE(rendered({"--seed", "3"}));
}

// A sequence that is stopped in the middle of a picture, and given again.
TEST_F(Sequences, WhatWasStoppedGoesOn) {
    std::string spp = "500";
    const auto asked = [&](const std::string& name, const Words& more) {
        Words all = {"--sweep",   "fov=30,40",   "-o",    path(name),
                     "--look-at", "0,0,1,0,0,0", "--spp", spp};
        all.insert(all.end(), more.begin(), more.end());
        return words(walls_, all);
    };
    ASSERT_EQ(run_petzval(asked("x_#.exr", {"--stats", path("x_#.json")})).exit_code, 0);
    const auto trial = nlohmann::json::parse(file_bytes(path("x_2.json")));
    spp = std::to_string(std::max(500, int(500 / trial["render_wall_s"].get<double>())));  // 1 s
    EXPECT_EQ(run_petzval(asked("w_#.exr", {})).exit_code, 0);
    Process render(asked("r_#.exr", {"--progress", "json", "--sheet", path("sheet.png")}));
    ASSERT_TRUE(render.wait_for_stderr([](const std::string& text) {
        const size_t second = text.find("fov 40, 2 of 2");
        return second != text.npos && text.find("\"phase\":\"rendering\"", second) != text.npos;
    }));
    render.signal(SIGTERM);
    EXPECT_EQ(render.wait().exit_code, 130);
    EXPECT_FALSE(std::filesystem::exists(path("sheet.png"))) << "a finished one may be there";
    ASSERT_TRUE(std::filesystem::exists(path("r_2.state")));
    std::filesystem::copy(path("r_2.state"), path("copy.state"));
    const Finished again = run_petzval(asked("r_#.exr", {"--skip-existing"}));
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.err.find("goes on with " + path("r_2.state")), std::string::npos) << again.err;
    expect_same("w_1.exr", "r_1.exr");
    expect_same("w_2.exr", "r_2.exr");
    // The state alone knows which picture of the sequence it is of.
    std::filesystem::remove(path("r_2.exr"));
    EXPECT_EQ(run_petzval({"resume", path("copy.state")}).exit_code, 0);
    expect_same("w_2.exr", "r_2.exr");
}

TEST_F(Sequences, OneThatFailsDoesNotEndTheOthers) {
    std::filesystem::create_directory(path("s_2.png"));
    const Finished some =
        run(walls_,
            {"--sweep", "fov=30,40,50", "-o", path("s_#.png"), "--sheet", path("sheet.png")}, 3);
    EXPECT_NE(
        some.err.find("error: fov 40: " + path("s_2.png") + ": cannot be written: it is a folder"),
        std::string::npos)
        << some.err;
    EXPECT_NE(some.err.find("1 of 3 pictures failed: fov 40"), std::string::npos) << some.err;
    EXPECT_EQ(io::read_picture(path("s_1.png")).width, 24);
    EXPECT_EQ(io::read_picture(path("s_3.png")).width, 24);
    EXPECT_GT(io::read_picture(path("sheet.png")).width, 24);
    const Finished cameras = run(scene_, {"--sweep", "camera=wide,none", "-o", path("c_#.png")}, 2);
    EXPECT_TRUE(std::filesystem::exists(path("c_1.png")));
}

TEST_F(Sequences, ASheetShowsAllInOrder) {
    run(walls_, {"--sweep", "background=9,0,0;0,9,0;0,0,9", "--sheet", path("sheet.png"),
                 "--look-at", "0,0,1,0,0,9", "--size", "40x40", "--method", "env-strength=0"});
    EXPECT_EQ(listing(), (std::set<std::string>{"sheet.png", "studio.glb", "walls.glb"}))
        << "no other picture was asked for";
    const io::Picture sheet = io::read_picture(path("sheet.png"));
    // Where each colour lies: red before green before blue, by rows.
    std::array<int, 3> first{-1, -1, -1}, count{};
    for (int y = 0; y < sheet.height; ++y)
        for (int x = 0; x < sheet.width; ++x) {
            const float* p =
                sheet.pixels.data() + size_t(y * sheet.width + x) * sheet.channels.size();
            for (size_t c = 0; c < 3; ++c)
                if (p[c] > 0.95f && p[(c + 1) % 3] < 0.05f && p[(c + 2) % 3] < 0.05f) {
                    ++count[c];
                    if (first[c] < 0) first[c] = (y / 40) * sheet.width + x;
                }
        }
    for (const int pixels : count) EXPECT_EQ(pixels, 40 * 40);
    EXPECT_LT(first[0], first[1]);
    EXPECT_LT(first[1], first[2]);
}

TEST_F(Sequences, WhatMakesNoSequenceIsRefused) {
    expect_refused(
        2, {{{"--sweep", "fstop", "-o", path("s_#.png")}, "is not an option and its values"},
            {{"--sweep", "fstop=1,,2", "-o", path("s_#.png")}, "is not an option and its values"},
            {{"--sweep", "output=a.png,b.png", "-o", path("s_#.png")},
             "--sweep: output is the same for all pictures; sweep what changes the picture"},
            {{"--sweep", "method=max-depth=1,2", "-o", path("s_#.png")},
             "--sweep: leave out \"method=\": what it names is swept as filter-radius=1,2"},
            {{"--sweep", "fstop=1,two", "-o", path("s_#.png")}, "--fstop"},
            {{"--sweep", "xyzzy=1,2", "-o", path("s_#.png")},
             "error: --xyzzy is no option of petzval render (--help"},
            {{"--sweep", "fstp=1,2", "-o", path("s_#.png")},
             "error: --fstp is no option of petzval render; did you mean --fstop? (--help"},
            {{"--sweep", "resolution=4x4,8x8", "-o", path("s_#.png")},
             "--resolution is no option of petzval render; type --size WIDTHxHEIGHT"},
            {{"--sweep", "fstop=1,2", "-o", path("s.png")}, "put #### where their numbers go"},
            {{"--sweep", "fstop=1,2", "--frames", "1:2", "-o", path("s_#.png")}, "--frames"},
            {{"--turntable", "0", "-o", path("s_#.png")}, "--turntable"},
            {{"--turntable", "4", "--orbit", "3", "-o", path("s_#.png")}, "--orbit"},
            {{"--method", "orbit-about=0,0,0", "-o", path("s.png")},
             "--method orbit-about: has no effect"},
            {{"--samples", "4", "-o", path("s.png")},
             "--samples is no option of petzval render; type --spp NUMBER"},
            {{"render", scene_, "--spp", "8:4", "-o", path("s.png")}, "a range A:B of samples"},
            {{"-o", path("a.state"), "-o", path("b.state")}, "names two states"},
            {{"--checkpoint", "often", "-o", path("s.png")}, "--checkpoint"},
            {{"--method", "clamp=0", "-o", path("s.png")}, "--method clamp"},
            {{"--preview", path("p.exr"), "-o", path("s.png")}, "--preview"},
            {{"--sheet", path("x.png"), "-o", path("s.png")}, "--sheet: needs"}});
    expect_refused(3, {{{"--log", path("none/log.txt"), "-o", path("s.png")}, "there is no folder"},
                       {{"render", scene_, "--turntable", "2", "-o", path("s_#.png"), "--sheet",
                         path("none/s.png")},
                        "there is no folder"}});
}

}  // namespace
}  // namespace petzval::apps
