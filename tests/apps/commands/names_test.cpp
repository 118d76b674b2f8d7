// SPDX-License-Identifier: Apache-2.0
// Names that would act on a terminal or deceive who reads them: nowhere are they shown as they are.
#include "io/base/printable.h"
#include "io/image/picture_files.h"
#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

// A right-to-left override, an escape sequence of one character (CSI), no width, a new line.
const std::string kEvil = "A\u202eB\u009b31mC\u200bD\u2028E\u007fF\nG";
const std::string kShown = "A\\u202eB\\u009b31mC\\u200bD\\u2028E\\u007fF\\u000aG";

class CliNames : public CliTest {
  protected:
    // Whether no line has anything hidden in it.
    static void expect_visible(const std::string& text) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) EXPECT_EQ(line, io::visible(line));
    }
    Finished run(const Words& words) {
        Finished done = run_petzval(words);
        expect_visible(done.out);
        expect_visible(done.err);
        return done;
    }
    std::string evil_scene(const std::function<void(TinyGltf&)>& change = [](TinyGltf&) {}) {
        TinyGltf file = studio();
        file.json["asset"]["generator"] = kEvil;
        for (nlohmann::json& camera : file.json["cameras"]) camera["name"] = kEvil;
        for (nlohmann::json& material : file.json["materials"]) material["name"] = kEvil;
        file.json["extensionsUsed"].push_back(kEvil);
        change(file);
        return file.save_glb(folder_.path / "evil.glb").string();
    }
};

TEST_F(CliNames, InfoShowsThemEscaped) {
    const Finished info = run({"info", evil_scene()});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("  camera 0: " + kShown + ", perspective"), std::string::npos)
        << info.out;
    EXPECT_NE(info.out.find("  generator: " + kShown + "\n"), std::string::npos);
    const Finished lens = run({"info", evil_scene([](TinyGltf& file) {
                                   file.json["cameras"][0]["extras"]["petzval"]["lens"] = kEvil;
                               })});
    EXPECT_NE(lens.out.find("lens " + kShown), std::string::npos) << lens.out;
}

TEST_F(CliNames, ErrorsShowThemEscaped) {
    EXPECT_NE(run(render_words({"-o", path("a.exr"), "--camera", "fish"}, evil_scene()))
                  .err.find("it has 0 \"" + kShown + "\""),
              std::string::npos);
    EXPECT_NE(run(render_words({"-o", path("a.exr"), "--camera", kEvil}, scene_)).err.find(kShown),
              std::string::npos);
    EXPECT_EQ(run({"info", path(kEvil + "\xFF.glb")}).err,
              "petzval: error: " + path(kShown + "\\xff.glb") + ": no such file\n");
    EXPECT_NE(
        run({"info", evil_scene([](TinyGltf& file) { file.json["extensionsRequired"] = {kEvil}; })})
            .err.find(kShown),
        std::string::npos);
    for (const char* key : {"type", kEvil.c_str()})
        EXPECT_EQ(run({"info", evil_scene([&](TinyGltf& file) {
                           file.json["accessors"][0][key] = kEvil;
                           file.json["meshes"][0]["primitives"][0]["attributes"]["_" + kEvil] =
                               7777;
                       })})
                      .exit_code,
                  1);
}

TEST_F(CliNames, NoticesAndMetadataShowThemEscaped) {
    const std::string scene = evil_scene([](TinyGltf& file) {
        file.json["materials"][0]["extras"]["petzval"]["metal"] = "au";
        file.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
    });
    const Finished text =
        run(render_words({"-o", path("a.exr"), "--progress", "none", "--camera", kShown}, scene));
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.err.find("material \"" + kShown + "\" is a measured metal"), std::string::npos)
        << text.err;
    EXPECT_EQ(metadata_of(io::read_picture(path("a.exr")), "petzval:camera"), kShown);
    const Finished as_json =
        run(render_words({"-o", path("a.exr"), "--progress", "json", "--camera", kEvil}, scene));
    EXPECT_EQ(as_json.exit_code, 0) << as_json.err;
    std::istringstream lines(as_json.err);
    for (std::string line; std::getline(lines, line);)
        EXPECT_TRUE(nlohmann::json::accept(line)) << line;
}

TEST_F(CliNames, ThePlanQuotesThemForAShell) {
    const std::string name = path("a'b\\c\u202e\xFF.glb");
    std::filesystem::rename(scene_, name);
    const Words words = {"plan", name, "--size", "8x8", "--tolerance", "100%"};
    const Finished plan = run(words);
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_NE(plan.out.find("render $'" + path("a\\'b\\\\c\\u202e\\xff.glb") + "' "),
              std::string::npos)
        << plan.out;
    Words asked = words;
    asked.push_back("--json");
    EXPECT_EQ(run(asked).exit_code, 0);
}

TEST_F(CliNames, LensFilesToo) {
    nlohmann::json lens =
        nlohmann::json::parse(file_bytes(PETZVAL_ASSETS "/lenses/tessar-100mm-f2.8.json"));
    for (const char* key : {"name", "title", "source"}) lens[key] = "A\u202eB\u009b31mC";
    const std::string file = text_file("lens.json", lens.dump());
    const Finished show = run({"lens", "show", file});
    EXPECT_EQ(show.exit_code, 0) << show.err;
    EXPECT_TRUE(show.out.starts_with("A\\u202eB\\u009b31mC: A\\u202eB")) << show.out;
    EXPECT_TRUE(run({"lens", "check", file}).out.starts_with("A\\u202eB\\u009b31mC\n"));
    EXPECT_EQ(run({"lens", "check", file, "--json"}).exit_code, 0);
    EXPECT_EQ(run({"lens", "draw", file, "-o", path("lens.svg")}).exit_code, 0);
    expect_visible(file_bytes(path("lens.svg")));
    EXPECT_EQ(run({"lens", "spot", file, "-o", path("spot.svg")}).exit_code, 0);
    EXPECT_EQ(file_bytes(path("spot.svg")).find("\u202e"), std::string::npos);
}

}  // namespace
}  // namespace petzval::apps
