// SPDX-License-Identifier: Apache-2.0
// The node tree: what stands where, once or many times, mirrored, posed, or not at all.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

/// The triangle (0,0,0) (1,0,0) (0,1,0) with normals along +z, not yet in any node.
TinyGltf one_triangle() {
    TinyGltf file;
    const int normals = file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.add_triangle({{"attributes", {{"NORMAL", normals}}}});
    return file;
}

Mesh placed(nlohmann::json node) {
    TinyGltf file = one_triangle();
    node["mesh"] = 0;
    file.add_root(std::move(node));
    return load_mesh(file);
}

void expect_near_matrix(const V3f& a, const V3f& b) {
    EXPECT_LT((a - b).length(), 1e-6f) << a << " is not " << b;
}

TEST(GltfNodes, TranslationRotationScale) {
    // A quarter turn about z: x to y, y to -x; after the scale, before the translation.
    const double h = std::sqrt(0.5);
    const Mesh mesh =
        placed({{"translation", {10, 20, 30}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 3, 4}}});
    expect_near_matrix(mesh.positions[0], {10, 20, 30});
    expect_near_matrix(mesh.positions[1], {10, 22, 30});
    expect_near_matrix(mesh.positions[2], {7, 20, 30});
    expect_near_matrix(mesh.normals[0], {0, 0, 1});
}

TEST(GltfNodes, RotationsAboutEachAxis) {
    const double h = std::sqrt(0.5);
    expect_near_matrix(placed({{"rotation", {h, 0, 0, h}}}).positions[2], {0, 0, 1});   // y to z
    expect_near_matrix(placed({{"rotation", {0, h, 0, h}}}).positions[1], {0, 0, -1});  // x to -z
    expect_near_matrix(placed({{"rotation", {0, h, 0, h}}}).normals[1], {1, 0, 0});     // z to x
}

TEST(GltfNodes, MatrixIsColumnMajor) {
    const Mesh mesh = placed({{"matrix", {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{5, 6, 7}, {5, 8, 7}, {4, 6, 7}}));
}

TEST(GltfNodes, NormalsByTheInverseTranspose) {
    TinyGltf file;
    const int normals = file.add_accessor<float>("VEC3", {1, 1, 0, 1, 1, 0, 1, 1, 0});
    file.add_triangle({{"attributes", {{"NORMAL", normals}}}});
    file.add_root({{"mesh", 0}, {"scale", {2, 1, 1}}});
    expect_near_matrix(load_mesh(file).normals[0], V3f(0.5f, 1, 0).normalized());
}

TEST(GltfNodes, ChildrenStandInTheirParents) {
    TinyGltf file = one_triangle();
    const int child = file.add("nodes", {{"mesh", 0}, {"translation", {1, 0, 0}}});
    file.add_root({{"children", {child}}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 5}}});
    EXPECT_EQ(load_mesh(file).positions, (std::vector<V3f>{{2, 0, 5}, {4, 0, 5}, {2, 2, 5}}));
}

TEST(GltfNodes, AMeshThatStandsOnceIsStoredInTheWorld) {
    TinyGltf file = one_triangle();
    file.add_root({{"mesh", 0}, {"translation", {0, 0, 5}}});
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_TRUE(loaded.scene.instances[0].identity);
    EXPECT_FALSE(loaded.scene.instances[0].flips);
    EXPECT_EQ(loaded.scene.instances[0].to_world, M44f());
}

TEST(GltfNodes, MirroredMeshKeepsItsFrontOutside) {
    const Mesh mesh = placed({{"scale", {-1, 1, 1}}});
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{0, 0, 0}, {-1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 2, 1}}));
    EXPECT_EQ(mesh.normals[0], V3f(0, 0, 1));
    const Mesh turned = placed({{"scale", {1, 1, -1}}});
    EXPECT_EQ(turned.triangles, (Triangles{{0, 2, 1}}));
    EXPECT_EQ(turned.normals[0], V3f(0, 0, -1));
}

TEST(GltfNodes, AMeshThatStandsTwiceBecomesInstances) {
    TinyGltf file = one_triangle();
    file.add_root({{"mesh", 0}, {"translation", {0, 0, 5}}});
    file.add_root({{"mesh", 0}, {"scale", {2, 2, -2}}});
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_EQ(loaded.scene.meshes[0].positions[1], V3f(1, 0, 0));
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    const Instance &first = loaded.scene.instances[0], &second = loaded.scene.instances[1];
    EXPECT_FALSE(first.identity);
    EXPECT_FALSE(first.flips);
    EXPECT_EQ(V3f(1, 2, 3) * first.to_world, V3f(1, 2, 8));
    EXPECT_EQ(first.to_local, M33f());
    EXPECT_TRUE(second.flips);
    EXPECT_EQ(V3f(1, 2, 3) * second.to_world, V3f(2, 4, -6));
    EXPECT_EQ(V3f(2, 4, -6) * second.to_local, V3f(1, 2, 3));
    EXPECT_TRUE(contains_line(loaded.contents, "triangles: 1 stored, 2 placed"));
}

