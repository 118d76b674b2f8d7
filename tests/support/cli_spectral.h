// SPDX-License-Identifier: Apache-2.0
// What tests of renders with wavelengths share: scenes that need them, lights and sensors in files.
#pragma once

#include <functional>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/observer.h"
#include "core/spectrum/spectrum_table.h"
#include "io/spectra/spectra.h"
#include "tests/support/cli.h"

namespace petzval {

using nlohmann::json;

/// A wall of its own colour fills the frame of "wide"; more: what its material has beside.
inline TinyGltf big_wall(const json& more) {
    TinyGltf file;
    add_wall(file, -9, -9, 9, 9, -2, {0, 0, 0});
    file.json["materials"][0].update(more);
    for (const char* extension : {"KHR_materials_transmission", "KHR_materials_volume",
                                  "KHR_materials_dispersion", "KHR_lights_punctual"})
        file.json["extensionsUsed"].push_back(extension);
    add_perspective(file, "wide", 1.2f);
    return file;
}

inline json extras(const char* key, const char* value) {
    return {{"extras", {{"petzval", {{key, value}}}}}};
}

/// A lamp of 1 nit.
inline TinyGltf lamp(json more = json::object()) {
    more["emissiveFactor"] = {1, 1, 1};
    return big_wall(more);
}

inline json glass(json more = json::object()) {
    more["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    more["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    more["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    return more;
}

inline json metal(const char* name) {
    json more = extras("metal", name);
    more["pbrMetallicRoughness"] = {{"roughnessFactor", 0.3}};
    return more;
}

/// The studio with a pane of glass, gold and a lamp of illuminant A: all that needs wavelengths.
inline TinyGltf mixed() {
    TinyGltf file = studio();
    const auto add = [&](float x, float y, const json& more) {
        add_wall(file, x, y, x + 0.4f, y + 0.4f, -0.9f, {0.5f, 0.5f, 0.5f});
        file.json["materials"].back().update(more);
    };
    add(0, 0, glass(extras("glass", "schott:N-SF11")));
    add(-0.5f, -0.5f, metal("au"));
    json bulb = extras("illuminant", "a");
    bulb["emissiveFactor"] = {1, 1, 1};
    add(0, -0.5f, bulb);
    for (const char* extension : {"KHR_materials_transmission", "KHR_materials_volume"})
        file.json["extensionsUsed"].push_back(extension);
    return file;
}

class CliSpectral : public CliTest {
  protected:
    /// A CSV file of a column for each number that `row` gives, at every nanometre.
    std::string csv(const std::string& name, const std::function<std::vector<double>(int)>& row) {
        std::ofstream file(path(name));
        file << "nm";
        for (size_t i = 0; i < row(kFirst_nm).size(); ++i) file << ",curve" << i;
        file.precision(9);
        for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
            file << '\n' << nm;
            for (const double value : row(nm)) file << ',' << value;
        }
        return path(name);
    }
    /// A sensor whose curves are mixtures of the eye's, so that a matrix undoes them.
    std::string mixed_eye() {
        const auto eye = io::standard_observer();
        return csv("eye.csv", [&](int nm) -> std::vector<double> {
            const double x = eye[0].at_nm(nm), y = eye[1].at_nm(nm), z = eye[2].at_nm(nm);
            return {0.9 * x + 0.2 * y, 0.1 * x + 0.8 * y + 0.1 * z, 0.1 * y + 0.9 * z};
        });
    }
    void use(const TinyGltf& scene) {
        scene_ = scene.save_glb(folder_.path / "scene.glb").string();
    }
    /// stderr of a render that must succeed.
    std::string said(const Words& words, const std::string& name = "out.exr") {
        Words all = {"-o", path(name), "--progress", "none"};
        all.insert(all.end(), words.begin(), words.end());
        const Finished run = run_petzval(render_words(all, scene_));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return run.err;
    }
    /// Renders of 48x32 pixels and six samples are equal for all numbers of threads, in crops of
    /// these channels, and merged from ranges. with: the words of a render, these included.
    void expect_equal_renders(const std::function<Words(Words)>& with, const Words& channels) {
        const io::Picture whole = render(with({"--spp", "6"}), "whole.exr");
        const std::string bytes = file_bytes(path("whole.exr"));
        EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "1"})));
        EXPECT_TRUE(bytes == render_bytes(with({"--spp", "6", "--threads", "4"})));
        const io::Picture part = render(with({"--spp", "6", "--crop", "13,5,20,11"}));
        for (int y = 0; y < 11; ++y)
            for (int x = 0; x < 20; ++x)
                for (const std::string& c : channels)
                    ASSERT_EQ(value_at(part, x, y, c), value_at(whole, x + 13, y + 5, c));
        for (const char* range : {"0:2", "2:6"})
            EXPECT_EQ(run_petzval(render_words(with({"--spp", range, "-o",
                                                     path(std::string(1, range[0]) + ".state")}),
                                               scene_))
                          .exit_code,
                      0);
        EXPECT_EQ(run_petzval({"merge", path("0.state"), path("2.state"), "-o", path("merged.exr"),
                               "--quiet"})
                      .exit_code,
                  0);
        EXPECT_TRUE(bytes == file_bytes(path("merged.exr")));
    }
};

}  // namespace petzval
