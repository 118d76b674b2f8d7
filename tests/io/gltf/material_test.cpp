// SPDX-License-Identifier: Apache-2.0
// Materials: factors and extensions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/gltf_material.h"

namespace petzval::io {
namespace {

using namespace test::gltf_material;
using nlohmann::json;

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
    TinyGltf bare;
    bare.add_triangle();
    bare.add_root({{"mesh", 0}});
    for (const Material& m : {material_of(json::object()), load_material(bare)}) {
        expect_rgb(m.base_color, 1, 1, 1);
        EXPECT_EQ(m.alpha, 1.f);
        EXPECT_EQ(m.metallic, 1.f);
        EXPECT_EQ(m.roughness, 1.f);
        EXPECT_FALSE(m.emits());
        EXPECT_EQ(m.alpha_mode, AlphaMode::Opaque);
        EXPECT_FALSE(m.double_sided);
        EXPECT_FALSE(m.unlit);
        EXPECT_EQ(m.ior, 1.5f);
        EXPECT_EQ(m.specular, 1.f);
        EXPECT_EQ(m.transmission, 0.f);
        EXPECT_FALSE(m.has_volume);
        EXPECT_FALSE(m.base_color_texture.present());
    }
}

/// Numbers of what extensions say.
std::vector<float> layers_of(const Material& m) {
    return {m.emissive[0],
            m.ior,
            m.specular,
            m.specular_color[2],
            m.transmission,
            m.attenuation_color[1],
            m.has_volume ? 1 : 0.f,
            m.attenuation_distance_m,
            m.coat,
            m.coat_roughness,
            m.coat_normal_scale,
            m.sheen_color[0],
            m.sheen_roughness,
            m.anisotropy,
            m.anisotropy_rotation_rad,
            m.iridescence,
            m.film_ior,
            m.film_thinnest_nm,
            m.film_thickest_nm,
            m.diffuse_transmission,
            m.diffuse_transmission_color[1]};
}

TEST(GltfMaterial, ExtensionsThatSayNothingChangeNothing) {
    const Material none = material_of(json::object());
    EXPECT_EQ(layers_of(none), layers_of(Material{}));
    for (const char* name :
         {"anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "emissive_strength",
          "ior", "iridescence", "sheen", "specular", "transmission", "volume"})
        EXPECT_EQ(layers_of(load_material(file_with_extension(
                      (std::string("KHR_materials_") + name).c_str(), json::object()))),
                  layers_of(none))
            << name;
}

TEST(GltfMaterial, Factors) {
    const Material m = material_of({{"name", "brass"},
                                    {"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                      {"metallicFactor", 0.5},
                                      {"roughnessFactor", 0.6}}},
                                    {"emissiveFactor", {0.7, 0.8, 0.9}},
                                    {"alphaMode", "MASK"},
                                    {"alphaCutoff", 0.25},
                                    {"doubleSided", true}});
    EXPECT_EQ(m.name, "brass");
    expect_rgb(m.base_color, 0.1f, 0.2f, 0.3f);
    EXPECT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.6f);
    expect_rgb(m.emissive, 0.7f, 0.8f, 0.9f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(material_of({{"alphaMode", "BLEND"}}).alpha_mode, AlphaMode::Blend);
}

TEST(GltfMaterial, EmissiveStrengthScalesTheFactor) {
    TinyGltf file =
        file_with_extension("KHR_materials_emissive_strength", {{"emissiveStrength", 1000}});
    file.json["materials"][0]["emissiveFactor"] = {1, 0.5, 0.25};
    expect_rgb(load_material(file).emissive, 1000, 500, 250);
}