TEST(GltfNodes, WhatIsScaledToALineOrAPointIsSkippedWithAWarning) {
    TinyGltf file = one_triangle();
    file.add_root({{"mesh", 0}, {"scale", {0, 1, 0}}});
    file.add_root({{"mesh", 0}, {"matrix", {1, 2, 3, 0, 2, 4, 6, 0, 3, 6, 9, 0, 5, 5, 5, 1}}});
    file.add_root({{"mesh", 0}, {"scale", {1e-9, 1, 1e9}}});
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_TRUE(loaded.scene.instances[0].identity);  // the only one left
    EXPECT_EQ(loaded.warnings, std::vector<std::string>{"2 nodes scaled to nothing skipped"});
}

TEST(GltfNodes, PositionsBeyondAFloatAreRefused) {
    TinyGltf file = one_triangle();
    file.add_root({{"mesh", 0}, {"scale", {1e30, 1, 1}}, {"children", {1}}});
    file.add("nodes", {{"mesh", 0}, {"scale", {1e30, 1, 1}}});
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/nodes/1: "));
    file.json["nodes"][0].erase("mesh");
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/nodes/1: "));
}

TEST(GltfNodes, WhichSceneIsShown) {
    TinyGltf file = one_triangle();
    for (const int x : {10, 20}) {
        const int node = file.add("nodes", {{"mesh", 0}, {"translation", {x, 0, 0}}});
        file.add("scenes", {{"nodes", {node}}});
    }
    file.json["scene"] = 1;
    EXPECT_EQ(load_mesh(file).positions[0], V3f(20, 0, 0));
    file.json.erase("scene");
    EXPECT_EQ(load_mesh(file).positions[0], V3f(10, 0, 0));
    file.json.erase("scenes");
    EXPECT_EQ(load(file).scene.instances.size(), 2u);
}

/// Loads with choices.
GltfFile load_with(const TinyGltf& file, const GltfChoices& choices) {
    const TempFolder folder;
    PictureBudget pictures;
    return load_gltf(file.save_glb(folder.path / "test.glb"), FileScope::Anywhere, pictures,
                     choices);
}

TEST(GltfNodes, AnySceneOfTheFileMayBeShown) {
    TinyGltf file = one_triangle();
    for (const char* name : {"day", "1", "night"}) {
        const int node = file.add("nodes", {{"mesh", 0}, {"translation", {name[0], 0, 0}}});
        file.add("scenes", {{"nodes", {node}}, {"name", name}});
    }
    file.json["scene"] = 1;
    const auto left_of = [&](const char* scene) {
        return load_with(file, {.scene = scene}).scene.meshes.at(0).positions.at(0).x;
    };
    EXPECT_EQ(left_of("night"), float('n'));
    EXPECT_EQ(left_of("0"), float('d'));
    EXPECT_EQ(left_of("1"), float('1'));
    EXPECT_EQ(left_of("2"), float('n'));
    EXPECT_TRUE(has(refusal([&] { (void)load_with(file, {.scene = "nigth"}); }),
                    "no scene \"nigth\"; it has 0 \"day\", 1 \"1\", 2 \"night\""));
    EXPECT_TRUE(has(refusal([&] { (void)load_with(file, {.scene = "3"}); }), "no scene \"3\""));
    const GltfFile shown = load_with(file, {.scene = "night"});
    EXPECT_TRUE(contains_line(shown.contents, "scene 2: night"));
    file.json["scenes"][0]["name"] = "1";  // the first of a name
    EXPECT_EQ(left_of("1"), float('d'));
    TinyGltf none = one_triangle();
    none.add("nodes", {{"mesh", 0}});
    EXPECT_TRUE(has(refusal([&] { (void)load_with(none, {.scene = "0"}); }), "the file has none"));
}

