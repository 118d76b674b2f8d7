// SPDX-License-Identifier: Apache-2.0
// --progress json: each line is an object of the schema in docs/guide/render.md, whatever happens.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/cli.h"
#include "tests/support/tiny_png.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

class CliProgressJson : public CliTest {
  protected:
    /// Events of a run, which ends with that exit code; every line must be one.
    std::vector<json> events(const Words& words, int exit_code) {
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, exit_code) << run.err;
        std::vector<json> all;
        std::istringstream in(run.err);
        for (std::string line; std::getline(in, line);) {
            const json event = json::parse(line, nullptr, false);
            EXPECT_TRUE(event.is_object()) << line;
            if (!event.is_object()) continue;
            EXPECT_EQ(event.value("schema", ""), "petzval.progress") << line;
            EXPECT_EQ(event.value("version", 0), 1) << line;
            all.push_back(event);
        }
        EXPECT_FALSE(all.empty());
        if (!all.empty()) {
            EXPECT_EQ(all.back().value("event", ""), "end");
            EXPECT_EQ(all.back().value("exit_code", -1), exit_code);
        }
        return all;
    }
    std::vector<json> render_events(const Words& more, const std::string& scene, int exit_code) {
        Words words = {"-o", path("out.exr"), "--progress", "json"};
        words.insert(words.end(), more.begin(), more.end());
        return events(render_words(words, scene), exit_code);
    }
    static std::vector<json> of_kind(const std::vector<json>& all, const std::string& kind) {
        std::vector<json> out;
        for (const json& event : all)
            if (event.at("event") == kind) out.push_back(event);
        return out;
    }
};

TEST_F(CliProgressJson, PhasesNoticesAndTheEnd) {
    const std::string dark = walls().save_glb(folder_.path / "dark.glb").string();
    const auto all = render_events({"--fstop", "2", "--lens", "tessar-100mm-f2.8"}, dark, 0);
    std::set<std::string> begun;  // each again after two seconds
    std::vector<std::string> ended;
    for (const json& event : of_kind(all, "phase")) {
        EXPECT_GE(event.at("elapsed_s"), 0);
        if (event.at("ended"))
            ended.push_back(event.at("phase"));
        else
            begun.insert(event.at("phase"));
    }
    const std::vector<std::string> phases = {"loading", "bvh", "planning", "rendering", "writing"};
    EXPECT_EQ(ended, phases);
    EXPECT_EQ(begun.size(), 4u) << "rendering begins with progress";
    const auto notices = of_kind(all, "notice"), warnings = of_kind(all, "warning");
    ASSERT_FALSE(notices.empty());
    EXPECT_NE(notices[0].at("notice").get<std::string>().find("nothing lights"), std::string::npos);
    ASSERT_FALSE(warnings.empty());
    EXPECT_TRUE(warnings[0].at("notice").get<std::string>().starts_with("warning: "));
    const json last = of_kind(all, "progress").back();
    EXPECT_EQ(last.at("phase"), "rendering");
    EXPECT_EQ(last.at("fraction"), 1);
    EXPECT_EQ(last.at("pixel_samples"), 16 * 16 * 4);
    EXPECT_EQ(last.at("remaining_s"), 0);
    EXPECT_GE(last.at("samples_per_s"), 0);
    EXPECT_GE(last.at("elapsed_s"), 0);
}

TEST_F(CliProgressJson, ATimeLimitEndsAtOne) {
    const auto all = render_events({"--time-limit", "0.2s"}, scene_, 0);
    EXPECT_EQ(of_kind(all, "progress").back().at("fraction"), 1);
}

// libpng prints a line of its own about a picture that it cannot read.
TEST_F(CliProgressJson, WhatLibrariesPrintIsInItToo) {
    auto png = tiny_png(2, 2, std::vector<uint8_t>(16, 200));
    png[png.size() - 20] ^= 0x55;  // in the data
    save_bytes(folder_.path / "iris.png", png);
    const Words iris = {"--lens", "tessar-100mm-f2.8", "--aperture", path("iris.png")};
    Words words = {"-o", path("out.exr"), "--progress", "none"};
    words.insert(words.end(), iris.begin(), iris.end());
    const Finished plain = run_petzval(render_words(words, scene_));
    ASSERT_NE(plain.err.find("libpng error"), std::string::npos) << plain.err;
    const auto all = render_events(iris, scene_, 1);
    ASSERT_EQ(of_kind(all, "library").size(), 1u);
    EXPECT_NE(of_kind(all, "library")[0].at("text").get<std::string>().find("libpng error"),
              std::string::npos);
    EXPECT_EQ(of_kind(all, "error").size(), 1u);
}

TEST_F(CliProgressJson, ErrorsAreInItToo) {
    const auto error = [&](const std::vector<json>& all) {
        const auto errors = of_kind(all, "error");
        EXPECT_EQ(errors.size(), 1u);
        return errors.empty() ? "" : errors[0].at("error").get<std::string>();
    };
    EXPECT_EQ(error(render_events({}, path("none\n.glb"), 1)),
              path("none\n.glb") + ": no such file");
    EXPECT_NE(error(render_events({"--spp", "x"}, scene_, 2)).find("--spp"), std::string::npos);
    for (const char* style : {"--progress=json", "--progress=JSON"})
        EXPECT_NE(error(events({"render", style, "--frob"}, 2)).find("--help"), std::string::npos);
    EXPECT_NE(error(render_events({"--stats", path("none/s.json")}, scene_, 3)).find("s.json"),
              std::string::npos);
    const Finished quiet = run_petzval(
        {"render", path("none.glb"), "-o", path("out.exr"), "--progress", "json", "--quiet"});
    EXPECT_EQ(json::parse(quiet.err).at("event"), "error");
    const std::string latin1 = path("\xe9.glb");
    EXPECT_NE(error(render_events({}, latin1, 1)).find("no such file"), std::string::npos);
}

TEST_F(CliProgressJson, AStopIsInItToo) {
    Process render(
        render_words({"-o", path("out.exr"), "--spp", "100000000", "--progress", "json"}, scene_));
    ASSERT_TRUE(wait_for_samples(render, 16 * 16));
    render.signal(SIGTERM);
    const Finished run = render.wait();
    EXPECT_EQ(run.exit_code, 130);
    std::istringstream in(run.err);
    std::vector<json> all;
    for (std::string line; std::getline(in, line);) all.push_back(json::parse(line));
    EXPECT_EQ(all.back().at("event"), "end");
    EXPECT_EQ(all.back().at("exit_code"), 130);
    EXPECT_LT(of_kind(all, "progress").back().at("fraction"), 1);
}

}  // namespace
}  // namespace petzval::apps
