// SPDX-License-Identifier: Apache-2.0
// Materials with a measured metal or reflectance.
#include <gtest/gtest.h>

#include "io/spectra/spectra.h"
#include "tests/support/spectral_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using namespace test;
using nlohmann::json;

TEST(GltfExtras, MeasuredMetal) {
    TinyGltf file = file_with_materials(
        {thing({{"metal", "Au"}}), thing({{"metal", "ag"}}), thing({{"metal", "au"}})});
    file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 1, 0.5}},
                                                         {"baseColorTexture", {{"index", 0}}}};
    file.add("textures", {{"source", file.add_image(tiny_png(1, 1, {1, 2, 3, 4}))}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    const GltfFile loaded = load(file);
    const Scene& scene = loaded.scene;
    ASSERT_EQ(scene.metals.size(), 2u);
    EXPECT_EQ(scene.metals[0].name, "au");
    EXPECT_EQ(scene.metals[1].name, "ag");
    EXPECT_EQ(scene.materials[0].metal, 0);
    EXPECT_EQ(scene.materials[1].metal, 1);
    EXPECT_EQ(scene.materials[2].metal, 0);
    EXPECT_FALSE(scene.materials[0].base_color_texture.present());
    EXPECT_EQ(scene.materials[0].alpha, 0.5f);
    for (const Material& m : scene.materials) {
        const Rgb colour = colour_of(scene.metals[size_t(m.metal)]);
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(m.base_color[i], std::min(1.f, std::max(0.f, colour[i])));
    }
    EXPECT_GT(scene.materials[0].base_color[0], 2 * scene.materials[0].base_color[2]);  // golden
    EXPECT_TRUE(contains_line(loaded.honoured, "measured metal au"));
    EXPECT_TRUE(contains_line(loaded.honoured, "measured metal ag"));
    EXPECT_TRUE(loaded.warnings.empty());

    file.json["materials"][0]["alphaMode"] = "MASK";  // its holes are in the texture
    EXPECT_TRUE(load(file).scene.materials[0].base_color_texture.present());
}

TEST(GltfExtras, MetalThatIsNotSeenIsWarnedOf) {
    json dull = thing({{"metal", "cu"}});
    dull["pbrMetallicRoughness"]["metallicFactor"] = 0;
    const GltfFile loaded = load(file_with_materials({dull}));
    EXPECT_TRUE(contains_line(loaded.warnings, "/materials/0/extras/petzval/metal: is not seen"));
}

TEST(GltfExtras, MeasuredReflectance) {
    const TempFolder folder;
    const std::string text = "nm,r\n400,0.25\n";
    for (const char* name : {"Paint.csv", "paint.csv"})
        (void)save_bytes(folder.path / name,
                         {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    TinyGltf file = file_with_materials(
        {thing({{"reflectance", "colorchecker:Red"}}), thing({{"reflectance", "Paint.csv"}}),
         thing({{"reflectance", "colorchecker:red"}}),
         prism({}, {{"reflectance", "paint.csv"}, {"glass", "schott:N-BK7"}}),
         thing({{"reflectance", "Paint.csv"}})});
    const auto loaded = [&] { return load_gltf(file.save_glb(folder.path / "test.glb")); };
    const GltfFile first = loaded();
    const Scene& scene = first.scene;
    ASSERT_EQ(scene.reflectances.size(), 3u);
    const std::vector<int32_t> places = {0, 1, 0, 2, 1};
    for (size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(scene.materials[i].reflectance, places[i]);
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(scene.materials[i].base_color[k],
                      scene.reflectances[size_t(places[i])].rgb[k]);
    }
    EXPECT_EQ(scene.reflectances[0].name, "colorchecker:red");
    EXPECT_EQ(scene.reflectances[1].name, "Paint.csv");
    EXPECT_EQ(scene.reflectances[1].share.at_nm(600), 0.25f);
    EXPECT_TRUE(contains_line(first.honoured, "measured reflectance colorchecker:red"));
    EXPECT_TRUE(contains_line(first.honoured, "measured reflectance paint.csv"));
    EXPECT_TRUE(first.warnings.empty());
    EXPECT_EQ(first.files,
              (std::vector<std::filesystem::path>{
                  folder.path / "test.glb", folder.path / "Paint.csv", folder.path / "paint.csv"}));
    (void)save_bytes(folder.path / "paint.csv",
                     std::vector<uint8_t>{'n', ',', 'r', '\n', '5', '0', '0', ',', '1', '\n'});
    EXPECT_NE(loaded().hash, first.hash);
}

TEST(GltfExtras, AReflectanceHasNoTextureButACutoutsHoles) {
    TinyGltf file = file_with_materials({thing({{"reflectance", "colorchecker:red"}})});
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    file.add("textures", {{"source", file.add_image(tiny_png(1, 1, {1, 2, 3, 4}))}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    EXPECT_TRUE(has(refused(file),
                    "/materials/0/extras/petzval/reflectance: is the material's colour, and so is "
                    "its texture; leave out one"));
    file.json["materials"][0]["alphaMode"] = "MASK";
    EXPECT_TRUE(load(file).scene.materials[0].base_color_texture.present());
}

}  // namespace
}  // namespace petzval::io
