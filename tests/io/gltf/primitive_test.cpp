// SPDX-License-Identifier: Apache-2.0
// From primitives to triangles: modes, what is skipped, normals, morph targets.
#include <gtest/gtest.h>

#include "io/gltf/meshes/triangles.h"
#include "tests/support/load_tiny_gltf.h"

namespace petzval::io {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

/// Four corners of a square in the plane z = 0.
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

TinyGltf square_with(nlohmann::json more) {
    TinyGltf file;
    more["attributes"]["POSITION"] = file.add_positions(kSquare);
    file.add_root({{"mesh", file.add_mesh(std::move(more))}});
    return file;
}

TEST(GltfTriangles, List) {
    EXPECT_EQ(to_triangles(TriangleMode::List, {4, 5, 6, 7, 8, 9, 1}),
              (Triangles{{4, 5, 6}, {7, 8, 9}}));
}

TEST(GltfTriangles, StripTurnsEveryOtherTriangle) {
    EXPECT_EQ(to_triangles(TriangleMode::Strip, {4, 5, 6, 7, 8}),
              (Triangles{{4, 5, 6}, {5, 7, 6}, {6, 7, 8}}));
}

TEST(GltfTriangles, FanSharesItsFirstVertex) {
    EXPECT_EQ(to_triangles(TriangleMode::Fan, {4, 5, 6, 7}), (Triangles{{5, 6, 4}, {6, 7, 4}}));
}

TEST(GltfTriangles, TooFewVertices) {
    for (const auto mode : {TriangleMode::List, TriangleMode::Strip, TriangleMode::Fan})
        EXPECT_TRUE(to_triangles(mode, {1, 2}).empty());
}

TEST(GltfTriangles, RemovesThoseWithoutArea) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1e-4f, 0}, {1, 0, 0}};
    mesh.triangles = {{0, 1, 3}, {0, 0, 3}, {0, 1, 2}, {1, 4, 3}, {3, 1, 0}};
    EXPECT_EQ(remove_zero_area(mesh), 3u);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 3}, {3, 1, 0}}));
}

TEST(GltfTriangles, KeepsTheSmallestThatAFloatCanShade) {
    Mesh mesh;
    mesh.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {1e-9f, 0, 0}, {0, 1e-9f, 0}};
    EXPECT_EQ(remove_zero_area(mesh), 0u);
    mesh.positions = {{0, 0, 0}, {1e-11f, 0, 0}, {0, 1e-11f, 0}};
    EXPECT_EQ(remove_zero_area(mesh), 1u);
}

TEST(GltfPrimitive, StripsAndFans) {
    EXPECT_EQ(load_mesh(square_with({{"mode", 5}})).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(load_mesh(square_with({{"mode", 6}})).triangles, (Triangles{{1, 2, 0}, {2, 3, 0}}));
    EXPECT_TRUE(contains_line(load(square_with({{"mode", 5}})).honoured, "triangle strips"));
}

TEST(GltfPrimitive, PointsAndLinesAreSkippedWithOneWarning) {
    TinyGltf file;
    auto primitives = nlohmann::json::array();
    for (const int mode : {0, 1, 2, 3, 5})
        primitives.push_back(
            {{"mode", mode}, {"attributes", {{"POSITION", file.add_positions(kSquare)}}}});
    file.add_root({{"mesh", file.add("meshes", {{"primitives", primitives}})}});
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_EQ(loaded.scene.materials.size(), 1u);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_EQ(loaded.warnings[0], "4 point or line primitives skipped");
    EXPECT_TRUE(contains_line(loaded.ignored, "1 point primitive ("));
    EXPECT_TRUE(contains_line(loaded.ignored, "3 line primitives ("));
}

TEST(GltfPrimitive, WithoutPositionsIsSkipped) {
    TinyGltf file;
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"TEXCOORD_0", uv}}}})}});
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.scene.meshes.empty());
    EXPECT_TRUE(contains_line(loaded.warnings, "1 primitive without positions"));
}

TEST(GltfPrimitive, LeftOverVerticesAreToldOf) {
    const GltfFile loaded = load(square_with(nlohmann::json::object()));
    EXPECT_EQ(loaded.scene.meshes[0].triangles, (Triangles{{0, 1, 2}}));
    EXPECT_TRUE(contains_line(loaded.warnings, "1 primitive with vertices left over"));
}

TEST(GltfPrimitive, TrianglesWithoutAreaAreCountedInOneLine) {
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0});
    const int indices = file.add_accessor<uint8_t>("SCALAR", {0, 1, 2, 0, 1, 3, 1, 1, 2});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}},
                                           {"indices", indices}})}});
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.meshes[0].triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(loaded.warnings, std::vector<std::string>{"2 triangles without area skipped"});
}

TEST(GltfPrimitive, NormalsComeOutUnitAndZeroOnesAreReplaced) {
    TinyGltf file = square_with({{"mode", 5}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        file.add_accessor<float>("VEC3", {0, 0, 2, 0, 0, 0, 3, 0, 4, 0, 1e-30f, 0});
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.meshes[0].normals,
              (std::vector<V3f>{{0, 0, 1}, {0, 0, 1}, {0.6f, 0, 0.8f}, {0, 1, 0}}));
    EXPECT_TRUE(contains_line(loaded.warnings, "1 normal without a length"));
}

TinyGltf morphed_primitive() {
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int normals = file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int move = file.add_positions({0, 0, 0, 2, 0, 0, 0, 0, 4});
    const int bend = file.add_accessor<float>("VEC3", {0, 0, 0, 4, 0, 0, 0, 0, 0});
    file.add_root(
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                 {"targets", {{{"POSITION", move}}, {{"NORMAL", bend}}}}})}});
    return file;
}

TEST(GltfPrimitive, MorphTargetsTakeTheMeshsWeights) {
    TinyGltf file = morphed_primitive();
    EXPECT_EQ(load_mesh(file).positions[1], V3f(1, 0, 0));
    file.json["meshes"][0]["weights"] = {0.5, 0.25};
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{0, 0, 0}, {2, 0, 0}, {0, 1, 2}}));
    EXPECT_EQ(mesh.normals[0], V3f(0, 0, 1));
    EXPECT_NEAR((mesh.normals[1] - V3f(std::sqrt(0.5f), 0, std::sqrt(0.5f))).length(), 0, 1e-7);
}

TEST(GltfPrimitive, MorphWeightsOfANodeOverrideTheMeshs) {
    TinyGltf file = morphed_primitive();
    file.json["meshes"][0]["weights"] = {0.5, 0};
    file.json["nodes"][0]["weights"] = {1, 0};
    file.add_root({{"mesh", 0}});
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);  // two shapes of one mesh
    EXPECT_EQ(loaded.scene.meshes[0].positions[1], V3f(3, 0, 0));
    EXPECT_EQ(loaded.scene.meshes[1].positions[1], V3f(2, 0, 0));
}

}  // namespace
}  // namespace petzval::io
