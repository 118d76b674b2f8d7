// SPDX-License-Identifier: Apache-2.0
// KHR_materials_pbrSpecularGlossiness: the closed forms of its text, at a hit.
#include <gtest/gtest.h>

#include "core/shading/surface.h"
#include "core/spectrum/colour.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr const char* kName = "KHR_materials_pbrSpecularGlossiness";

/// A triangle of this material, with texture coordinates.
TinyGltf file_with(json material) {
    TinyGltf file;
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    if (material.contains("extensions"))
        for (const auto& [name, unused] : material["extensions"].items())
            file.json["extensionsUsed"].push_back(name);
    file.add("materials", std::move(material));
    file.add_triangle({{"material", 0}, {"attributes", {{"TEXCOORD_0", uv}}}});
    file.add_root({{"mesh", 0}});
    return file;
}

TinyGltf glossy(json values) {
    return file_with({{"extensions", {{kName, std::move(values)}}}});
}

int add_rgba_texture(TinyGltf& file, std::vector<uint8_t> rgba) {
    return file.add("textures", {{"source", file.add_image(tiny_png(1, 1, std::move(rgba)))}});
}

const Bands kRgb = Bands::rgb();
const V3f kFront(0.f, 0.f, 1.f);

ShadingInput shading_of(const TinyGltf& file) {
    const GltfFile loaded = load(file);
    const Surface s = make_surface(loaded.scene, -kFront, Hit{V2f(0.25f, 0.25f), 0, 0});
    return read_material(loaded.scene, s, kFront, kRgb);
}

/// Expects that two files reflect alike, from and into several directions.
void expect_same_reflection(const TinyGltf& a, const TinyGltf& b) {
    const BsdfInput one = shading_of(a).bsdf, other = shading_of(b).bsdf;
    for (const float from : {0.05f, 0.4f, 1.f})
        for (const float into : {0.1f, 0.6f, 0.99f})
            for (const float azimuth : {0.2f, 3.f}) {
                const auto at = [](float cosine, float turn) {
                    const float sine = std::sqrt(1 - cosine * cosine);
                    return V3f(sine * std::cos(turn), sine * std::sin(turn), cosine);
                };
                const V3f wo = at(from, 0), wi = at(into, azimuth);
                const f4 x = Bsdf(one, kRgb, wo).eval(wi).f_cos;
                const f4 y = Bsdf(other, kRgb, wo).eval(wi).f_cos;
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(x[k], y[k], 2e-5f * y[k] + 1e-7f) << from << ' ' << into << k;
            }
}

// The text's own example, and its twin in the core material.
TEST(GltfGlossiness, GoldIsTheMetalOfThatColour) {
    expect_same_reflection(
        glossy({{"diffuseFactor", {0, 0, 0, 1}},
                {"specularFactor", {1, 0.766, 0.336}},
                {"glossinessFactor", 0.9}}),
        file_with({{"pbrMetallicRoughness",
                    {{"baseColorFactor", {1, 0.766, 0.336, 1}}, {"roughnessFactor", 0.1}}}}));
}

// 4 % is the reflectance of an index of 1.5; the diffuse colour loses as much.
TEST(GltfGlossiness, PlasticIsTheDielectricOfTheRestOfItsColour) {
    expect_same_reflection(glossy({{"diffuseFactor", {0.5, 0.25, 1, 1}},
                                   {"specularFactor", {0.04, 0.04, 0.04}},
                                   {"glossinessFactor", 0.3}}),
                           file_with({{"pbrMetallicRoughness",
                                       {{"baseColorFactor", {0.48, 0.24, 0.96, 1}},
                                        {"metallicFactor", 0},
                                        {"roughnessFactor", 0.7}}}}));
}

TEST(GltfGlossiness, DefaultsAreWhiteMirrors) {
    const BsdfInput b = shading_of(glossy(json::object())).bsdf;
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(b.dielectric_f0[k], 1.f);
        EXPECT_EQ(b.base_color[k], 0.f);
    }
    EXPECT_EQ(b.dielectric_f90, 1.f);
    EXPECT_EQ(b.roughness, 0.f);
    EXPECT_EQ(b.metallic, 0.f);
}

// Colours of textures are encoded by sRGB, glossiness and coverage are not.
TEST(GltfGlossiness, TexturesScaleTheFactors) {
    TinyGltf file = glossy({{"diffuseFactor", {0.5, 0.5, 0.25, 0.5}},
                            {"specularFactor", {0.5, 0.25, 1}},
                            {"glossinessFactor", 0.75}});
    json& material = file.json["materials"][0];
    material["alphaMode"] = "BLEND";
    json& values = material["extensions"][kName];
    values["diffuseTexture"] = {{"index", add_rgba_texture(file, {200, 100, 50, 102})}};
    values["specularGlossinessTexture"] = {{"index", add_rgba_texture(file, {60, 255, 120, 51})}};
    const float specular[3] = {0.5f * srgb_to_linear(60 / 255.f), 0.25f,
                               srgb_to_linear(120 / 255.f)};
    const float diffuse[3] = {0.5f * srgb_to_linear(200 / 255.f),
                              0.5f * srgb_to_linear(100 / 255.f),
                              0.25f * srgb_to_linear(50 / 255.f)};
    const BsdfInput b = shading_of(file).bsdf;
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(b.dielectric_f0[k], specular[k], 1e-6f);
        EXPECT_NEAR(b.base_color[k], diffuse[k] * (1 - 0.25f), 1e-6f);
    }
    EXPECT_NEAR(b.roughness, 1 - 0.75f * 0.2f, 1e-6f);
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.materials[0].alpha, 0.5f);
    EXPECT_NEAR(sample_texture(loaded.scene.images, loaded.scene.materials[0].base_color_texture,
                               V2f(0.5f))[3],
                0.4f, 1e-6f);
}

TEST(GltfGlossiness, GoesBeforeTheCoreMaterialAndItsLayers) {
    TinyGltf file = glossy({{"diffuseFactor", {0.2, 0.2, 0.2, 1}}, {"glossinessFactor", 0}});
    json& material = file.json["materials"][0];
    const int image = add_rgba_texture(file, {1, 2, 3, 4});
    material["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", image}}},
                                        {"metallicRoughnessTexture", {{"index", image}}}};
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.scene.images.empty());
    const Material& m = loaded.scene.materials.at(0);
    EXPECT_EQ(m.base_color[0], 0.2f);
    EXPECT_EQ(m.roughness, 1.f);
    EXPECT_EQ(m.specular, 1.f);
    EXPECT_EQ(m.transmission, 0.f);

    material["extensions"]["KHR_materials_unlit"] = json::object();
    EXPECT_FALSE(load(file).scene.materials.at(0).specular_glossiness);
    EXPECT_EQ(load(file).scene.images.size(), 1u);
}

}  // namespace
}  // namespace petzval::io
