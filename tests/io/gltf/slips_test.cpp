// SPDX-License-Identifier: Apache-2.0
// What the loader makes of files with slips that only show in their data.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

/// A quad of two triangles, the first vertex of the second one as given.
TinyGltf quad(float x) {
    TinyGltf file;
    const int positions =
        file.add_accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, x, 1, 0, 1, 0, 0, 0, 1, 0});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    return file;
}

TEST(GltfSlips, TrianglesWithACornerThatIsNotFiniteAreSkipped) {
    for (const float bad : {kNotANumber, INFINITY, -INFINITY}) {
        const GltfFile loaded = load(quad(bad));
        ASSERT_EQ(loaded.scene.meshes.size(), 1u);
        EXPECT_EQ(loaded.scene.meshes[0].triangles.size(), 1u);
        for (const V3f& p : loaded.scene.meshes[0].positions) EXPECT_LE(p.length(), 1.5f);
        EXPECT_TRUE(
            contains_line(loaded.warnings, "1 triangle with a corner that is not a finite"));
    }
    EXPECT_EQ(load(quad(1)).scene.meshes[0].triangles.size(), 2u);
}

TEST(GltfSlips, OtherValuesThatAreNotFiniteAreReplaced) {
    TinyGltf file = quad(1);
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    std::vector<float> uv(12, 0.5f), colours(24, 0.25f), normals(18, 0.f);
    uv[3] = kNotANumber;
    colours[0] = INFINITY;
    normals[1] = kNotANumber;
    attributes["TEXCOORD_0"] = file.add_accessor<float>("VEC2", uv);
    attributes["COLOR_0"] = file.add_accessor<float>("VEC4", colours);
    attributes["NORMAL"] = file.add_accessor<float>("VEC3", normals);
    const GltfFile loaded = load(file);
    const Mesh& mesh = loaded.scene.meshes.at(0);
    EXPECT_EQ(mesh.uv[0][1], V2f(0.f));
    EXPECT_EQ(mesh.uv[0][2], V2f(0.5f));
    EXPECT_EQ(mesh.colours[0][0], 1.f);
    EXPECT_NEAR(mesh.normals[0].z, 1, 1e-6);
    EXPECT_TRUE(contains_line(loaded.warnings, "2 texture coordinate or colours that is not"));
}

TEST(GltfSlips, ATextureThatIsNotThereIsLeftOut) {
    TinyGltf file = quad(1);
    file.add("images", {{"uri", "absent.png"}});
    file.add("textures", {{"source", 0}});
    file.add("materials", json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture":
        {"index": 0}, "baseColorFactor": [0.5, 0.25, 1, 1]}})"));
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    const GltfFile loaded = load(file);
    EXPECT_FALSE(loaded.scene.materials.at(0).base_color_texture.present());
    EXPECT_FLOAT_EQ(loaded.scene.materials[0].base_color[1], 0.25f);
    EXPECT_TRUE(contains_line(loaded.warnings, "/images/0/uri: there is no file \"absent.png\""));
    EXPECT_TRUE(contains_line(loaded.warnings, "baseColorTexture: its texture has no image"));
}

TEST(GltfSlips, ATextureWithoutCoordinatesIsShownAtTheOrigin) {
    TinyGltf file = quad(1);
    file.add_image(tiny_png(1, 1, {255, 0, 0, 255}));
    file.add("textures", {{"source", 0}});
    file.add("materials", json::parse(R"({"normalTexture": {"index": 0}})"));
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    const GltfFile loaded = load(file);
    const Mesh& mesh = loaded.scene.meshes.at(0);
    ASSERT_EQ(mesh.uv[0].size(), mesh.positions.size());
    EXPECT_EQ(mesh.uv[0][0], V2f(0.f));
    EXPECT_TRUE(contains_line(loaded.warnings, "1 primitive without texture coordinates"));
}

TEST(GltfSlips, ATextureThatIsNoPictureIsRefused) {
    TinyGltf file = quad(1);
    file.add_image(std::vector<uint8_t>{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB});
    file.add("textures", {{"source", 0}});
    file.add("materials", json::parse(R"({"normalTexture": {"index": 0}})"));
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }),
                    "/images/0: the image is not a PNG, JPEG or WebP file"));
}

TEST(GltfSlips, ANodeListedBesideItsRootIsShownOnce) {
    TinyGltf file;
    const int mesh = file.add_triangle();
    const int child = file.add("nodes", {{"mesh", mesh}});
    file.add_root({{"children", {child}}, {"translation", {5, 0, 0}}});
    file.json["scenes"][0]["nodes"] = {child, 1};
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_FLOAT_EQ(loaded.scene.meshes.at(0).positions[0].x, 5);
    EXPECT_TRUE(contains_line(loaded.warnings, "node 0 is not a root, but a child of node 1"));
}

TEST(GltfSlips, RotationsAreScaledToUnitLength) {
    TinyGltf file;
    file.add_root({{"mesh", file.add_triangle()}, {"rotation", {0, 0, 2, 2}}});  // 90 degrees
    const Mesh mesh = load_mesh(file);
    EXPECT_NEAR(mesh.positions[1].x, 0, 1e-6);
    EXPECT_NEAR(mesh.positions[1].y, 1, 1e-6);
}

TEST(GltfSlips, LeftOutCamerasAndEmptyMeshesAreWarnings) {
    TinyGltf file = quad(1);
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0}}}});
    file.add_root({{"camera", 0}});
    const int none = file.add("meshes", json::object());
    file.add_root({{"mesh", none}});
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.cameras.empty());
    EXPECT_TRUE(contains_line(loaded.warnings, "/cameras/0: has a yfov of 0; it is left out"));
    EXPECT_TRUE(contains_line(loaded.warnings, "/meshes/0: has no primitives") ||
                contains_line(loaded.warnings, "/meshes/1: has no primitives"));
}

TEST(GltfSlips, StridesThatGraphicsCardsRefuse) {
    TinyGltf file;
    std::vector<uint8_t> bytes(3 * 13);
    const float x[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (int i = 0; i < 3; ++i) std::memcpy(&bytes[size_t(13 * i)], &x[3 * i], 12);
    const int view = file.add_view(bytes, {{"byteStride", 13}});
    const int positions =
        file.add("accessors",
                 {{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_EQ(load_mesh(file).positions[2], V3f(0, 1, 0));
}

}  // namespace
}  // namespace petzval::io