TEST(GltfMaterial, IorSpecularTransmissionVolume) {
    EXPECT_EQ(load_material(file_with_extension("KHR_materials_ior", {{"ior", 2.42}})).ior, 2.42f);
    EXPECT_EQ(load_material(file_with_extension("KHR_materials_ior", {{"ior", 0}})).ior, 0.f);

    const Material specular = load_material(file_with_extension(
        "KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {0.1, 2, 3}}}));
    EXPECT_EQ(specular.specular, 0.5f);
    expect_rgb(specular.specular_color, 0.1f, 2, 3);

    EXPECT_EQ(load_material(
                  file_with_extension("KHR_materials_transmission", {{"transmissionFactor", 0.75}}))
                  .transmission,
              0.75f);

    const Material volume = load_material(
        file_with_extension("KHR_materials_volume", {{"thicknessFactor", 0.01},
                                                     {"attenuationDistance", 5000000000},
                                                     {"attenuationColor", {0.2, 0.4, 0.6}}}));
    EXPECT_TRUE(volume.has_volume);
    EXPECT_EQ(volume.attenuation_distance_m, 5e9f);
    expect_rgb(volume.attenuation_color, 0.2f, 0.4f, 0.6f);
    const Material white = load_material(file_with_extension(
        "KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1e-7}}));
    EXPECT_EQ(white.attenuation_distance_m, kInfinity);
    const Material thin =
        load_material(file_with_extension("KHR_materials_volume", json::object()));
    EXPECT_FALSE(thin.has_volume);
    EXPECT_EQ(thin.attenuation_distance_m, kInfinity);
}

TEST(GltfMaterial, LayersOfExtensions) {
    const Material coat = load_material(file_with_extension(
        "KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}}));
    EXPECT_EQ(coat.coat, 0.5f);
    EXPECT_EQ(coat.coat_roughness, 0.25f);
    const Material sheen = load_material(file_with_extension(
        "KHR_materials_sheen",
        {{"sheenColorFactor", {0.25, 0.5, 1}}, {"sheenRoughnessFactor", 0.75}}));
    expect_rgb(sheen.sheen_color, 0.25f, 0.5f, 1);
    EXPECT_EQ(sheen.sheen_roughness, 0.75f);
    const Material brushed = load_material(file_with_extension(
        "KHR_materials_anisotropy",
        {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 0.5 + 2000 * std::numbers::pi}}));
    EXPECT_EQ(brushed.anisotropy, 0.5f);
    EXPECT_NEAR(brushed.anisotropy_rotation_rad, 0.5f, 1e-6f);
    const Material film = load_material(
        file_with_extension("KHR_materials_iridescence", {{"iridescenceFactor", 0.5},
                                                          {"iridescenceIor", 1.5},
                                                          {"iridescenceThicknessMinimum", 200},
                                                          {"iridescenceThicknessMaximum", 600}}));
    EXPECT_EQ(film.iridescence, 0.5f);
    EXPECT_EQ(film.film_ior, 1.5f);
    EXPECT_EQ(film.film_thinnest_nm, 200.f);
    EXPECT_EQ(film.film_thickest_nm, 600.f);
    const Material usual =
        load_material(file_with_extension("KHR_materials_iridescence", {{"iridescenceFactor", 1}}));
    EXPECT_EQ(usual.film_ior, 1.3f);
    EXPECT_EQ(usual.film_thinnest_nm, 100.f);
    EXPECT_EQ(usual.film_thickest_nm, 400.f);
    const Material leaf = load_material(file_with_extension(
        "KHR_materials_diffuse_transmission",
        {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0.25, 0.5, 1}}}));
    EXPECT_EQ(leaf.diffuse_transmission, 0.25f);
    expect_rgb(leaf.diffuse_transmission_color, 0.25f, 0.5f, 1);
    EXPECT_TRUE(leaf.lets_light_through());
    for (const Material& m : {coat, sheen, brushed, film, leaf}) EXPECT_TRUE(m.layered());
    EXPECT_FALSE(material_of(json::object()).layered());
}

TEST(GltfMaterial, UnlitShowsItsBaseColourOnly) {
    TinyGltf file = file_with_extension("KHR_materials_unlit", json::object());
    file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    file.json["materials"][0]["normalTexture"] = {{"index", add_texture(file, 1)}};
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.scene.materials[0].unlit);
    EXPECT_FALSE(loaded.scene.materials[0].emits());
    EXPECT_TRUE(loaded.scene.images.empty());
    EXPECT_TRUE(renders(loaded, "KHR_materials_unlit"));
}

TEST(GltfMaterial, MaterialsThatNothingShowsAreLeftOut) {
    TinyGltf file = file_with({{"name", "used"}});
    file.add("materials", {{"name", "unused"}});
    EXPECT_EQ(load_material(file).name, "used");
}

TEST(GltfMaterial, ScatteringInsideIsReadAndNamedAsNotRendered) {
    const auto ignored = [](json scatter) {
        TinyGltf file = file_with_extension("KHR_materials_volume_scatter", std::move(scatter));
        return load(file).ignored;
    };
    EXPECT_THAT(ignored({{"multiscatterColor", {0, 0.5, 0}}, {"scatterAnisotropy", 0.3}}),
                testing::ElementsAre("1 scattering volume (light goes straight through them)"));
    EXPECT_THAT(ignored({{"multiscatterColor", {0, 0, 0}}}), testing::IsEmpty());
    EXPECT_THAT(ignored(json::object()), testing::IsEmpty());
}

TEST(GltfMaterial, TexturesOfLayersThatAreNotThereAreNotDecoded) {
    for (const auto& [name, factor, texture] :
         {std::array{"transmission", "transmissionFactor", "transmissionTexture"},
          std::array{"clearcoat", "clearcoatFactor", "clearcoatRoughnessTexture"},
          std::array{"sheen", "sheenColorFactor", "sheenColorTexture"},
          std::array{"anisotropy", "anisotropyStrength", "anisotropyTexture"},
          std::array{"iridescence", "iridescenceFactor", "iridescenceThicknessTexture"},
          std::array{"diffuse_transmission", "diffuseTransmissionFactor",
                     "diffuseTransmissionColorTexture"}}) {
        const auto images = [&](json value) {
            json layer = {{texture, {{"index", 0}}}};
            if (!value.is_null()) layer[factor] = value;
            TinyGltf file = file_with_extension((std::string("KHR_materials_") + name).c_str(),
                                                std::move(layer));
            (void)add_texture(file, 10);
            return load(file).scene.images.size();
        };
        EXPECT_EQ(images(nullptr), 0u) << name;
        const bool coloured = std::string_view(name) == "sheen";
        EXPECT_EQ(images(coloured ? json{1, 1, 1} : json(1)), 1u) << name;
    }
}

}  // namespace
}  // namespace petzval::io
