// SPDX-License-Identifier: Apache-2.0
// What tests of the command line share: a folder, a small scene in it, and renders of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "io/image/picture_files.h"
#include "tests/support/process.h"
#include "tests/support/tiny_gltf.h"

namespace petzval {

using Words = std::vector<std::string>;

inline std::string file_bytes(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// An upright rectangle that faces +z, of a diffuse colour.
inline void add_wall(TinyGltf& file, float x0, float y0, float x1, float y1, float z,
                     std::vector<float> colour) {
    colour.push_back(1.f);
    const int material =
        file.add("materials",
                 {{"pbrMetallicRoughness",
                   {{"baseColorFactor", colour}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                  {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    nlohmann::json primitive = {{"material", material}};
    primitive["attributes"]["POSITION"] =
        file.add_positions({x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z});
    primitive["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
    file.add_root({{"mesh", file.add_mesh(primitive)}});
    if (!file.json.contains("extensionsUsed"))
        file.json["extensionsUsed"] = {"KHR_materials_specular"};
}

inline void add_perspective(TinyGltf& file, const char* name, float yfov_rad) {
    const int camera = file.add("cameras", {{"name", name},
                                            {"type", "perspective"},
                                            {"perspective", {{"yfov", yfov_rad}, {"znear", 0.1}}}});
    file.add_root({{"camera", camera}});
}

/// A wall two metres square, 2 m ahead, and a small one 1 m ahead to the left of the middle.
inline TinyGltf walls() {
    TinyGltf file;
    add_wall(file, -1, -1, 1, 1, -2, {0.2f, 0.4f, 0.8f});
    add_wall(file, -0.6f, -0.2f, -0.2f, 0.2f, -1, {0.8f, 0.8f, 0.8f});
    return file;
}

/// The walls, two lamps, the cameras "wide", "tele" and "plan" (orthographic) at the origin.
inline TinyGltf studio() {
    TinyGltf file = walls();
    add_perspective(file, "wide", 1.2f);
    add_perspective(file, "tele", 0.5f);
    const int plan =
        file.add("cameras",
                 {{"name", "plan"},
                  {"type", "orthographic"},
                  {"orthographic", {{"xmag", 1.5}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 10}}}});
    file.add_root({{"camera", plan}});
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 10}}, {{"type", "point"}, {"intensity", 1}}};
    for (int i = 0; i < 2; ++i)
        file.add_root({{"translation", {0.5 - i, 0.5, 0}},
                       {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    return file;
}

class CliTest : public ::testing::Test {
  protected:
    TempFolder folder_;
    std::string scene_ = studio().save_glb(folder_.path / "studio.glb").string();

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path / name).string();
    }
    /// "render", the scene, and small settings where the words have none of their own.
    [[nodiscard]] Words render_words(const Words& words, const std::string& scene) const {
        Words all = {"render", scene};
        const auto add = [&](const std::string& option, const std::string& value) {
            if (std::find(words.begin(), words.end(), option) == words.end())
                all.insert(all.end(), {option, value});
        };
        add("--size", "16x16");
        if (std::find(words.begin(), words.end(), "--time-limit") == words.end()) add("--spp", "4");
        add("--threads", "2");
        all.insert(all.end(), words.begin(), words.end());
        return all;
    }
    /// Runs a render that must succeed and say nothing; its bytes.
    [[nodiscard]] std::string render_bytes(Words words, const std::string& name = "out.exr") {
        words.insert(words.end(), {"-o", path(name), "--quiet"});
        const Finished run = run_petzval(render_words(words, scene_));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.out + run.err, "");
        return file_bytes(path(name));
    }
    [[nodiscard]] io::Picture render(const Words& words, const std::string& name = "out.exr") {
        EXPECT_FALSE(render_bytes(words, name).empty());
        return io::read_picture(path(name));
    }
    /// Names in the folder.
    [[nodiscard]] std::set<std::string> listing() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path))
            names.insert(entry.path().filename().string());
        return names;
    }
    std::string text_file(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }

    /// A failed run's one line, without its newline.
    static std::string only_line(const Finished& run, int exit_code) {
        EXPECT_EQ(run.exit_code, exit_code) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
        EXPECT_TRUE(run.err.starts_with("petzval: error: ")) << run.err;
        return run.err.substr(0, run.err.find('\n'));
    }
    /// The same of a run that must leave the folder as it was.
    std::string error_of(const Words& words, int exit_code, const ProcessOptions& options = {}) {
        const auto before = listing();
        const std::string line = only_line(run_petzval(words, options), exit_code);
        EXPECT_EQ(listing(), before) << line;
        return line;
    }

    struct Case {
        Words words;
        std::string part;  ///< of the error
    };
    /// Renders of the scene, all at once; words that begin with "render" name their own.
    void expect_refused(int exit_code, const std::vector<Case>& cases) {
        const auto before = listing();
        std::deque<Process> runs;
        for (const Case& c : cases) {
            Words words = c.words;
            words.emplace_back("--quiet");
            if (std::find(words.begin(), words.end(), "-o") == words.end())
                words.insert(words.end(), {"-o", path("out.exr")});
            if (words.front() != "render") words = render_words(words, scene_);
            runs.emplace_back(words);
        }
        for (size_t i = 0; i < cases.size(); ++i) {
            const std::string line = only_line(runs[i].wait(), exit_code);
            EXPECT_NE(line.find(cases[i].part), std::string::npos)
                << line << "\nwithout: " << cases[i].part;
        }
        EXPECT_EQ(listing(), before);
    }
};

/// Waits until a render with --progress json tells of more samples of pixels than these.
inline bool wait_for_samples(Process& render, double more_than) {
    return render.wait_for_stderr([more_than](const std::string& err) {
        const std::string key = "\"pixel_samples\":";
        const size_t last = err.rfind(key);
        return last != std::string::npos && std::stod(err.substr(last + key.size())) > more_than;
    });
}

inline float value_at(const io::Picture& p, int x, int y, const std::string& channel) {
    const int c = io::channel_index(p, channel);
    EXPECT_GE(c, 0) << channel;
    return c < 0 ? 0.f : p.pixels[(size_t(y) * p.width + x) * p.channels.size() + size_t(c)];
}

inline double mean_of(const io::Picture& p, const std::string& channel) {
    double sum = 0;
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) sum += value_at(p, x, y, channel);
    return sum / (double(p.width) * p.height);
}

/// Metadata as text.
inline std::string metadata_of(const io::Picture& p, const std::string& name) {
    for (const auto& [key, value] : p.metadata) {
        if (key != name) continue;
        if (const auto* text = std::get_if<std::string>(&value)) return *text;
        if (const auto* number = std::get_if<float>(&value)) return std::to_string(*number);
        return std::to_string(std::get<int>(value));
    }
    return "(none)";
}

}  // namespace petzval
