// SPDX-License-Identifier: Apache-2.0
// Materials: factors, extensions, texture slots, and which images are decoded.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval {
namespace {

using nlohmann::json;

void expect_rgb(const Rgb& c, float r, float g, float b) {
    EXPECT_EQ(c[0], r);
    EXPECT_EQ(c[1], g);
    EXPECT_EQ(c[2], b);
}

/// A triangle with this material, and all that its textures need: texture i has image i.
TinyGltf file_with(json material) {
    TinyGltf file;
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    file.add("materials", std::move(material));
    file.add_triangle({{"material", 0}, {"attributes", {{"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}}}});
    file.add_root({{"mesh", 0}});
    return file;
}

/// Adds an image of one texel of that red, and a texture of it.
int add_texture(TinyGltf& file, uint8_t red, json more = json::object()) {
    more["source"] = file.add_image(tiny_png(1, 1, {red, 20, 30, 40}));
    return file.add("textures", std::move(more));
}

Material load_material(const TinyGltf& file) {
    GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.materials.size(), 1u);
    return loaded.scene.materials.at(loaded.scene.meshes.at(0).material);
}

Material material_of(json material) {
    return load_material(file_with(std::move(material)));
}

json extension(const char* name, json value) {
    return {{"extensions", {{name, std::move(value)}}}};
}

/// As above, declared as used.
TinyGltf file_with_extension(const char* name, json value) {
    TinyGltf file = file_with(extension(name, std::move(value)));
    file.json["extensionsUsed"] = {name};
    return file;
}

/// The red of the texel that a slot reads.
int red(const Scene& scene, const TextureSlot& slot) {
    if (!slot.present()) return -1;
    return std::get<0>(scene.images[static_cast<size_t>(slot.image)].texels)[0];
}

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

TEST(GltfMaterial, EverySlotOfALayerHasItsTextureAndEncoding) {
    TinyGltf file = file_with(json::object());
    for (uint8_t i = 0; i < 11; ++i) add_texture(file, uint8_t(100 + i));
    const auto slot = [](int i) { return json{{"index", i}}; };
    file.json["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_sheen",
                                   "KHR_materials_anisotropy", "KHR_materials_iridescence",
                                   "KHR_materials_diffuse_transmission"};
    json& extensions = file.json["materials"][0]["extensions"];
    extensions["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", 1},
        {"clearcoatTexture", slot(0)},
        {"clearcoatRoughnessTexture", slot(1)},
        {"clearcoatNormalTexture", {{"index", 2}, {"scale", 0.5}}}};
    extensions["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}},
                                         {"sheenColorTexture", slot(3)},
                                         {"sheenRoughnessTexture", slot(4)}};
    extensions["KHR_materials_anisotropy"] = {{"anisotropyStrength", 1},
                                              {"anisotropyTexture", slot(5)}};
    extensions["KHR_materials_iridescence"] = {{"iridescenceFactor", 1},
                                               {"iridescenceTexture", slot(6)},
                                               {"iridescenceThicknessTexture", slot(7)}};
    extensions["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", 1},
        {"diffuseTransmissionTexture", slot(8)},
        {"diffuseTransmissionColorTexture", slot(9)}};
    const GltfFile loaded = load(file);
    const Material& m = loaded.scene.materials[0];
    const auto check = [&](const TextureSlot& texture, int expected, Encoding encoding) {
        EXPECT_EQ(red(loaded.scene, texture), expected);
        EXPECT_EQ(texture.encoding, encoding) << expected;
    };
    check(m.coat_texture, 100, Encoding::Linear);
    check(m.coat_roughness_texture, 101, Encoding::Linear);
    check(m.coat_normal_texture, 102, Encoding::Linear);
    EXPECT_EQ(m.coat_normal_scale, 0.5f);
    check(m.sheen_color_texture, 103, Encoding::Srgb);
    check(m.sheen_roughness_texture, 104, Encoding::Linear);
    check(m.anisotropy_texture, 105, Encoding::Linear);
    check(m.iridescence_texture, 106, Encoding::Linear);
    check(m.film_thickness_texture, 107, Encoding::Linear);
    check(m.diffuse_transmission_texture, 108, Encoding::Linear);
    check(m.diffuse_transmission_color_texture, 109, Encoding::Srgb);
    EXPECT_FALSE(loaded.scene.meshes[0].tangents.empty());
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

TEST(GltfMaterial, EverySlotHasItsTextureAndEncoding) {
    TinyGltf file = file_with(json::object());
    for (uint8_t i = 0; i < 9; ++i) add_texture(file, uint8_t(100 + i));
    const auto slot = [](int i) { return json{{"index", i}}; };
    file.json["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_transmission"};
    file.json["materials"][0] = {
        {"pbrMetallicRoughness",
         {{"baseColorTexture", slot(0)}, {"metallicRoughnessTexture", slot(1)}}},
        {"normalTexture", {{"index", 2}, {"scale", 0.5}}},
        {"emissiveTexture", slot(3)},
        {"emissiveFactor", {1, 1, 1}},
        {"occlusionTexture", slot(4)},
        {"extensions",
         {{"KHR_materials_specular",
           {{"specularTexture", slot(5)}, {"specularColorTexture", slot(6)}}},
          {"KHR_materials_transmission",
           {{"transmissionFactor", 1}, {"transmissionTexture", slot(7)}}}}}};
    const GltfFile loaded = load(file);
    const Scene& scene = loaded.scene;
    const Material& m = scene.materials[0];
    const auto check = [&](const TextureSlot& texture, int expected, Encoding encoding) {
        EXPECT_EQ(red(scene, texture), expected);
        EXPECT_EQ(texture.encoding, encoding) << expected;
    };
    check(m.base_color_texture, 100, Encoding::Srgb);
    check(m.metallic_roughness_texture, 101, Encoding::Linear);
    check(m.normal_texture, 102, Encoding::Linear);
    check(m.emissive_texture, 103, Encoding::Srgb);
    check(m.specular_texture, 105, Encoding::Linear);
    check(m.specular_color_texture, 106, Encoding::Srgb);
    check(m.transmission_texture, 107, Encoding::Linear);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(scene.images.size(), 7u);  // not the occlusion map, and not the unused one
    EXPECT_TRUE(contains_line(loaded.ignored, "1 occlusion texture"));
}

TEST(GltfMaterial, OneImageServesManySlots) {
    TinyGltf file = file_with(json::object());
    add_texture(file, 1);
    file.add("textures", {{"source", 0}});
    file.json["materials"][0] = {{"normalTexture", {{"index", 0}}},
                                 {"emissiveFactor", {1, 1, 1}},
                                 {"emissiveTexture", {{"index", 1}}}};
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.images.size(), 1u);
    EXPECT_EQ(loaded.scene.materials[0].emissive_texture.image, 0);
}

TEST(GltfMaterial, SamplersSetWrapAndFilter) {
    TinyGltf file = file_with(json::object());
    file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    file.add("samplers", {{"magFilter", 9729}});
    add_texture(file, 1, {{"sampler", 0}});
    add_texture(file, 2, {{"sampler", 1}});
    file.json["materials"][0] = {
        {"normalTexture", {{"index", 0}}},
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}, {"texCoord", 1}}}}}};
    const Material m = load_material(file);
    EXPECT_EQ(m.normal_texture.wrap_u, Wrap::ClampToEdge);
    EXPECT_EQ(m.normal_texture.wrap_v, Wrap::MirroredRepeat);
    EXPECT_TRUE(m.normal_texture.nearest);
    EXPECT_EQ(m.normal_texture.uv_set, 0);
    EXPECT_EQ(m.base_color_texture.wrap_u, Wrap::Repeat);
    EXPECT_FALSE(m.base_color_texture.nearest);
    EXPECT_EQ(m.base_color_texture.uv_set, 1);
}

