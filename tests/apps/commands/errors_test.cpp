// SPDX-License-Identifier: Apache-2.0
// What the program refuses: one line, an exit code, and nothing left behind.
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

class CliErrors : public CliTest {};

// Starting takes a fifth of a second (some 260 libraries come along), so each rule is tried once or
// twice.
TEST_F(CliErrors, NumbersThatAreNone) {
    expect_refused(2, {{{"--size", "0x0"}, "--size: \"0x0\""},
                       {{"--size", "16"}, "--size: \"16\""},
                       {{"--spp", "-1"}, "--spp: \"-1\" is not a whole number from 1"},
                       {{"--spp", "1.5"}, "--spp: \"1.5\""},
                       {{"--threads", "0"}, "--threads: \"0\""},
                       {{"--seed", "5000000000"}, "--seed: \"5000000000\""},
                       {{"--method", "max-depth=x"}, "--method max-depth: \"x\""},
                       {{"--fov", "0"}, "--fov: \"0\" is not a number from 0.001 to 179"},
                       {{"--fstop", "nan"}, "--fstop: \"nan\""},
                       {{"--method", "lens-radius=inf"}, "--method lens-radius: \"inf\""},
                       {{"--focal-length", "-50"}, "--focal-length: \"-50\""},
                       {{"--method", "filter-radius=1mm"}, "--method filter-radius: \"1mm\""},
                       {{"--exposure", "nan"}, "--exposure: \"nan\""},
                       {{"--time-limit", "0"}, "--time-limit: \"0\""},
                       {{"--time-limit", "10d"}, "--time-limit: \"10d\""}});
}

TEST_F(CliErrors, WordsThatAreNone) {
    expect_refused(2, {{{"--view", "film"}, "\"film\"; there are sRGB, ACES, raw"},
                       {{"--aov", "depth,heat"}, "\"heat\" is not a layer; there are albedo"},
                       {{"--method", "filter=cube"}, "box, gauss, blackman-harris"},
                       {{"--method", "sampler=dice"}, "owen, sobol, independent"},
                       {{"--method", "light-choice=best"}, "tree, power, uniform"},
                       {{"--method", "traversal=slow"}, "robust, fast"},
                       {{"--method", "targets=some"}, "auto, off"},
                       {{"--progress", "loud"}, "auto, bar, lines, json, percent, none"},
                       {{"--frob"}, "--frob"},
                       {{"-o", path("out.tga")}, "must end in .exr, .png, .jpg or .jpeg"},
                       {{"-o", ""}, "must end in .exr"}});
}

TEST_F(CliErrors, ListsThatDoNotFit) {
    expect_refused(2, {{{"--crop", "0,0,17,1"}, "inside the 16x16 frame"},
                       {{"--crop", "0,0,4"}, "x,y,width,height inside the frame"},
                       {{"--crop", "3/2"}, "I/N, the I-th of N bands of the frame"},
                       {{"--crop", "0/2"}, "I/N, the I-th of N bands of the frame"},
                       {{"--crop", "1/2"}, "the number of bands of 16 rows is at most 1"},
                       {{"--look-at", "0,0,0,0,0"}, "--look-at"},
                       {{"--look-at", "1e30,0,0,0,0,0"}, "too far away"},
                       {{"--look-at", "1,2,3,1,2,3"}, "the same point"},
                       {{"--sensor", "-36x24"}, "--sensor"},
                       {{"--background", "-1,0,0"}, "--background"},
                       {{"--background", "nan,0,0"}, "--background"},
                       {{"--fstop", "2", "--focus", "0"}, "--focus: \"0\""},
                       {{"--fstop", "2", "--focus", "16,0"}, "a pixel x,y of the 16x16 frame"}});
}

TEST_F(CliErrors, OptionsThatDoNotGoTogether) {
    expect_refused(2, {{{"--focus", "1"}, "a pinhole has no focus"},
                       {{"--fstop", "2", "--method", "lens-radius=0.1"},
                        "--fstop: excludes --method lens-radius"},
                       {{"--look-at", "0,0,0,0,0,-1", "--camera", "0"}, "excludes --camera"},
                       {{"--env-rotate", "10"}, "--env-rotate: needs --env"},
                       {{"--method", "env-strength=2"}, "--method env-strength: needs --env"},
                       {{"--stats", path("out.exr")}, "--stats"}});
    expect_refused(4, {{{"--size", "65536x65536", "--aov", "normal,position"}, "GiB of memory"}});
}

TEST_F(CliErrors, CommandLinesThatSayTooLittle) {
    EXPECT_NE(error_of({}, 2).find("needs a command"), std::string::npos);
    EXPECT_NE(error_of({"paint"}, 2).find("no command"), std::string::npos);
    EXPECT_NE(error_of({"image"}, 2).find("needs a command"), std::string::npos);
    EXPECT_NE(error_of({"info"}, 2).find("SCENE"), std::string::npos);
    EXPECT_NE(error_of({"render", scene_}, 2).find("--output"), std::string::npos);
    EXPECT_NE(error_of({"render", "-o", path("out.exr")}, 2).find("SCENE"), std::string::npos);
}

