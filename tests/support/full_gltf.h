// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/gltf/validate/source.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_gltf.h"

namespace petzval {

/// Adds what needs no data to full_gltf().
inline void add_scene(TinyGltf& file) {
    using nlohmann::literals::operator""_json;
    file.json["materials"] = R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_ior": {"ior": 1.4},
                       "KHR_materials_dispersion": {"dispersion": 0.3}},
        "extras": {"petzval": {"glass": "schott:N-SF11", "illuminant": "a"}}}])"_json;
    file.json["textures"] = R"([{"source": 0, "sampler": 0}])"_json;
    file.json["samplers"] = R"([{"magFilter": 9728}])"_json;
    file.json["cameras"] = R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}},
        {"type": "orthographic",
         "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}])"_json;
    file.json["nodes"] = R"([{"children": [1, 2], "rotation": [0, 0, 0, 1]},
        {"mesh": 0, "skin": 0, "weights": [0.5]},
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}])"_json;
    file.json["scenes"] = R"([{"nodes": [0]}])"_json;
    file.json["scene"] = 0;
    file.json["extensionsUsed"] =
        R"(["KHR_lights_punctual", "KHR_materials_ior", "KHR_texture_transform",
            "KHR_materials_dispersion"])"_json;
    file.json["extensions"] = R"({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2},
         "extras": {"petzval": {"illuminant": "f11"}}}]}})"_json;
    file.json["animations"] = R"([{"samplers": [{"input": 6, "output": 0}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}])"_json;
}

/// A correct file that uses everything. Accessors: 0 positions, 1 indices, 2 texture coordinates, 3
/// joints, 4 weights, 5 inverse bind matrices, 6 times, 7 sparse scalars. BufferViews: likewise,
/// then 7 and 8 of the sparse one, then 9 an image.
inline TinyGltf full_gltf() {
    TinyGltf file;
    file.add_triangle({{"material", 0}});
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    const int joints = file.add_accessor<uint8_t>("VEC4", std::vector<uint8_t>(12, 0));
    const int weights = file.add_accessor<float>("VEC4", std::vector<float>(12, 0.25f));
    file.add_accessor<float>("MAT4", std::vector<float>(16, 0.f));
    file.add_accessor<float>("SCALAR", {0, 1, 2});
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"].update(
        {{"TEXCOORD_0", uv}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    primitive["targets"] = {{{"POSITION", 0}}};
    file.json["meshes"][0]["weights"] = {0.5};
    file.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 5}}};
    primitive["attributes"]["_SPARSE"] = 7;
    const int at = file.add_view_of<uint16_t>({0, 2});
    const int values = file.add_view_of<float>({5, 6});
    file.add("accessors", {{"componentType", 5126},
                           {"type", "SCALAR"},
                           {"count", 3},
                           {"sparse",
                            {{"count", 2},
                             {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                             {"values", {{"bufferView", values}}}}}});
    file.add_image(std::vector<uint8_t>(8, 1));
    add_scene(file);
    return file;
}

/// The message with which a file, saved as a.glb, is refused.
inline std::string refused_glb(const TinyGltf& file) {
    const TempFolder folder;
    const auto path = file.save_glb(folder.path / "a.glb");
    return refusal([&] { (void)io::read_gltf_source(path); });
}

}  // namespace petzval
