// SPDX-License-Identifier: Apache-2.0
// Mistakes with colour spaces that a glTF file can be told from.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_jpeg.h"
#include "tests/support/tiny_profile.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using Bytes = std::vector<uint8_t>;

/// A triangle with this material, whose texture 0 is the image.
TinyGltf shown_colour(json material, const Bytes& image, const char* mime_type = "image/png") {
    TinyGltf file;
    file.add_image(image, mime_type);
    file.add("textures", {{"source", 0}});
    file.add("materials", std::move(material));
    file.add_root({{"mesh", file.add_triangle({{"material", 0}})}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    return file;
}

Bytes png_of(uint8_t r, uint8_t g, uint8_t b, const Bytes& extra = {}) {
    return tiny_png(1, 1, 8, PngColour::Rgb, {{r, g, b}}, extra);
}

const json kTexture = {{"index", 0}};
const json kBase = {{"pbrMetallicRoughness", {{"baseColorTexture", kTexture}}}};
const json kNormal = {{"normalTexture", kTexture}};
const json kBoth = {{"pbrMetallicRoughness", {{"baseColorTexture", kTexture}}},
                    {"normalTexture", kTexture}};

size_t lines_with(const std::vector<std::string>& lines, const std::string& part) {
    return size_t(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.find(part) != std::string::npos;
    }));
}

TEST(GltfColours, OtherSpacesAreNamedWhereColoursAreRead) {
    const Bytes image =
        png_of(1, 2, 3, png_profile_chunk(tiny_profile(kAdobePrimaries, 2.2, "Adobe RGB (1998)")));
    const GltfFile colours = load(shown_colour(kBase, image));
    EXPECT_EQ(lines_with(colours.warnings,
                         "/images/0: says that its colours are in the profile "
                         "Adobe RGB (1998); glTF takes them for sRGB"),
              1u);
    EXPECT_TRUE(
        load(shown_colour({{"pbrMetallicRoughness", {{"metallicRoughnessTexture", kTexture}}}},
                          image))
            .warnings.empty());
    EXPECT_TRUE(load(shown_colour(kBase, png_of(1, 2, 3))).warnings.empty());
}

TEST(GltfColours, InksAreNamed) {
    const Bytes image = tiny_jpeg({.components = {{1}, {2}, {3}, {4}}, .adobe_transform = 0});
    EXPECT_EQ(
        lines_with(load(shown_colour(kBase, image, "image/jpeg")).warnings, "is in CMYK inks"), 1u);
}

TEST(GltfColours, OneImageAsColoursAndAsNumbers) {
    const GltfFile both = load(shown_colour(kBoth, png_of(128, 128, 255)));
    EXPECT_EQ(lines_with(both.warnings,
                         "/images/0: is read as colours in sRGB by "
                         "/materials/0/pbrMetallicRoughness/baseColorTexture, and as numbers by "
                         "/materials/0/normalTexture"),
              1u);
    // Numbers in one alone, or colours; and alpha, which is linear in either.
    json emissive = kBase;
    emissive["emissiveTexture"] = kTexture;
    emissive["emissiveFactor"] = {1, 1, 1};
    json numbers = kNormal;
    numbers["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", kTexture}};
    json alpha = json::object();
    alpha["extensions"]["KHR_materials_specular"] = {{"specularTexture", kTexture},
                                                     {"specularColorTexture", kTexture}};
    for (const json& fine : {emissive, numbers, alpha}) {
        TinyGltf file = shown_colour(fine, png_of(128, 128, 255));
        file.json["extensionsUsed"] = {"KHR_materials_specular"};
        EXPECT_TRUE(load(file).warnings.empty()) << fine;
    }
}

TEST(GltfColours, NormalMapsThatWentThroughTheCurveOfSrgb) {
    // 1/2 encoded is 0.735, and decoded 0.214.
    EXPECT_EQ(lines_with(load(shown_colour(kNormal, png_of(188, 187, 255))).warnings,
                         "0.74 on average instead of 0.5, as if it had been encoded as sRGB"),
              1u);
    EXPECT_EQ(
        lines_with(load(shown_colour(kNormal, png_of(55, 54, 250))).warnings, "decoded from sRGB"),
        1u);
    for (const Bytes& good : {png_of(128, 128, 255), png_of(188, 128, 255), png_of(188, 187, 100)})
        EXPECT_TRUE(load(shown_colour(kNormal, good)).warnings.empty());
    EXPECT_TRUE(load(shown_colour(kBase, png_of(188, 187, 255))).warnings.empty());
}

}  // namespace
}  // namespace petzval::io