TEST_F(CliErrors, WhatTheFileDoesNotHave) {
    expect_refused(2, {{{"--camera", "fish"},
                        scene_ + ": no camera \"fish\"; it has 0 \"wide\", 1 \"tele\", 2 \"plan\""},
                       {{"--camera", "3"}, "no camera \"3\""},
                       {{"--camera", "plan", "--fstop", "2"}, "camera \"plan\" is orthographic"},
                       {{"--camera", "plan", "--fov", "20"}, "camera \"plan\" is orthographic"},
                       {{"--fstop", "2", "--focus", "0,0"}, "focus on under pixel 0,0"},
                       {{"--fstop", "2", "--look-at", "0,0,0,0,0,1"}, "give --focus in metres"},
                       {{"--focal-length", "1e-6"}, "angle of view"}});
}

TEST_F(CliErrors, FilesThatCannotBeRead) {
    const auto render = [&](const std::string& file, const Words& more = {}) {
        Words words = {"render", file, "-o", path("out.exr"), "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return error_of(words, 1);
    };
    const auto broken = [&](const std::string& name, const std::string& text) {
        return save_bytes(folder_.path / name,
                          {reinterpret_cast<const uint8_t*>(text.data()), text.size()})
            .string();
    };
    EXPECT_EQ(render(path("none.glb")), "petzval: error: " + path("none.glb") + ": no such file");
    EXPECT_EQ(render(path("two\nlines.glb")),
              "petzval: error: " + path("two\\u000alines.glb") + ": no such file");
    EXPECT_EQ(render(folder_.path.string()),
              "petzval: error: " + folder_.path.string() + ": is a folder");
    EXPECT_NE(render(broken("cut.glb", file_bytes(scene_).substr(0, 100))).find("cut.glb: "),
              std::string::npos);
    EXPECT_NE(render(broken("not.gltf", "{\n \"asset\": }")).find("not.gltf: line 2, column"),
              std::string::npos);
    TinyGltf bad = studio();
    bad.json["meshes"][0]["primitives"][0]["indices"] = 99;
    EXPECT_NE(render(bad.save_glb(folder_.path / "bad.glb").string())
                  .find("bad.glb: /meshes/0/primitives/0/indices: "),
              std::string::npos);
    EXPECT_NE(error_of({"info", path("none.glb")}, 1).find("none.glb: no such file"),
              std::string::npos);

    EXPECT_NE(render(scene_, {"--env", path("none.hdr")}).find("none.hdr: "), std::string::npos);
    EXPECT_NE(render(scene_, {"--env", broken("sky.hdr", "#?RADIANCE\nhello")}).find("sky.hdr: "),
              std::string::npos);
    EXPECT_NE(render(scene_, {"--env", scene_}).find("studio.glb: an environment must be"),
              std::string::npos);
}

TEST_F(CliErrors, OutputsThatCannotBeWritten) {
    std::filesystem::create_directory(path("folder.exr"));
    std::vector<Case> cases = {{{"--stats", path("none/s.json")}, path("none/s.json")}};
    for (const char* name : {"none/out.exr", "studio.glb/out.exr", "folder.exr"})
        cases.push_back({{"-o", path(name)}, path(name) + ": cannot be written: "});
    expect_refused(3, cases);
}

TEST_F(CliErrors, ADiskThatIsFullLeavesTheOldPicture) {
    for (const char* name : {"out.exr", "out.png", "out.jpg"}) {
        std::ofstream(path(name)) << "the old one";
        Words words = render_words({"-o", path(name), "--quiet"}, scene_);
        ProcessOptions options;
        options.file_size_limit_bytes = 100;
        EXPECT_EQ(error_of(words, 3, options),
                  "petzval: error: " + path(name) +
                      ": cannot be written: File too large; no copy could be kept elsewhere "
                      "either");
        EXPECT_EQ(file_bytes(path(name)), "the old one");
    }
}

TEST_F(CliErrors, MemoryThatRunsOut) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer needs more address space than the test leaves";
#endif
    ProcessOptions options;
    options.address_space_limit_bytes = rlim_t{3} << 30;
    const std::string line = error_of(
        {"render", scene_, "-o", path("out.exr"), "--size", "16000x8000", "--quiet"}, 4, options);
    EXPECT_TRUE(line.starts_with("petzval: error: --size: needs 10.0 GiB of memory, and ")) << line;
}

TEST_F(CliErrors, StandardStreamsThatAreFull) {
    ProcessOptions options;
    options.out = "/dev/full";
    EXPECT_NE(error_of({"info", scene_}, 3, options).find("standard output"), std::string::npos);
    options = {};
    options.err = "/dev/full";
    EXPECT_EQ(run_petzval({"info", path("none.glb")}, options).exit_code, 1);
    EXPECT_EQ(run_petzval(render_words({"-o", path("out.exr")}, scene_), options).exit_code, 0);
}

}  // namespace
}  // namespace petzval::apps
