// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open, against the same files loaded as stills at single moments.
#include <gtest/gtest.h>

#include "io/gltf/animation/node_motion.h"
#include "tests/io/gltf/swinging.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

using namespace test;

struct MotionCase {
    const char* name;
    TinyGltf file;
    size_t moving, deforming;  ///< instances that move, meshes that have steps
};

TinyGltf morphing(bool node_moves) {
    TinyGltf file;
    const int delta = file.add_accessor<float>("VEC3", {0, 0, 0, 0, 1, 0, 0, 0, 0.5f, 1, 0, 0});
    const int turn = file.add_accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 0, 1});
    const int mesh =
        add_wedge(file, {{"targets", json::array({{{"POSITION", delta}, {"NORMAL", turn}}})}});
    file.json["meshes"][0]["weights"] = {0.1};
    const int node = file.add_root({{"mesh", mesh}, {"scale", {2, 1, 0.5}}});
    animate(file, node, "weights", {0, 0.5f, 1}, {0, 0.7f, -0.2f});
    if (node_moves) swing(file, node);
    return file;
}

TinyGltf skinned() {
    TinyGltf file;
    const int joints =
        file.add_accessor<uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int weights = file.add_accessor<float>(
        "VEC4", {0.7f, 0.3f, 0, 0, 0.2f, 0.8f, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
    const int mesh =
        add_wedge(file, {{"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}});
    const int root = file.add_root({{"children", {1, 2}}});
    file.add("nodes", {{"translation", {0, 0.3, 0}}});
    file.add("nodes", {{"translation", {1, 0, 0}}, {"scale", {1, 2, 1}}});
    std::vector<float> bind;
    for (int j = 0; j < 2; ++j)
        bind.insert(bind.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f * float(j), 0, 0, 1});
    const int matrices = file.add_accessor<float>("MAT4", bind);
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
    const int shown = file.add_root({{"mesh", mesh}, {"skin", 0}});
    file.json["nodes"][shown]["translation"] = {9, 9, 9};  // of no meaning for a skin
    swing(file, 2);
    spin(file, root, V3d(0, 0, 1), 40);
    return file;
}

std::vector<MotionCase> motion_cases() {
    std::vector<MotionCase> out;
    TinyGltf parent;
    const int mesh = add_wedge(parent);
    const int root = parent.add_root({{"children", {1}}, {"translation", {1, 2, 3}}});
    parent.add("nodes", {{"mesh", mesh}, {"translation", {0, 1, 0}}, {"scale", {1, 2, 1}}});
    swing(parent, root);
    out.push_back({"under a moving parent", parent, 1, 0});

    TinyGltf chain = parent;
    chain.json["nodes"][1]["children"] = {2, 3};
    chain.add("nodes", {{"mesh", mesh}, {"rotation", {0, 0, 0.6, 0.8}}});
    chain.add("nodes",
              {{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1}}, {"mesh", mesh}});
    spin(chain, 1, V3d(0, 1, 0), -170);
    out.push_back({"a chain", chain, 3, 0});

    TinyGltf shared;
    add_wedge(shared);
    for (int i = 0; i < 3; ++i) shared.add_root({{"mesh", 0}, {"translation", {3 * i, 0, 0}}});
    spin(shared, 1, kAxis, 100);
    out.push_back({"shared by still and moving nodes", shared, 1, 0});

    TinyGltf many = parent;
    many.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const int places = many.add_accessor<float>("VEC3", {0, 0, 0, 5, 0, 0, 0, 5, 1});
    const int turns = many.add_accessor<float>("VEC4", {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 1, 0, 0, 0});
    many.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", places}, {"ROTATION", turns}};
    out.push_back({"instancing on a moving node", many, 3, 0});

    TinyGltf mirrored = parent;
    mirrored.json["nodes"][1]["scale"] = {-1, 2, 1};
    out.push_back({"a mirrored node", mirrored, 1, 0});

    TinyGltf scaled;
    add_wedge(scaled);
    const int grows = scaled.add_root({{"mesh", 0}});
    animate(scaled, grows, "scale", {0, 1}, {1, 1, 1, 3, 0.5f, -0.5f});
    out.push_back({"a node that is turned inside out", scaled, 1, 0});

    out.push_back({"a morphing mesh", morphing(false), 0, 1});
    out.push_back({"a morphing mesh on a moving node", morphing(true), 1, 1});
    out.push_back({"a skin", skinned(), 0, 1});
    return out;
}

TEST(GltfMotion, StepsAreTheStillsOfTheirTimes) {
    for (const auto& [name, file, moves, deforms] : motion_cases()) {
        const SavedGltf saved(file);
        const GltfFile open = saved.at(kAt, kOpen);
        EXPECT_EQ(open.scene.motions.size(), moves) << name;
        EXPECT_EQ(moving(open.scene), std::max(moves, deforms)) << name;
        EXPECT_EQ(deforming(open.scene), deforms) << name;
        for (const float time : {0.f, 0.25f, 0.5f, 0.75f, 1.f}) {
            const GltfFile still = saved.at(kAt + (double(time) - 0.5) * kOpen);
            expect_still(still);
            EXPECT_TRUE(same_triangles(triangles_at(open.scene, time),
                                       triangles_at(still.scene, 0.5f), 5e-3f))
                << name << " at " << time;
        }
        // The first and the last step are there however few there are.
        for (const float time : {0.f, 1.f}) {
            const GltfFile still = saved.at(kAt + (double(time) - 0.5) * kOpen);
            EXPECT_TRUE(same_triangles(triangles_at(open.scene, time),
                                       triangles_at(still.scene, 0.5f), 1e-5f))
                << name << " at " << time;
        }
    }
}

TEST(GltfMotion, TheArraysOfTheSceneAreThoseOfTheMiddle) {
    for (const auto& [name, file, moves, deforms] : motion_cases()) {
        const SavedGltf saved(file);
        GltfFile open = saved.at(kAt, kOpen);
        const GltfFile still = saved.at(kAt);
        for (Instance& instance : open.scene.instances) instance.moves = false;
        for (Mesh& mesh : open.scene.meshes) mesh.steps.clear();
        EXPECT_TRUE(
            same_triangles(triangles_at(open.scene, 0.5f), triangles_at(still.scene, 0.5f), 1e-5f))
            << name;
    }
}

TEST(GltfMotion, NormalsOfADeformingMeshAreThoseOfTheStills) {
    for (const TinyGltf& file : {morphing(false), skinned()}) {
        const SavedGltf saved(file);
        const GltfFile open = saved.at(kAt, kOpen);
        ASSERT_EQ(open.scene.meshes.size(), 1u);
        const Mesh& mesh = open.scene.meshes[0];
        ASSERT_GE(mesh.steps.size(), 2u);
        const M44f to_world = open.scene.instances[0].to_world;
        for (size_t i = 0; i < mesh.steps.size(); ++i) {
            const double share = double(i) / double(mesh.steps.size() - 1) - 0.5;
            const GltfFile still = saved.at(kAt + share * kOpen);
            for (size_t v = 0; v < mesh.positions.size(); ++v) {
                V3f n = mesh.steps[i].normals[v];
                if (!open.scene.instances[0].identity)
                    to_world.inverse().transposed().multDirMatrix(n, n);
                EXPECT_LT((unit(n) - still.scene.meshes[0].normals[v]).length(), 1e-5f) << i;
            }
        }
    }
}

TEST(GltfMotion, NothingMovesWhereTheShutterOrTheAnimationStandsStill) {
    for (const auto& [name, file, moves, deforms] : motion_cases()) {
        const SavedGltf saved(file);
        expect_still(saved.at(kAt, 0));
        expect_still(saved.at(7, kOpen, false));  // its end stays
        GltfFile before = saved.at(-7, kOpen, false);
        expect_still(before);
        EXPECT_TRUE(contains_line(before.remarks, "nothing moves")) << name;
        EXPECT_FALSE(contains_line(saved.at(kAt, kOpen).remarks, "nothing moves")) << name;
    }
}

TEST(GltfMotion, WhatChangesButIsNotBlurredIsTold) {
    struct Held {
        const char *pointer, *type, *word;
        std::vector<float> first, last;
    };
    const Held motion_cases[] = {
        {"/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", "materials", {0}, {1}},
        {"/materials/0/normalTexture/extensions/KHR_texture_transform/offset",
         "VEC2",
         "textures",
         {0, 0},
         {1, 0}},
        {"/extensions/KHR_lights_punctual/lights/0/color",
         "VEC3",
         "the light of lamps",
         {1, 0, 0},
         {0, 1, 0}},
        {"/nodes/1/extensions/KHR_node_visibility/visible", "SCALAR", "what is visible", {1}, {0}}};
    for (const Held& held : motion_cases) {
        TinyGltf file;
        file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility"};
        file.add("materials",
                 {{"normalTexture",
                   {{"index", 0}, {"extensions", {{"KHR_texture_transform", json::object()}}}}}});
        file.add_image(tiny_png(1, 1, {128, 128, 255, 255}));
        file.add("textures", {{"source", 0}});
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
        file.add_root({{"mesh", add_wedge(file)}});
        file.add_root({{"extensions",
                        {{"KHR_lights_punctual", {{"light", 0}}},
                         {"KHR_node_visibility", {{"visible", true}}}}}});
        animate_pointer(file, held.pointer, held.type, held.first, held.last);
        const std::string told =
            std::string("while the shutter is open: not blurred but shown as in the middle: ") +
            held.word;
        const double open_s = std::string(held.word) == "what is visible" ? 1.5 : kOpen;
        const GltfFile open = SavedGltf(file).at(0.9, open_s, false);
        EXPECT_TRUE(contains_line(open.remarks, told)) << held.word;
        EXPECT_FALSE(contains_line(open.remarks, "nothing moves")) << held.word;
        // Nothing changes after the end.
        EXPECT_TRUE(contains_line(SavedGltf(file).at(7, kOpen, false).remarks, "nothing moves"));
        swing(file, 0);
        const GltfFile both = SavedGltf(file).at(0.9, open_s, false);
        EXPECT_TRUE(contains_line(both.remarks, "while the shutter is open: 1 moving instance"));
        EXPECT_TRUE(contains_line(
            both.remarks, std::string("; not blurred but shown as in the middle: ") + held.word));
    }
}

TEST(GltfMotion, AChangeBetweenTwoTimeStepsIsTold) {
    TinyGltf file;
    file.add("materials", json::object());
    file.add_root({{"mesh", add_wedge(file)}});
    json& animation = file.json["animations"][0];
    animate_pointer(file, "/materials/0/alphaCutoff", "SCALAR", {0}, {0});
    animation["samplers"][0]["input"] =
        file.add_accessor<float>("SCALAR", {0, 0.5001f, 0.5002f, 0.5003f, 1});
    animation["samplers"][0]["output"] = file.add_accessor<float>("SCALAR", {0, 0, 1, 0, 0});
    EXPECT_TRUE(contains_line(SavedGltf(file).at(0.5, 1, false).remarks, "middle: materials"));
    EXPECT_TRUE(contains_line(SavedGltf(file).at(0.2, 0.4, false).remarks, "nothing moves"));
}

TEST(GltfMotion, AConstantTrackMovesNothing) {
    TinyGltf file;
    const int node = file.add_root({{"mesh", add_wedge(file)}});
    animate(file, node, "translation", {0, 1}, {1, 2, 3, 1, 2, 3});
    const auto q = quaternion(kAxis, 30);
    animate(file, node, "rotation", {0, 1}, {q[0], q[1], q[2], q[3], q[0], q[1], q[2], q[3]});
    std::vector<float> cubic(18, 0.f);
    for (const size_t at : {3, 4, 5, 12, 13, 14}) cubic[at] = 0.3f;
    animate(file, node, "scale", {0, 1}, cubic, "CUBICSPLINE");
    expect_still(SavedGltf(file).at(kAt, kOpen));
}

TEST(GltfMotion, AMeshThatMovesKeepsTheStillOnesBesideItBaked) {
    TinyGltf file;
    for (int i = 0; i < 2; ++i) file.add_root({{"mesh", add_wedge(file)}, {"scale", {1, 2, 1}}});
    spin(file, 1, kAxis, 90);
    const GltfFile open = SavedGltf(file).at(kAt, kOpen);
    ASSERT_EQ(open.scene.instances.size(), 2u);
    EXPECT_TRUE(open.scene.instances[0].identity);
    EXPECT_FALSE(open.scene.instances[0].moves);
    EXPECT_TRUE(open.scene.instances[1].moves);
}

// Small in the middle, there before and after; there from a moment on; flat all the time.
TEST(GltfMotion, WhatDoesNotShowInTheMiddleShowsAtOtherTimes) {
    TinyGltf shrinks, appears, flat;
    for (TinyGltf* file : {&shrinks, &appears, &flat}) file->add_root({{"mesh", add_wedge(*file)}});
    animate(shrinks, 0, "scale", {0, 0.5f, 1}, {2, 2, 2, 0, 0, 0, 1, 1, 1});
    animate(appears, 0, "scale", {0, 0.6f}, {0, 0, 0, 1, 1, 1}, "STEP");
    flat.json["nodes"][0]["scale"] = {1, 1, 0};
    swing(flat, 0);
    for (const TinyGltf& file : {shrinks, appears, flat}) {
        const SavedGltf saved(file);
        const GltfFile open = saved.at(kAt, kOpen, false);
        ASSERT_EQ(moving(open.scene), 1u);
        for (const M44f& m : open.scene.motions[0].to_world) {
            const double det = M44d(m).determinant();
            EXPECT_TRUE(std::isfinite(1 / det)) << m;
        }
        for (const float time : {0.f, 0.1f, 0.9f, 1.f}) {
            const double at_s = kAt + (double(time) - 0.5) * kOpen;
            const GltfFile still = saved.at(at_s, 0, false);
            const auto now = triangles_at(open.scene, time);
            if (still.scene.instances.empty())
                for (const PlacedTriangle& one : now) EXPECT_LT(one.front.length(), 1e-6f);
            else
                EXPECT_TRUE(same_triangles(now, triangles_at(still.scene, 0.5f), 5e-3f)) << time;
        }
    }
}

// A clip that does not end as it begins stays within its turn: no blur from its end to its begin.
TEST(GltfMotion, AnOpenClipDoesNotJumpBackWhileTheShutterIsOpen) {
    TinyGltf file;
    const int node = file.add_root({{"mesh", add_wedge(file)}});
    animate(file, node, "translation", {0, 1}, {0, 0, 0, 8, 0, 0});
    const GltfFile open = SavedGltf(file).at(0.9, 0.4);
    for (const auto& [time, x] :
         {std::pair(0.f, 5.6f), std::pair(0.5f, 7.2f), std::pair(0.75f, 8.f), std::pair(1.f, 8.f)})
        EXPECT_NEAR(triangles_at(open.scene, time)[0].corners[0].x, x, 1e-2f) << time;
}

// A wheel that has turned once goes on.
TEST(GltfMotion, AClosedClipGoesOnWhileTheShutterIsOpen) {
    TinyGltf file;
    const int node = file.add_root({{"mesh", add_wedge(file)}});
    spin(file, node, V3d(0, 0, 1), 360);
    const SavedGltf saved(file);
    const GltfFile open = saved.at(0.95, 0.2);
    for (const float time : {0.f, 0.5f, 0.75f, 1.f}) {
        const GltfFile still = saved.at(0.95 + (double(time) - 0.5) * 0.2);
        EXPECT_TRUE(
            same_triangles(triangles_at(open.scene, time), triangles_at(still.scene, 0.5f), 2e-3f))
            << time;
    }
}

}  // namespace
}  // namespace petzval::io
