// SPDX-License-Identifier: Apache-2.0
// EXT_lights_image_based.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using nlohmann::json;

// Irradiance of pi times 2, 1 and 0.5 from everywhere.
json even_coefficients() {
    json rows = json::array();
    for (int i = 0; i < 9; ++i) rows.push_back({0, 0, 0});
    const double one = double(kPi) / 0.282095;
    rows[0] = {2 * one, one, one / 2};
    return rows;
}

/// A scene under a cube whose faces are each of one colour: +x, -x, +y, -y, +z, -z.
TinyGltf under(const std::array<std::vector<uint8_t>, 6>& faces, json more = json::object()) {
    TinyGltf file;
    json level = json::array();
    for (const auto& face : faces) level.push_back(file.add_image(face));
    more["irradianceCoefficients"] = even_coefficients();
    more["specularImages"] = {level};
    more["specularImageSize"] = 4;
    file.json["extensionsUsed"] = {"EXT_lights_image_based"};
    file.json["extensions"]["EXT_lights_image_based"]["lights"] = {more};
    file.add_root({{"mesh", file.add_triangle()}});
    file.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    return file;
}

std::vector<uint8_t> face(uint8_t r, uint8_t g, uint8_t b, uint8_t a) {
    std::vector<uint8_t> rgba;
    for (int i = 0; i < 16; ++i) rgba.insert(rgba.end(), {r, g, b, a});
    return tiny_png(4, 4, rgba);
}

// 188 is 0.5029 in sRGB. Alphas of RGBD: 255, 51 ...
std::array<std::vector<uint8_t>, 6> six() {
    return {face(255, 0, 0, 255), face(0, 255, 0, 255),   face(188, 188, 188, 255),
            face(255, 0, 0, 51),  face(255, 255, 0, 255), face(0, 0, 255, 255)};
}

void expect_rgb(const Rgb& found, float r, float g, float b) {
    EXPECT_NEAR(found[0], r, 0.01 * r + 1e-3);
    EXPECT_NEAR(found[1], g, 0.01 * g + 1e-3);
    EXPECT_NEAR(found[2], b, 0.01 * b + 1e-3);
}

TEST(GltfImageLight, FacesAreASky) {
    const GltfFile loaded = load(under(six()));
    const Sky& sky = loaded.scene.sky;
    expect_rgb(sky.radiance(V3f(1, 0, 0)), 1, 0, 0);
    expect_rgb(sky.radiance(V3f(-1, 0, 0)), 0, 1, 0);
    expect_rgb(sky.radiance(V3f(0, 1, 0)), 0.5029f, 0.5029f, 0.5029f);
    expect_rgb(sky.radiance(V3f(0, -1, 0)), 5, 0, 0);  // divided by 51/255
    expect_rgb(sky.radiance(V3f(0, 0, 1)), 1, 1, 0);
    expect_rgb(sky.radiance(V3f(0, 0, -1)), 0, 0, 1);
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_TRUE(renders(loaded, "EXT_lights_image_based"));
    EXPECT_TRUE(contains_line(loaded.honoured, "sky of a cube of 4x4 texels"));
}

TEST(GltfImageLight, IntensityAndRotation) {
    // A quarter turn about y: x becomes -z.
    const GltfFile loaded = load(
        under(six(), {{"intensity", 3}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}}));
    const Sky& sky = loaded.scene.sky;
    expect_rgb(sky.radiance(V3f(0, 0, -1)), 3, 0, 0);
    expect_rgb(sky.radiance(V3f(0, 0, 1)), 0, 3, 0);
    expect_rgb(sky.radiance(V3f(1, 0, 0)), 3, 3, 0);
    expect_rgb(sky.radiance(V3f(0, -1, 0)), 15, 0, 0);
    EXPECT_TRUE(load(under(six(), {{"intensity", 0}})).scene.sky.black());
}

TEST(GltfImageLight, OnlyThatOfTheDrawnSceneCounts) {
    TinyGltf file = under(six());
    file.json["scenes"].push_back({{"nodes", {0}}});
    EXPECT_FALSE(load(file).scene.sky.black());
    file.json["scene"] = 1;
    EXPECT_TRUE(load(file).scene.sky.black());
}

TEST(GltfImageLight, CoefficientsStepInForAnImageThatIsNotThere) {
    TinyGltf file = under(six());
    file.json["images"][3] = {{"uri", "none.png"}};
    const GltfFile loaded = load(file);
    for (const V3f& d : {V3f(1, 0, 0), V3f(0, -1, 0), unit(V3f(1, 2, -3))})
        expect_rgb(loaded.scene.sky.radiance(d), 2, 1, 0.5f);
    EXPECT_TRUE(contains_line(loaded.warnings, "lights/0: an image of its cube is not there"));
}

TEST(GltfImageLight, BrokenOnesAreRefused) {
    const std::string light = "/extensions/EXT_lights_image_based/lights/0";
    const auto expect = [&](const std::string& pointer, const json& value,
                            const std::string& message) {
        TinyGltf file = under(six());
        file.json[json::json_pointer(pointer)] = value;
        const TempFolder folder;
        const std::string why =
            refusal([&] { (void)load_gltf(file.save_glb(folder.path / "a.glb")); });
        EXPECT_TRUE(has(why, message));
    };
    expect(light + "/irradianceCoefficients", {1, 2}, "must be 9 arrays of 3 numbers");
    expect(light + "/irradianceCoefficients/8/2", "x", "must be 9 arrays of 3 numbers");
    expect(light + "/specularImages", json::array(), "must be an array of levels");
    expect(light + "/specularImages/0/0", 6, "names an image that is not there");
    expect(light + "/specularImages/0/5", -1, "names an image that is not there");
    expect(light + "/specularImages/0", {1, 2}, "level 0 must name 6 images");
    expect(light + "/intensity", -1, "/lights/0/intensity");
    expect(light + "/rotation", {1, 2}, "/lights/0/rotation");
    expect("/scenes/0/extensions/EXT_lights_image_based/light", 1, "there is no light 1");
    TinyGltf oblong =
        under({face(1, 2, 3, 255), face(1, 2, 3, 255), face(1, 2, 3, 255), face(1, 2, 3, 255),
               face(1, 2, 3, 255), tiny_png(2, 2, std::vector<uint8_t>(16, 9))});
    const TempFolder folder;
    EXPECT_TRUE(has(refusal([&] { (void)load_gltf(oblong.save_glb(folder.path / "a.glb")); }),
                    "/images/5: is 2x2 texels"));
}

}  // namespace
}  // namespace petzval::io