/// A triangle with five sets of coordinates, of which the texture's place tells the number.
TinyGltf five_sets(const std::vector<int>& sets) {
    TinyGltf file;
    json attributes;
    for (int n = 0; n < 5; ++n) {
        const float at = 0.125f * static_cast<float>(n);
        attributes["TEXCOORD_" + std::to_string(n)] =
            file.add_accessor<float>("VEC2", {at, 0, at, 0.5f, at, 1});
    }
    file.add_triangle({{"material", 0}, {"attributes", attributes}});
    file.add_root({{"mesh", 0}});
    add_texture(file, 1);
    const auto texture = [&](size_t i) { return json{{"index", 0}, {"texCoord", sets[i]}}; };
    file.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", texture(0)}, {"metallicRoughnessTexture", texture(1)}}},
         {"normalTexture", texture(2)},
         {"emissiveTexture", texture(3)},
         {"emissiveFactor", {1, 1, 1}}}};
    return file;
}

std::vector<int> sets_found(const GltfFile& loaded) {
    const Mesh& mesh = loaded.scene.meshes.at(0);
    const Material& m = loaded.scene.materials.at(mesh.material);
    std::vector<int> found;
    for (const TextureSlot* slot : {&m.base_color_texture, &m.metallic_roughness_texture,
                                    &m.normal_texture, &m.emissive_texture}) {
        const V2f uv = mesh.uv_at(0, V2f(0.25f, 0.5f), slot->uv_set);
        EXPECT_EQ(uv.y, 0.625f);
        found.push_back(static_cast<int>(uv.x * 8));
    }
    return found;
}

