// SPDX-License-Identifier: Apache-2.0
// Animations with anything in them: each file is shown or refused with an InputError.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <sstream>

#include "io/base/error.h"
#include "tests/support/animation/animated_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::test {
namespace {

using nlohmann::json;

/// Nodes, skin, morph target, material, light and camera, of which something moves each.
AnimatedGltf sample_file() {
    AnimatedGltf file;
    file.add_image(tiny_png(1, 1, {255, 0, 0, 255}));
    file.add("textures", {{"source", 0}});
    file.json["materials"] = json::parse(R"([{
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
            {"KHR_texture_transform": {"offset": [0, 0]}}}},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}}])");
    file.json["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "spot": {}}]}})");
    file.json["cameras"] =
        json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])");
    const int up = file.add_positions({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
    const int joints =
        file.add_accessor<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const int weights =
        file.add_accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1, 1, 1});
    file.add_probe(
        {{"material", 0},
         {"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}, {"TEXCOORD_0", uv}}},
         {"targets", {{{"POSITION", up}}}}});
    file.json["skins"] = {{{"joints", {0}}}};
    file.json["nodes"] = json::parse(R"([
        {"extensions": {"KHR_lights_punctual": {"light": 0}, "KHR_node_visibility": {}}},
        {"camera": 0, "children": [0]}, {"mesh": 0, "skin": 0}, {"mesh": 0}])");
    file.json["scenes"] = {{{"nodes", {1, 2, 3}}}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility",
                                   "KHR_materials_clearcoat", "KHR_texture_transform",
                                   "KHR_animation_pointer"};
    file.add_channel(node_target(0, "translation"), {0, 1}, "VEC3", {0, 0, 0, 1, 2, 3});
    file.add_channel(node_target(0, "rotation"), {0, 1}, "VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
    file.add_channel(node_target(3, "weights"), {0, 1}, "SCALAR", {0, 0, 0, 1, 1, 1},
                     "CUBICSPLINE");
    file.add_channel(pointer_target("/materials/0/pbrMetallicRoughness/baseColorFactor"), {0, 1},
                     "VEC4", {0, 0, 0, 0, 1, 1, 1, 1});
    file.add_channel(pointer_target("/extensions/KHR_lights_punctual/lights/0/intensity"), {0, 1},
                     "SCALAR", {0, 1});
    return file;
}

/// Whether a file is shown; any other exception than an InputError escapes.
bool is_shown(const TinyGltf& file) {
    try {
        (void)load_at(file, 0.3);
        return true;
    } catch (const io::InputError&) {
        return false;
    }
}

TEST(AnimationFuzz, TheSampleIsShown) {
    const io::GltfFile loaded = load_at(sample_file(), 0.3);
    EXPECT_EQ(loaded.warnings, std::vector<std::string>());
    EXPECT_EQ(loaded.scene.instances.size(), 2u);
}

TEST(AnimationFuzz, ValuesOfAnyTypeAnywhereInAnAnimation) {
    const AnimatedGltf original = sample_file();
    const json odd = json::parse(
        R"([null, true, -1, 0, 7, 0.5, 4294967296, 9007199254740993, 1e300, "", "x", "weights",
            "pointer", [], [[]], [0], {}, {"a": 1}])");
    int count = 0, shown = 0;
    const json flat = json{{"animations", original.json["animations"]}}.flatten();
    for (const auto& [place, unused] : flat.items())
        for (json::json_pointer at(place); !at.empty(); at = at.parent_pointer())
            for (const json& value : odd) {
                AnimatedGltf changed = original;
                changed.json[at] = value;
                ++count;
                shown += is_shown(changed);
            }
    EXPECT_GT(count, 1000);
    EXPECT_GT(shown, 100);
}

TEST(AnimationFuzz, PointersOfAnyWords) {
    constexpr std::array words = {"nodes",
                                  "meshes",
                                  "materials",
                                  "cameras",
                                  "skins",
                                  "scenes",
                                  "0",
                                  "1",
                                  "3",
                                  "00",
                                  "-",
                                  "99999999999999999999",
                                  "weights",
                                  "translation",
                                  "rotation",
                                  "scale",
                                  "offset",
                                  "color",
                                  "intensity",
                                  "visible",
                                  "children",
                                  "primitives",
                                  "targets",
                                  "attributes",
                                  "joints",
                                  "extensions",
                                  "lights",
                                  "KHR_lights_punctual",
                                  "spot",
                                  "KHR_node_visibility",
                                  "name",
                                  "extras",
                                  "",
                                  "~1",
                                  "~",
                                  "pbrMetallicRoughness",
                                  "baseColorTexture",
                                  "KHR_texture_transform",
                                  "specularFactor",
                                  "yfov",
                                  "perspective",
                                  "ior"};
    std::mt19937 random(20261124);
    int shown = 0;
    constexpr int kFiles = 1500;
    for (int i = 0; i < kFiles; ++i) {
        std::ostringstream pointer_text;
        // Most begin as those that lead somewhere.
        if (const size_t begin = random() % 16; begin < 9)
            pointer_text << '/' << words[begin % 4] << "/0";
        else if (begin < 12)
            pointer_text << "/extensions/KHR_lights_punctual/lights";
        for (size_t k = 1 + random() % 3; k > 0; --k)
            pointer_text << '/' << words[random() % words.size()];
        const std::string pointer = pointer_text.str();
        AnimatedGltf file = sample_file();
        file.json["animations"] = json::array({file.json["animations"][0]});
        const bool listed = random() % 2;
        const int output = listed ? file.add_accessor<float>("VEC3", {2, 3, 4, -5, 6, 7})
                                  : file.add_accessor<float>("SCALAR", std::vector<float>(8, -1.f));
        file.add_channel_to(output, pointer_target(pointer), {0, 1});
        SCOPED_TRACE(pointer);
        bool is = false;
        EXPECT_NO_THROW(is = is_shown(file)) << pointer;
        shown += is;
    }
    EXPECT_GT(shown, kFiles / 4);
}

}  // namespace
}  // namespace petzval::test