// KHR_node_visibility: "Visibility affects neither cameras", and no child of a hidden node shows.
TEST(GltfNodes, HiddenNodesShowNeitherMeshesNorLights) {
    TinyGltf file = one_triangle();
    file.json["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    const auto with = [](nlohmann::json node, bool visible) {
        node["extensions"]["KHR_node_visibility"]["visible"] = visible;
        return node;
    };
    nlohmann::json all = {{"mesh", 0}, {"camera", 0}};
    all["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const int child = file.add("nodes", with(all, true));
    const int group = file.add("nodes", {{"children", {child}}});
    file.add_root(with({{"children", {group}}}, false));
    file.add_root(with(all, true));
    file.add_root(all);
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.instances.size(), 2u);
    EXPECT_EQ(loaded.scene.lights.size(), 2u);
    EXPECT_EQ(loaded.cameras.size(), 3u);
    EXPECT_TRUE(renders(loaded, "KHR_node_visibility"));
    file.json["nodes"][2]["extensions"]["KHR_node_visibility"] = nlohmann::json::object();
    EXPECT_EQ(load(file).scene.instances.size(), 3u);  // visible by default
    file.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = 0;
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/KHR_node_visibility/visible"));
}

TEST(GltfNodes, DeepTrees) {
    TinyGltf file = one_triangle();
    const int depth = 1000;
    file.add_root({{"children", {1}}});
    for (int i = 1; i < depth; ++i)
        file.add("nodes", {{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    file.add("nodes", {{"mesh", 0}});
    EXPECT_EQ(load_mesh(file).positions[0], V3f(depth - 1, 0, 0));
}

// What looks at each node for each node takes minutes for these.
TEST(GltfNodes, ManyNodesShowOneMesh) {
    constexpr size_t count = 100'000;
    TinyGltf file = one_triangle();
    auto& nodes = file.json["nodes"] = nlohmann::json::array();
    for (size_t i = 0; i < count; ++i)
        nodes.push_back({{"mesh", 0}, {"translation", {i % 100, i / 100 % 100, i / 10000}}});
    for (size_t i = 0; i < count; ++i) nodes.push_back(nlohmann::json::object());
    auto& roots = file.json["scenes"][0]["nodes"] = nlohmann::json::array();
    for (size_t i = 0; i < 2 * count; ++i) roots.push_back(i);
    const Scene scene = load(file).scene;
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), count);
    EXPECT_EQ(scene.instances[12345].to_world[3][0], 45);
    EXPECT_EQ(scene.instances[12345].to_world[3][1], 23);
    EXPECT_EQ(scene.instances[12345].to_world[3][2], 1);
}

TEST(GltfNodes, AnEmptyFileIsAnEmptyScene) {
    const GltfFile loaded = load(TinyGltf{});
    EXPECT_TRUE(loaded.scene.meshes.empty());
    EXPECT_TRUE(loaded.scene.lights.empty());
    EXPECT_TRUE(loaded.cameras.empty());
}

/// Two joints, of which the second stands 10 to the right and is bound where the first is.
TinyGltf skinned_node(const std::vector<float>& weights) {
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int joints = file.add_accessor<uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    const int weight_accessor = file.add_accessor<float>("VEC4", weights);
    file.add_mesh(
        {{"attributes",
          {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weight_accessor}}}});
    const int inverse_bind =
        file.add_accessor<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1});
    file.add_root({{"mesh", 0}, {"skin", 0}, {"translation", {100, 100, 100}}});
    file.add_root({{"scale", {2, 2, 2}}});
    file.add_root({{"translation", {10, 0, 0}}});
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", inverse_bind}});
    return file;
}

TEST(GltfSkin, VerticesFollowTheirJointsAndNotTheNode) {
    const Mesh mesh = load_mesh(skinned_node({1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0}));
    EXPECT_EQ(mesh.positions[0], V3f(0, 0, 0));   // first joint: scaled by 2
    EXPECT_EQ(mesh.positions[1], V3f(11, 5, 0));  // second: bound 5 up, moved 10 right
    EXPECT_EQ(mesh.positions[2], V3f(5, 4, 0));   // halfway between (0, 2) and (10, 6)
}

TEST(GltfSkin, WeightsAreScaledToOne) {
    const Mesh mesh = load_mesh(skinned_node({0, 0, 0, 0, 0, 2, 0, 0, 0.25f, 0.25f, 0, 0}));
    EXPECT_EQ(mesh.positions[0], V3f(0, 0, 0));
    EXPECT_EQ(mesh.positions[1], V3f(11, 5, 0));
    EXPECT_EQ(mesh.positions[2], V3f(5, 4, 0));
}

TEST(GltfSkin, WithoutInverseBindMatricesTheyAreIdentity) {
    TinyGltf file = skinned_node({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    file.json["skins"][0].erase("inverseBindMatrices");
    EXPECT_EQ(load_mesh(file).positions[1], V3f(11, 0, 0));
}

}  // namespace
}  // namespace petzval::io