TEST(GltfMaterial, TexturesMayUseAnySetOfCoordinates) {
    for (const std::vector<int>& sets :
         {std::vector{0, 1, 0, 1}, {0, 3, 0, 3}, {4, 3, 2, 1}, {2, 2, 2, 2}, {4, 0, 2, 3}}) {
        const GltfFile loaded = load(five_sets(sets));
        EXPECT_EQ(sets_found(loaded), sets);
        EXPECT_FALSE(contains_line(loaded.warnings, "texture coordinates"));
    }
    const Mesh usual = load(five_sets({0, 1, 1, 0})).scene.meshes[0];
    EXPECT_TRUE(usual.more_uv.empty());  // costs nothing where it is not needed
    EXPECT_EQ(load(five_sets({3, 1, 3, 0})).scene.meshes[0].more_uv.size(), 1u);
}

TEST(GltfMaterial, ASetThatIsNotThereReadsAsZero) {
    for (const auto& set : {json(7), json(300), json(4294967296), json(4294967297)}) {
        TinyGltf file = five_sets({0, 0, 0, 0});
        file.json["materials"][0]["emissiveTexture"]["texCoord"] = set;
        const GltfFile loaded = load(file);
        const Mesh& mesh = loaded.scene.meshes.at(0);
        EXPECT_EQ(mesh.uv_at(0, V2f(0.25f, 0.5f), 2), V2f(0.f));
        EXPECT_TRUE(contains_line(loaded.warnings, "without texture coordinates"));
    }
}

TEST(GltfMaterial, TangentsAndMorphTargetsOfAnySet) {
    TinyGltf file = five_sets({0, 0, 3, 0});
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_3"] =  // u along y
        file.add_accessor<float>("VEC2", {0, 0, 0, 1, 1, 0});
    const int more = file.add_accessor<float>("VEC2", {0.5f, 0, 0, 0, 0, 0});
    primitive["targets"] = {{{"TEXCOORD_3", more}}};
    file.json["meshes"][0]["weights"] = {0.5};
    const Mesh mesh = load(file).scene.meshes.at(0);
    ASSERT_EQ(mesh.more_uv.size(), 1u);
    EXPECT_EQ(mesh.more_uv[0][mesh.triangles[0][0]], V2f(0.25f, 0));
    ASSERT_FALSE(mesh.tangents.empty());
    EXPECT_GT(mesh.tangents[0].y, 0.9f);
}

