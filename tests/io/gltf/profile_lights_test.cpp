// SPDX-License-Identifier: Apache-2.0
// EXT_lights_ies.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using nlohmann::json;

// 8 cd straight on, 4 towards x, 2 towards y, 1 and 3 opposite to them; nothing behind.
const std::string kProfile =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 4 1 2 0 0 0\n1 1 60\n0 90\n0 90 180 270\n"
    "8 4\n8 2\n8 1\n8 3\n";

std::span<const uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// A node with a light of this profile.
TinyGltf lit_by_profile(json profile, json node = json::object(), json light = json::object()) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"EXT_lights_ies"};
    file.json["extensions"]["EXT_lights_ies"]["lights"] = json::array({std::move(profile)});
    light["light"] = 0;
    node["extensions"]["EXT_lights_ies"] = std::move(light);
    file.add_root(std::move(node));
    return file;
}

json embedded(const std::string& text) {
    return {{"uri", "data:application/x-ies-lm-63;base64," + base64(bytes_of(text))}};
}

double candela(const Scene& scene, const V3f& direction) {
    const auto& light = std::get<ProfileLight>(scene.lights.at(0));
    const V3f d = unit(direction);
    return double(light.factor[1]) *
           double(scene.profiles.at(light.profile)
                      .intensity(V3f(d.dot(light.x), d.dot(light.y), d.dot(light.f))));
}

TEST(GltfProfileLights, ShineAlongMinusZ) {
    const GltfFile loaded = load(lit_by_profile(embedded(kProfile), {{"translation", {1, 2, 3}}}));
    EXPECT_EQ(std::get<ProfileLight>(loaded.scene.lights.at(0)).position, V3f(1, 2, 3));
    EXPECT_NEAR(candela(loaded.scene, V3f(0, 0, -1)), 8, 1e-5);
    EXPECT_NEAR(candela(loaded.scene, V3f(1, 0, -1e-6f)), 4, 1e-4);
    EXPECT_NEAR(candela(loaded.scene, V3f(0, 1, -1e-6f)), 2, 1e-4);
    EXPECT_NEAR(candela(loaded.scene, V3f(-1, 0, -1e-6f)), 1, 1e-4);
    EXPECT_EQ(candela(loaded.scene, V3f(0, 0, 1)), 0);
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_TRUE(renders(loaded, "EXT_lights_ies"));
    EXPECT_TRUE(contains_line(loaded.contents, "0 directional, 1 by IES profiles"));
}

TEST(GltfProfileLights, TurnAndMirrorButDoNotScale) {
    // A quarter turn about x: -z becomes y, and y becomes z.
    const json turn = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    const GltfFile turned =
        load(lit_by_profile(embedded(kProfile), {{"rotation", turn}, {"scale", {3, 2, 5}}}));
    EXPECT_NEAR(candela(turned.scene, V3f(0, 1, 0)), 8, 1e-5);
    EXPECT_NEAR(candela(turned.scene, V3f(1, 1e-6f, 0)), 4, 1e-4);
    EXPECT_NEAR(candela(turned.scene, V3f(0, 1e-6f, 1)), 2, 1e-4);
    const GltfFile mirrored = load(lit_by_profile(embedded(kProfile), {{"scale", {-1, 1, 1}}}));
    EXPECT_NEAR(candela(mirrored.scene, V3f(-1, 0, -1e-6f)), 4, 1e-4);
    EXPECT_NEAR(candela(mirrored.scene, V3f(0, 1, -1e-6f)), 2, 1e-4);
    const GltfFile flat = load(lit_by_profile(embedded(kProfile), {{"scale", {1, 0, 1}}}));
    EXPECT_TRUE(flat.scene.lights.empty());
    EXPECT_TRUE(contains_line(flat.warnings, "its light is left out"));
}

