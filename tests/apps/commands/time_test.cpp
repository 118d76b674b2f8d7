// SPDX-License-Identifier: Apache-2.0
// Time on the command line: moments, sequences of frames, shutters, velocities.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliTime : public CliTest {
  protected:
    CliTime() { scene_ = moving().save_glb(folder_.path / "moving.glb").string(); }

    /// The studio, whose first wall goes 0.3 m to the right and 0.6 m up each second, for a second,
    /// and whose camera "tele" comes 0.5 m nearer meanwhile. A third animation moves the wall too.
    [[nodiscard]] static TinyGltf moving() {
        TinyGltf file = studio();
        const int times = file.add_accessor<float>("SCALAR", {0, 1});
        const auto go = [&](const char* name, int node, const std::vector<float>& to) {
            std::vector<float> path(3);
            path.insert(path.end(), to.begin(), to.end());
            const int output = file.add_accessor<float>("VEC3", path);
            file.add("animations",
                     {{"name", name},
                      {"samplers", {{{"input", times}, {"output", output}}}},
                      {"channels",
                       {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
        };
        go("drift", 0, {0.3f, 0.6f, 0});
        go("approach", 3, {0, 0, -0.5f});
        go("back", 0, {-0.3f, 0, 0});
        return file;
    }
    [[nodiscard]] std::string refusal(const Words& more) {
        const Finished done = run_petzval(render_words(more, scene_));
        EXPECT_EQ(done.exit_code, 2) << done.err;
        return done.err;
    }
    [[nodiscard]] static V2f velocity_of(const io::Picture& picture, int x, int y) {
        const auto channel = [&](const char* name) {
            const auto at = std::find(picture.channels.begin(), picture.channels.end(), name);
            return static_cast<size_t>(at - picture.channels.begin());
        };
        const size_t pixel =
            static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
        const size_t first = pixel * picture.channels.size();
        return {picture.pixels[first + channel("velocity.X")],
                picture.pixels[first + channel("velocity.Y")]};
    }
};

TEST_F(CliTime, FramesAreThoseOfTheirMoments) {
    const Finished run = run_petzval(render_words(
        {"--frames", "1:9:4", "--fps", "10", "--background", "1,1,1", "--shutter", "180deg", "-o",
         path("f-####.exr"), "-o", path("f##.png"), "--stats", path("s#.json")},
        scene_));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(listing(), (std::set<std::string>{"moving.glb", "studio.glb", "f-0001.exr",
                                                "f-0005.exr", "f-0009.exr", "f01.png", "f05.png",
                                                "f09.png", "s1.json", "s5.json", "s9.json"}));
    for (const int frame : {1, 5, 9})
        EXPECT_EQ(render_bytes({"--at", fmt::format("{}ms", 100 * frame), "--fps", "10",
                                "--background", "1,1,1", "--shutter", "1/20"}),
                  file_bytes(path(fmt::format("f-{:04}.exr", frame))))
            << frame;
    EXPECT_NE(file_bytes(path("f-0001.exr")), file_bytes(path("f-0005.exr")));
}

// The animations take a second.
TEST_F(CliTime, TheLastFrameIsTheLastPose) {
    const Finished run = run_petzval(render_words(
        {"--frames", "1:25:12", "--fps", "25", "--background", "1,1,1", "-o", path("f##.exr")},
        scene_));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto at = [&](Words words) {
        words.insert(words.end(), {"--background", "1,1,1"});
        return render(words).pixels;
    };
    const auto last = io::read_picture(path("f25.exr")).pixels;
    EXPECT_EQ(last, at({"--at", "1s"}));
    EXPECT_EQ(last, at({"--at", "7s"}));
    EXPECT_NE(last, at({"--at", "0"}));
    EXPECT_EQ(at({"--at", "0"}), at({"--at", "1s", "--loop"}));
    EXPECT_EQ(at({"--at", "0.25"}), at({"--at", "3.25", "--loop"}));
    EXPECT_EQ(metadata_of(render({"--at", "1s"}), "petzval:loop"), "0");
    EXPECT_EQ(metadata_of(render({"--at", "1s", "--loop"}), "petzval:loop"), "1");
}

TEST_F(CliTime, WhatTheFirstFrameFindsHolds) {
    TinyGltf file = walls();
    const int times = file.add_accessor<float>("SCALAR", {0, 1});
    const int moves = file.add_accessor<float>("VEC3", {0, 0, 0, 3, 0, 0});
    file.add(
        "animations",
        {{"samplers", {{{"input", times}, {"output", moves}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    const std::string scene = file.save_glb(folder_.path / "framed.glb").string();
    const Finished run = run_petzval(
        render_words({"--frames", "0:12:12", "--fstop", "2", "-o", path("f#.exr")}, scene));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const io::Picture a = io::read_picture(path("f0.exr")), b = io::read_picture(path("f12.exr"));
    for (const char* name :
         {"petzval:cameraEye_m", "petzval:cameraTarget_m", "petzval:focus_m", "petzval:fov_deg"})
        EXPECT_EQ(metadata_of(a, name), metadata_of(b, name)) << name;
    EXPECT_NE(a.pixels, b.pixels);
}

TEST_F(CliTime, SaysWhatIsShown) {
    const auto told = [&](Words words) {
        words.insert(words.end(), {"-o", path("out.exr")});
        return run_petzval(render_words(words, scene_)).err;
    };
    const auto expect = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), text.npos) << text;
    };
    expect(told({}), "holds 3 animations; the pose that it stores is shown (--at 1s");
    const std::string playing = told({"--at", "0.25", "--camera", "wide", "--shutter", "1/8"});
    expect(playing, "animation: drift at 0.25 s of 1\n");
    expect(playing, "animation: approach at 0.25 s of 1\n");
    expect(playing, "1 more animation is not played");
    expect(playing, "while the shutter is open: 1 moving instance, 1 moving camera; between");
    expect(told({"--at", "0.25", "--animation", "approach", "--shutter", "1/8"}),
           "while the shutter is open: 1 moving camera\n");
    expect(told({"--at", "9.25", "--shutter", "1/8"}), "nothing moves while the shutter is open");
}

TEST_F(CliTime, AShutterBlursOnlyWhatMoves) {
    // Without motion, and with a still moment, the bytes are those without a shutter but for what
    // the file says of it.
    const Words still = {"--at", "9.25"};
    Words open = still;
    open.insert(open.end(), {"--shutter", "1/8", "--method", "shutter-curve=trapezoid"});
    EXPECT_EQ(render(still).pixels, render(open).pixels);
    const io::Picture sharp = render({"--at", "0.5"}),
                      blurred = render({"--at", "0.5", "--shutter", "1"});
    EXPECT_NE(sharp.pixels, blurred.pixels);
    EXPECT_EQ(metadata_of(blurred, "petzval:time_s"), "0.5");
    EXPECT_EQ(metadata_of(blurred, "petzval:shutterOpen_s"), "1");
    EXPECT_EQ(metadata_of(blurred, "petzval:shutterCurve"), "0:1,1:1");
    // The shutter's time exposes in the photographic mode too: twice the time, twice the light.
    const Words photo = {
        "--exposure-mode", "photographic", "--fstop", "8", "--focus", "2", "--at", "9.25",
        "--camera",        "wide"};
    const auto mean = [&](const char* time, const char* curve) {
        Words words = photo;
        words.insert(words.end(),
                     {"--shutter", time, "--method", "shutter-curve=" + std::string(curve)});
        const io::Picture picture = render(words);
        double sum = 0;
        for (size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
            sum += double(picture.pixels[i]);
        return sum;
    };
    EXPECT_NEAR(mean("1/50", "box") / mean("1/100", "box"), 2, 1e-5);
    EXPECT_NEAR(mean("1/50", "trapezoid") / mean("1/50", "box"), 1, 1e-5);
}

TEST_F(CliTime, CurvesComeFromFiles) {
    const std::string box = text_file("box.csv", "time,open\n3,1\n5,1\n");
    const Words base = {"--at", "0.5", "--shutter", "0.5", "--method"};
    const auto with = [&](const std::string& curve) {
        Words words = base;
        words.push_back("shutter-curve=" + curve);
        return words;
    };
    EXPECT_EQ(render(with(box)).pixels, render(with("box")).pixels);
    const std::string late = text_file("late.csv", "time,open\n0,0\n1,0\n1,1\n2,1\n");
    EXPECT_NE(render(with(late)).pixels, render(with("box")).pixels);
    const std::pair<const char*, const char*> broken[] = {
        {"time,open\n0,1\n", "two rows"},
        {"time,open\n0,1\n2,1\n1,1\n", "line 4"},
        {"time,open\n0,1\n1,-1\n", "line 3"},
        {"time,open\n0,0\n1,0\n", "never lets any light in"},
        {"time,open\n1,1\n1,1\n", "never lets any light in"},
        {"time\n0\n1\n", "two columns"}};
    for (const auto& [text, part] : broken) {
        Words words = with(text_file("broken.csv", text));
        words.insert(words.end(), {"-o", path("out.exr")});
        const Finished run = run_petzval(render_words(words, scene_));
        EXPECT_EQ(run.exit_code, 1) << text;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    }
}

TEST_F(CliTime, VelocitiesArePixelsToTheNextFrame) {
    // Through "plan", 16 px are 3 m wide: the wall goes by 1.6 px and 3.2 px in a second.
    const Words plan = {"--camera", "plan",  "--at",     "0.25",     "--fps",
                        "4",        "--aov", "velocity", "--method", "filter=box"};
    const io::Picture flat = render(plan);
    const V2f moved = velocity_of(flat, 8, 8), none = velocity_of(flat, 5, 8);
    EXPECT_NEAR(moved.x, 0.4f, 1e-3f);
    EXPECT_NEAR(moved.y, -0.8f, 1e-3f);
    EXPECT_NEAR(none.length(), 0, 1e-4f);  // the other wall
    // "tele" is 2 m from the wall, and 0.1 m nearer in the next frame. Half a picture's height is
    // tan(0.25) of the distance.
    const Words tele = {"--camera", "tele", "--at",  "0",        "--animation", "approach",
                        "--fps",    "5",    "--aov", "velocity", "--method",    "filter=box"};
    const io::Picture grown = render(tele);
    for (const V2i& px : {V2i(5, 2), V2i(14, 5), V2i(8, 15)}) {
        const V2f off = V2f(px) + V2f(0.5f) - V2f(8);
        const V2f found = velocity_of(grown, px.x, px.y);
        EXPECT_NEAR(found.x, off.x * (2 / 1.9f - 1), 0.02f) << px.x;
        EXPECT_NEAR(found.y, off.y * (2 / 1.9f - 1), 0.02f) << px.y;
    }
    // The layer changes nothing of the picture.
    Words without = tele;
    without.erase(std::find(without.begin(), without.end(), "--aov"));
    without.erase(std::find(without.begin(), without.end(), "velocity"));
    const io::Picture bare = render(without);
    for (size_t i = 0; i < 16 * 16; ++i)
        for (size_t c = 0; c < 4; ++c)
            EXPECT_EQ(grown.pixels[6 * i + c], bare.pixels[4 * i + c]) << i;
}

TEST_F(CliTime, VelocitiesThroughALensAreThoseOfItsPictures) {
    // A surface whose texture coordinates tell its points: where a lens pictures one is found in
    // two frames, and the velocity must be the difference. A lens that distorts, and no defocus.
    TinyGltf file;
    nlohmann::json primitive;
    primitive["attributes"]["POSITION"] =
        file.add_positions({-2, -2, -3, 2, -2, -3, 2, 2, -3, -2, 2, -3});
    primitive["attributes"]["TEXCOORD_0"] =
        file.add_accessor<float>("VEC2", {0, 0, 1, 0, 1, 1, 0, 1});
    primitive["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
    file.add_root({{"mesh", file.add_mesh(primitive)}});
    add_perspective(file, "eye", 0.8f);
    const int times = file.add_accessor<float>("SCALAR", {0, 1});
    const float turn = 0.05f;
    const int wall = file.add_accessor<float>("VEC3", {0, 0, 0, 0.1f, 0.05f, 0.2f});
    const int eye =
        file.add_accessor<float>("VEC4", {0, 0, 0, 1, 0, std::sin(turn), 0, std::cos(turn)});
    file.add(
        "animations",
        {{"samplers", {{{"input", times}, {"output", wall}}, {{"input", times}, {"output", eye}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}});
    scene_ = file.save_glb(folder_.path / "wall.glb").string();
    const auto frame = [&](const char* at) {
        return render({"--lens",       "tessar-100mm-f2.8",
                       "--method",     "fit=fov",
                       "--fstop",      "32",
                       "--focus",      "3",
                       "--at",         at,
                       "--fps",        "1",
                       "--spectral",   "rgb",
                       "--method",     "filter=box",
                       "--background", "1,1,1",
                       "--aov",        "uv,velocity",
                       "--spp",        "64"});
    };
    const io::Picture now = frame("0"), then = frame("1");
    const auto uv = [](const io::Picture& p, int x, int y) {
        const size_t first = (static_cast<size_t>(y) * 16 + static_cast<size_t>(x)) * 8;
        return V2f(p.pixels[first + 4], p.pixels[first + 5]);
    };
    ASSERT_EQ(now.channels[4], "uv.U");
    int checked = 0;
    for (const V2i& px : {V2i(6, 6), V2i(8, 9), V2i(10, 7), V2i(5, 10), V2i(11, 11)}) {
        const V2f velocity = velocity_of(now, px.x, px.y), goal = uv(now, px.x, px.y);
        // Newton's method on the other picture, linear between the centres of its pixels.
        V2f at = V2f(px);
        for (int i = 0; i < 8; ++i) {
            const V2i cell(std::clamp(int(at.x), 0, 14), std::clamp(int(at.y), 0, 14));
            const V2f a = uv(then, cell.x, cell.y), x = uv(then, cell.x + 1, cell.y) - a,
                      y = uv(then, cell.x, cell.y + 1) - a, miss = goal - a;
            const float determinant = x.x * y.y - x.y * y.x;
            at = V2f(cell) + V2f((miss.x * y.y - miss.y * y.x) / determinant,
                                 (x.x * miss.y - x.y * miss.x) / determinant);
        }
        if (!(at.x >= 0 && at.x <= 15 && at.y >= 0 && at.y <= 15)) continue;
        ++checked;
        EXPECT_GT(velocity.length(), 0.3f);
        EXPECT_NEAR(at.x - float(px.x), velocity.x, 0.03f) << px.x << ' ' << px.y;
        EXPECT_NEAR(at.y - float(px.y), velocity.y, 0.03f) << px.x << ' ' << px.y;
    }
    EXPECT_GE(checked, 3);
}

TEST_F(CliTime, RefusesWhatHasNoMeaning) {
    const std::string out = path("a.exr"), many = path("a##.exr");
    const std::vector<std::pair<Words, std::string>> cases = {
        {{"--at", "noon", "-o", out}, "--at: \"noon\" is not a time"},
        {{"--at", "", "-o", out}, "--at"},
        {{"--at", "frame:", "-o", out}, "--at"},
        {{"--at", "nan", "-o", out}, "--at"},
        {{"--at", "1e9", "-o", out}, "--at"},
        {{"--at", "1", "--fps", "0", "-o", out}, "--fps"},
        {{"--animation", "drift", "-o", out}, "needs a time"},
        {{"--loop", "-o", out}, "--loop: needs a time"},
        {{"--at", "1", "--animation", "fly", "-o", out},
         "no animation \"fly\"; it has 0 \"drift\""},
        {{"--at", "1", "--shutter", "0", "-o", out}, "--shutter"},
        {{"--at", "1", "--shutter", "0deg", "-o", out}, "--shutter"},
        {{"--at", "1", "--shutter", "-1/8", "-o", out}, "--shutter"},
        {{"--shutter", "1/8", "-o", out}, "no effect but with --at"},
        {{"--at", "1", "--method", "shutter-curve=box", "-o", out}, "--shutter"},
        {{"--at", "1", "--shutter", "1", "--method", "shutter-curve=bow", "-o", out},
         "neither box"},
        {{"--frames", "1:3", "-o", out}, "put ####"},
        {{"--frames", "3:1", "-o", many}, "not a range of frames"},
        {{"--frames", "1:3:0", "-o", many}, "not a range of frames"},
        {{"--frames", "-1:3", "-o", many}, "not a range of frames"},
        {{"--frames", "0:200000", "-o", many}, "not a range of frames"},
        {{"--frames", "1:2", "--at", "1", "-o", many}, "excludes"},
        {{"--aov", "velocity", "-o", out}, "needs a time"}};
    for (const auto& [words, part] : cases)
        EXPECT_NE(refusal(words).find(part), std::string::npos) << part << '\n' << refusal(words);
}

}  // namespace
}  // namespace petzval::apps