void expect_uv(const TextureSlot& slot, V2f from, V2f to) {
    const V2f moved(slot.u_row[0] * from.x + slot.u_row[1] * from.y + slot.u_row[2],
                    slot.v_row[0] * from.x + slot.v_row[1] * from.y + slot.v_row[2]);
    EXPECT_LT((moved - to).length(), 1e-6f) << moved << " is not " << to;
}

TEST(GltfMaterial, TextureTransform) {
    TinyGltf file = file_with(json::object());
    file.json["extensionsUsed"] = {"KHR_texture_transform"};
    add_texture(file, 1);
    const double quarter_turn = std::acos(0.0);
    file.json["materials"][0]["normalTexture"] = {{"index", 0},
                                                  {"extensions",
                                                   {{"KHR_texture_transform",
                                                     {{"offset", {0.25, 0.5}},
                                                      {"scale", {2, 3}},
                                                      {"rotation", quarter_turn},
                                                      {"texCoord", 1}}}}}};
    const TextureSlot slot = load_material(file).normal_texture;
    EXPECT_EQ(slot.uv_set, 1);
    // Scale first; then, counter-clockwise as the image is seen (v runs down), right goes to up.
    expect_uv(slot, {1, 0}, {0.25f, 0.5f - 2});
    expect_uv(slot, {0, 1}, {0.25f + 3, 0.5f});
}

TEST(GltfMaterial, TextureTransformOfTheExtensionsExample) {
    // "utilizes only the lower left quadrant of the source image, rotated clockwise 90 degrees"
    TinyGltf file = file_with(json::object());
    file.json["extensionsUsed"] = {"KHR_texture_transform"};
    add_texture(file, 1);
    file.json["materials"][0]["normalTexture"] = {
        {"index", 0},
        {"extensions",
         {{"KHR_texture_transform",
           {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}}}}}};
    const TextureSlot slot = load_material(file).normal_texture;
    expect_uv(slot, {0, 0}, {0, 1});
    expect_uv(slot, {1, 0}, {0, 0.5f});
    expect_uv(slot, {0, 1}, {0.5f, 1});
    expect_uv(slot, {1, 1}, {0.5f, 0.5f});
}

/// A picture whose header claims more texels in a row than can be read.
std::vector<uint8_t> absurdly_wide_png() {
    std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    put_png_chunk(png, "IHDR", std::vector<uint8_t>{0, 1, 0, 0, 0, 0, 0, 1, 8, 6, 0, 0, 0});
    put_png_chunk(png, "IDAT", {});
    put_png_chunk(png, "IEND", {});
    return png;
}

TEST(GltfMaterial, OnlyImagesInUseMustDecode) {
    TinyGltf file = file_with(json::object());
    file.add("textures", {{"source", file.add_image(absurdly_wide_png())}});
    EXPECT_EQ(load(file).scene.images.size(), 0u);
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/images/0: "));
}

TEST(GltfMaterial, MaterialsThatNothingShowsAreLeftOut) {
    TinyGltf file = file_with({{"name", "used"}});
    file.add("materials", {{"name", "unused"}});
    EXPECT_EQ(load_material(file).name, "used");
}

TEST(GltfMaterial, ATextureWithoutAnImageIsWarnedOf) {
    TinyGltf file = file_with({{"normalTexture", {{"index", 0}}}});
    file.add("textures", json::object());
    const GltfFile loaded = load(file);
    EXPECT_FALSE(loaded.scene.materials[0].normal_texture.present());
    EXPECT_TRUE(contains_line(loaded.warnings, "/materials/0/normalTexture"));
}

}  // namespace
}  // namespace petzval
