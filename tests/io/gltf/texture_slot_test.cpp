// SPDX-License-Identifier: Apache-2.0
// Texture slots of materials: their images, samplers, sets of coordinates and transforms.
#include <gtest/gtest.h>

#include "tests/support/gltf_material.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using namespace test::gltf_material;
using nlohmann::json;

/// The red of the texel that a slot reads.
int red(const Scene& scene, const TextureSlot& slot) {
    if (!slot.present()) return -1;
    return std::get<0>(scene.images[static_cast<size_t>(slot.image)].texels)[0];
}

/// Expects of a slot the red of its texel, and its encoding.
struct SlotCheck {
    const Scene& scene;
    void operator()(const TextureSlot& texture, int expected, Encoding encoding) const {
        EXPECT_EQ(red(scene, texture), expected);
        EXPECT_EQ(texture.encoding, encoding) << expected;
    }
};

json slot(int texture) {
    return {{"index", texture}};
}

TEST(GltfTextureSlot, EverySlotHasItsTextureAndEncoding) {
    TinyGltf file = file_with(json::object());
    for (uint8_t i = 0; i < 9; ++i) add_texture(file, uint8_t(100 + i));
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
    const SlotCheck check{scene};
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

TEST(GltfTextureSlot, EverySlotOfALayerHasItsTextureAndEncoding) {
    TinyGltf file = file_with(json::object());
    for (uint8_t i = 0; i < 11; ++i) add_texture(file, uint8_t(100 + i));
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
    const SlotCheck check{loaded.scene};
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

TEST(GltfTextureSlot, OneImageServesManySlots) {
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

TEST(GltfTextureSlot, SamplersSetWrapAndFilter) {
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

TEST(GltfTextureSlot, TexturesMayUseAnySetOfCoordinates) {
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

TEST(GltfTextureSlot, ASetThatIsNotThereReadsAsZero) {
    for (const auto& set : {json(7), json(300), json(4294967296), json(4294967297)}) {
        TinyGltf file = five_sets({0, 0, 0, 0});
        file.json["materials"][0]["emissiveTexture"]["texCoord"] = set;
        const GltfFile loaded = load(file);
        const Mesh& mesh = loaded.scene.meshes.at(0);
        EXPECT_EQ(mesh.uv_at(0, V2f(0.25f, 0.5f), 2), V2f(0.f));
        EXPECT_TRUE(contains_line(loaded.warnings, "without texture coordinates"));
    }
}

TEST(GltfTextureSlot, TangentsAndMorphTargetsOfAnySet) {
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

TEST(GltfTextureSlot, TextureTransform) {
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

TEST(GltfTextureSlot, TextureTransformOfTheExtensionsExample) {
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

TEST(GltfTextureSlot, OnlyImagesInUseMustDecode) {
    TinyGltf file = file_with(json::object());
    file.add("textures", {{"source", file.add_image(absurdly_wide_png())}});
    EXPECT_EQ(load(file).scene.images.size(), 0u);
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/images/0: "));
}

TEST(GltfTextureSlot, ATextureWithoutAnImageIsWarnedOf) {
    TinyGltf file = file_with({{"normalTexture", {{"index", 0}}}});
    file.add("textures", json::object());
    const GltfFile loaded = load(file);
    EXPECT_FALSE(loaded.scene.materials[0].normal_texture.present());
    EXPECT_TRUE(contains_line(loaded.warnings, "/materials/0/normalTexture"));
}

}  // namespace
}  // namespace petzval::io
