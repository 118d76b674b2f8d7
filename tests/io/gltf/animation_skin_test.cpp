// SPDX-License-Identifier: Apache-2.0
// Skins whose joints move, and morph targets whose weights do.
#include <gtest/gtest.h>

#include "tests/support/animation/animated_gltf.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::test {
namespace {

using nlohmann::json;

const std::vector<double> kSkinLooks = {0, 0.2, 0.5, 0.9, 1, 1.4, 1.8};

/// Eight joints in two chains of four, each of which turns and moves; nothing is skinned yet.
AnimatedGltf chains() {
    AnimatedGltf file;
    for (int j = 0; j < 8; ++j) {
        json node = {{"translation", {0.3 * j, 1, 0.1 * j}}};
        if (j % 4 != 3) node["children"] = {j + 1};
        file.add("nodes", std::move(node));
    }
    file.json["scene"] = 0;
    file.json["scenes"] = {{{"nodes", {0, 4}}}};
    for (int j = 0; j < 8; ++j) {
        const float s = 0.1f * float(j), c = std::sqrt(1 - s * s);
        file.add_channel(node_target(j, "rotation"), {0, 1, 2}, "VEC4",
                         {0, 0, 0, 1, s, 0, 0, c, 0, c, 0, -s});
    }
    file.add_channel(node_target(2, "translation"), {0, 2}, "VEC3", {0, 0, 0, 1, 2, 3});
    file.add_channel(node_target(5, "scale"), {0, 2}, "VEC3", {1, 1, 1, 0.5f, 2, 3});
    return file;
}

/// Matrices that are no rotations, one for each joint.
int add_bind_matrices(TinyGltf& file, size_t count) {
    std::vector<float> all;
    for (size_t j = 0; j < count; ++j)
        for (const float x : {1.f, 0.1f, 0.f, 0.f, -0.2f, 1.5f, 0.3f, 0.f, 0.f, 0.f, 0.8f, 0.f,
                              0.5f * float(j), -1.f, 0.25f, 1.f})
            all.push_back(x);
    return file.add_accessor<float>("MAT4", all);
}

json influences(TinyGltf& file, const std::vector<uint8_t>& joints,
                const std::vector<float>& weights, int set = 0) {
    const std::string number = std::to_string(set);
    return {{"JOINTS_" + number, file.add_accessor<uint8_t>("VEC4", joints)},
            {"WEIGHTS_" + number, file.add_accessor<float>("VEC4", weights)}};
}

constexpr std::initializer_list<uint8_t> kJoints = {0, 1, 2, 3, 4, 5, 6, 7, 3, 6, 0, 0, 1, 5, 7, 2};
constexpr std::initializer_list<float> kWeights = {
    0.25f, 0.25f, 0.25f, 0.25f, 0.5f, 0.125f, 0.25f, 0.125f, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0};

TEST(AnimatedSkin, VerticesFollowFourJoints) {
    AnimatedGltf file = chains();
    file.add_probe({{"attributes", influences(file, kJoints, kWeights)}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}},
                       {"inverseBindMatrices", add_bind_matrices(file, 8)}});
    file.add_root({{"mesh", 0}, {"skin", 0}, {"translation", {50, 50, 50}}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, VerticesMayFollowEightJoints) {
    AnimatedGltf file = chains();
    json attributes = influences(file, kJoints,
                                 {0.125f, 0.125f, 0.125f, 0.125f, 0.25f, 0, 0.25f, 0, 0.5f, 0, 0, 0,
                                  0.0625f, 0.0625f, 0.125f, 0.25f});
    attributes.update(influences(file, {7, 6, 5, 4, 3, 2, 1, 0, 1, 2, 0, 0, 0, 3, 4, 6},
                                 {0.125f, 0.125f, 0.125f, 0.125f, 0.25f, 0, 0.25f, 0, 0.25f, 0.25f,
                                  0, 0, 0.0625f, 0.1875f, 0.125f, 0.125f},
                                 1));
    file.add_probe({{"attributes", attributes}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}},
                       {"inverseBindMatrices", add_bind_matrices(file, 8)}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, TwoMeshesShareASkin) {
    AnimatedGltf file = chains();
    file.add_probe({{"attributes", influences(file, kJoints, kWeights)}});
    file.add_probe(
        {{"attributes",
          influences(file, {7, 0, 0, 0, 3, 2, 0, 0, 6, 1, 0, 0, 5, 4, 0, 0}, kWeights)}});
    file.add("skins", {{"joints", {4, 5, 6, 7, 0, 1, 2, 3}},
                       {"inverseBindMatrices", add_bind_matrices(file, 8)}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    file.add_root({{"mesh", 1}, {"skin", 0}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, OneMeshMayHaveTwoSkins) {
    AnimatedGltf file = chains();
    file.add_probe({{"attributes", influences(file, kJoints, kWeights)}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}}});
    file.add("skins", {{"joints", {7, 6, 5, 4, 3, 2, 1, 0}}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    file.add_root({{"mesh", 0}, {"skin", 1}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, BonesMayMirror) {
    AnimatedGltf file = chains();
    file.json["nodes"][0]["scale"] = {-1, 1, 1};
    file.json["nodes"][4]["scale"] = {-2, 1, 3};
    file.add_probe(
        {{"attributes",
          influences(file, kJoints, {1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0, 0, 0, 1, 0})}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, WeightsThatDoNotAddUpToOneAreScaled) {
    AnimatedGltf file = chains();
    file.add_probe({{"attributes", influences(file, kJoints,
                                              {1, 1, 1, 1, 0.1f, 0.1f, 0, 0, 3, 0.25f, 0, 0, 0.5f,
                                               0.125f, 0.25f, 0.0625f})}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}},
                       {"inverseBindMatrices", add_bind_matrices(file, 8)}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    expect_truth(file, kSkinLooks);
}

TEST(AnimatedSkin, JointsThatShrinkToNothingTakeTheirVerticesAlong) {
    AnimatedGltf file = chains();
    file.json.erase("animations");
    file.add_channel(node_target(0, "scale"), {0, 1, 2}, "VEC3", {1, 1, 1, 0, 0, 0, 1, 1, 1});
    file.add_probe(
        {{"attributes", influences(file, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0},
                                   {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4}}});
    file.add_root({{"mesh", 0}, {"skin", 0}});
    EXPECT_TRUE(load_at(file, 1).scene.meshes.empty());  // its triangles have no area
    expect_truth(file, {0, 0.5, 1.5});
}

/// A square whose two targets move positions, normals and tangents; its weights are animated.
AnimatedGltf morphed(const std::vector<float>& weights) {
    AnimatedGltf file;
    file.add_image(tiny_png(1, 1, {128, 128, 255, 255}));
    file.add("textures", {{"source", 0}});
    file.add("materials", {{"normalTexture", {{"index", 0}}}});
    const int tangents =
        file.add_accessor<float>("VEC4", {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, -1, 1, 0, 0, 1});
    const int uv = file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1, 1, 1});
    json first = {
        {"POSITION", file.add_positions({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 1, 0})},
        {"NORMAL", file.add_accessor<float>("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0})},
        {"TANGENT", file.add_accessor<float>("VEC3", {0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0})}};
    json second = {
        {"NORMAL", file.add_accessor<float>("VEC3", {0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0})}};
    file.add_probe({{"material", 0},
                    {"attributes", {{"TANGENT", tangents}, {"TEXCOORD_0", uv}}},
                    {"targets", {first, second}}});
    file.add_root({{"mesh", 0}});
    file.add_channel(node_target(0, "weights"), {0, 2}, "SCALAR", weights);
    return file;
}

/// The reference does not make lengths 1 between morphing and placing, which changes nothing.
TEST(AnimatedMorph, NormalsAreMorphedAndTurned) {
    AnimatedGltf file = morphed({0, 0, 1, 0.5f});
    file.json["nodes"][0]["scale"] = {1, 2, 3};
    expect_truth(file, kSkinLooks, 8);
}

TEST(AnimatedMorph, TangentsAreMorphed) {
    const Mesh mesh = load_at(morphed({0, 0, 1, 0}), 1.5).scene.meshes.at(0);
    ASSERT_EQ(mesh.tangents.size(), 4u);
    EXPECT_NEAR(mesh.tangents[0].x, 0.8, 1e-6);  // (1, 0.75, 0), which is 1.25 long
    EXPECT_NEAR(mesh.tangents[0].y, 0.6, 1e-6);
    EXPECT_NEAR(mesh.tangents[2].x, 0.6, 1e-6);
    EXPECT_NEAR(mesh.tangents[2].z, 0.8, 1e-6);
    EXPECT_EQ(mesh.tangents[2].w, -1);
}

TEST(AnimatedMorph, TargetsMayBeSparse) {
    AnimatedGltf file;
    const int indices = file.add_view_of<uint8_t>({1, 3}),
              values = file.add_view_of<float>({1, 2, 3, -4, 5, 6});
    file.add_probe();
    const int move =
        file.add("accessors", {{"componentType", 5126},
                               {"type", "VEC3"},
                               {"count", 4},
                               {"sparse",
                                {{"count", 2},
                                 {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                 {"values", {{"bufferView", values}}}}}});
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", move}}};
    file.add_root({{"mesh", 0}});
    file.add_channel(node_target(0, "weights"), {0, 2}, "SCALAR", {0, 2});
    EXPECT_EQ(load_at(file, 1).scene.meshes.at(0).positions.at(1), V3f(2, 2, 3));
    expect_truth(file, kSkinLooks, 4);
}

TEST(AnimatedMorph, WeightsOfANodeMoveThatNodeOnly) {
    AnimatedGltf file = morphed({0, 0, 1, 0});
    file.add_root({{"mesh", 0}, {"translation", {0, 0, 9}}});
    expect_truth(file, kSkinLooks, 8);
    file.json["meshes"][0]["weights"] = {0.5, 0.25};
    expect_truth(file, kSkinLooks, 8);
}

TEST(AnimatedMorph, AMeshIsSkinnedAfterItIsMorphed) {
    AnimatedGltf file = chains();
    const int move = file.add_positions({0, 0, 1, 1, 0, 0, 0, -2, 0, 0, 1, 1});
    file.add_probe(
        {{"attributes", influences(file, kJoints, kWeights)}, {"targets", {{{"POSITION", move}}}}});
    file.add("skins", {{"joints", {0, 1, 2, 3, 4, 5, 6, 7}},
                       {"inverseBindMatrices", add_bind_matrices(file, 8)}});
    const int node = file.add_root({{"mesh", 0}, {"skin", 0}});
    file.add_channel(node_target(node, "weights"), {0, 1, 2}, "SCALAR", {0, 1, -1});
    expect_truth(file, kSkinLooks, 4);
}

}  // namespace
}  // namespace petzval::test