TEST(GltfProfileLights, MultiplierAndColourAreFactors) {
    const GltfFile loaded =
        load(lit_by_profile(embedded(kProfile), {}, {{"multiplier", 10}, {"color", {0.5, 1, 3}}}));
    const auto& light = std::get<ProfileLight>(loaded.scene.lights.at(0));
    EXPECT_EQ(light.factor[0], 5.f);
    EXPECT_EQ(light.factor[1], 10.f);
    EXPECT_EQ(light.factor[2], 10.f);  // the specification clamps colours to 1
    EXPECT_TRUE(
        load(lit_by_profile(embedded(kProfile), {}, {{"multiplier", 0}})).scene.lights.empty());
}

TEST(GltfProfileLights, LieInViewsAndFilesAndAreReadOnce) {
    const TempFolder folder;
    save_bytes(folder.path / "a.ies", bytes_of(kProfile));
    TinyGltf file = lit_by_profile({{"uri", "a.ies"}});
    auto& lights = file.json["extensions"]["EXT_lights_ies"]["lights"];
    lights.push_back({{"bufferView", file.add_view(bytes_of(kProfile))},
                      {"mimeType", "application/x-ies-lm-63"}});
    for (const int light : {1, 1, 0})
        file.add_root({{"extensions", {{"EXT_lights_ies", {{"light", light}}}}}});
    const GltfFile loaded = load_gltf(file.save_glb(folder.path / "a.glb"));
    EXPECT_EQ(loaded.scene.lights.size(), 4u);
    EXPECT_EQ(loaded.scene.profiles.size(), 2u);
    EXPECT_EQ(loaded.files.size(), 2u);
}

TEST(GltfProfileLights, OnesThatAreNotThereAreLeftOut) {
    const GltfFile loaded = load(lit_by_profile({{"uri", "none.ies"}}));
    EXPECT_TRUE(loaded.scene.lights.empty());
    EXPECT_TRUE(contains_line(loaded.warnings, "there is no file \"none.ies\"; its light is left"));
    EXPECT_TRUE(contains_line(load(lit_by_profile({{"uri", "http://a/b.ies"}})).warnings,
                              "is not a relative path to a file; its light is left out"));
    const GltfFile tilted =
        load(lit_by_profile(embedded("IESNA91\nTILT=a.tlt\n1 -1 1 2 1 1 2 0 0 0\n1 1 60\n"
                                     "0 180\n0\n5 5\n")));
    EXPECT_TRUE(contains_line(tilted.warnings, "/lights/0: its factors for tilted lamps"));
}

TEST(GltfProfileLights, BrokenOnesAreRefused) {
    const auto refused = [](const TinyGltf& file) {
        const TempFolder folder;
        return refusal([&] { (void)load_gltf(file.save_glb(folder.path / "a.glb")); });
    };
    const auto expect = [&](const TinyGltf& file, const std::string& message) {
        EXPECT_NE(refused(file).find(message), std::string::npos) << refused(file);
    };
    const std::string place = "/extensions/EXT_lights_ies/lights/0";
    expect(lit_by_profile(embedded("hello")), place + ": is no IES profile");
    expect(lit_by_profile(embedded(kProfile.substr(0, 70))), place + ": IES profile, line ");
    expect(lit_by_profile(json::object()), place + ": has neither a uri nor a bufferView");
    expect(lit_by_profile({{"bufferView", 3}}), place + "/bufferView");
    expect(lit_by_profile(embedded(kProfile), {}, {{"multiplier", -1}}),
           "/EXT_lights_ies/multiplier");
    expect(lit_by_profile(embedded(kProfile), {}, {{"color", {1, 1}}}), "/EXT_lights_ies/color");
    TinyGltf beyond = lit_by_profile(embedded(kProfile));
    beyond.json["nodes"][0]["extensions"]["EXT_lights_ies"]["light"] = 1;
    expect(beyond, "/nodes/0/extensions/EXT_lights_ies/light: there is no light 1");
}

}  // namespace
}  // namespace petzval::io
