// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open, against the same files loaded as stills at single moments.
#include <gtest/gtest.h>

#include "io/gltf/animation/node_motion.h"
#include "tests/support/moving_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval {
namespace {

using namespace test;

constexpr double kAt = 0.5, kOpen = 0.5;
const V3d kAxis = V3d(1, 2, -0.5).normalized();

/// A mesh of two triangles with normals.
int add_wedge(TinyGltf& file, json more = json::object()) {
    more["attributes"]["POSITION"] =
        file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0.2f, 0.3f, 0.2f, 1});
    more["attributes"]["NORMAL"] =
        file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0.6f, 0.8f, 1, 0, 0, 0, 1, 0});
    more["indices"] = file.add_accessor<uint16_t>("SCALAR", {0, 1, 2, 1, 3, 2});
    return file.add_mesh(std::move(more));
}

/// Swings a node; its path has a kink in the middle of the exposure, where a step lies.
void swing(TinyGltf& file, int node) {
    spin(file, node, kAxis, 90);
    animate(file, node, "translation", {0, 0.5f, 1}, {0, 0, 0, 1, 2, 0, 3, 0, -1});
}

struct Case {
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

std::vector<Case> cases() {
    std::vector<Case> out;
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

size_t deforming(const Scene& scene) {
    return static_cast<size_t>(std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                             [](const Mesh& m) { return !m.steps.empty(); }));
}
size_t moving(const Scene& scene) {
    return static_cast<size_t>(std::count_if(scene.instances.begin(), scene.instances.end(),
                                             [](const Instance& i) { return i.moves; }));
}

void expect_still(const GltfFile& file) {
    EXPECT_EQ(moving(file.scene), 0u);
    EXPECT_EQ(deforming(file.scene), 0u);
    EXPECT_TRUE(file.scene.motions.empty());
    EXPECT_TRUE(file.scene.light_motions.empty());
    for (const GltfCamera& camera : file.cameras) EXPECT_TRUE(camera.steps.empty());
    EXPECT_FALSE(has_motion(file.scene));
}

TEST(GltfMotion, StepsAreTheStillsOfTheirTimes) {
    for (const auto& [name, file, moves, deforms] : cases()) {
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
    for (const auto& [name, file, moves, deforms] : cases()) {
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
    for (const auto& [name, file, moves, deforms] : cases()) {
        const SavedGltf saved(file);
        expect_still(saved.at(kAt, 0));
        expect_still(saved.at(7, kOpen, false));  // its end stays
        GltfFile before = saved.at(-7, kOpen, false);
        expect_still(before);
        EXPECT_TRUE(contains_line(before.remarks, "nothing moves")) << name;
        EXPECT_FALSE(contains_line(saved.at(kAt, kOpen).remarks, "nothing moves")) << name;
    }
}

/// A channel that moves what a pointer names, from `first` at 0 s to `last` at 1 s.
void animate_pointer(TinyGltf& file, const std::string& pointer, const char* type,
                     const std::vector<float>& first, const std::vector<float>& last) {
    std::vector<float> values = first;
    values.insert(values.end(), last.begin(), last.end());
    json& animation = file.json["animations"][0];
    animation["samplers"].push_back({{"input", file.add_accessor<float>("SCALAR", {0, 1})},
                                     {"output", file.add_accessor<float>(type, values)}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target",
          {{"path", "pointer"},
           {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
}

TEST(GltfMotion, WhatChangesButIsNotBlurredIsTold) {
    struct Held {
        const char *pointer, *type, *word;
        std::vector<float> first, last;
    };
    const Held cases[] = {
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
    for (const Held& held : cases) {
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

TEST(GltfMotion, CamerasZoomAsTheStillsDo) {
    TinyGltf file;
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}});
    for (int i = 0; i < 3; ++i) file.add_root({{"camera", i % 2}});
    animate_pointer(file, "/cameras/0/perspective/yfov", "SCALAR", {0.5f}, {1.5f});
    animate_pointer(file, "/cameras/1/orthographic/ymag", "SCALAR", {-2}, {4});
    const SavedGltf saved(file);
    const GltfFile open = saved.at(kAt, kOpen);
    ASSERT_EQ(open.cameras.size(), 3u);
    for (const GltfCamera& camera : open.cameras) {
        ASSERT_GE(camera.zoom.size(), 2u);
        for (size_t i = 0; i < camera.zoom.size(); ++i) {
            const double share = double(i) / double(camera.zoom.size() - 1) - 0.5;
            const GltfFile still = saved.at(kAt + share * kOpen);
            const GltfCamera& then = still.cameras[camera.orthographic ? 1 : 0];
            EXPECT_TRUE(then.zoom.empty());
            EXPECT_NEAR(camera.zoom[i], camera.orthographic ? then.ymag_m : then.yfov_rad, 1e-6);
        }
    }
    EXPECT_TRUE(contains_line(open.remarks, "while the shutter is open: 3 zooming cameras"));
    EXPECT_TRUE(saved.at(7, kOpen, false).cameras[0].zoom.empty());
    EXPECT_TRUE(contains_line(saved.at(7, kOpen, false).remarks, "nothing moves"));
}

TEST(GltfMotion, AViewThatIsNoneForAWhileIsHeld) {
    TinyGltf file;
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    file.add_root({{"camera", 0}});
    animate_pointer(file, "/cameras/0/perspective/yfov", "SCALAR", {-0.5f}, {1.5f});
    const GltfFile open = SavedGltf(file).at(kAt, 0.8);
    ASSERT_EQ(open.cameras.size(), 1u);
    EXPECT_TRUE(open.cameras[0].zoom.empty());
    EXPECT_TRUE(contains_line(open.warnings, "/cameras/0: its yfov leaves 0 to 180 degrees"));
    EXPECT_TRUE(contains_line(open.remarks, "shown as in the middle: views of cameras"));
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

template <class L>
void expect_near(const L& one, const Light& light) {
    const L& other = std::get<L>(light);
    if constexpr (requires { one.position; }) {
        EXPECT_LT((one.position - other.position).length(), 1e-4f);
    }
    if constexpr (requires { one.direction; }) {
        EXPECT_LT((one.direction - other.direction).length(), 1e-4f);
    }
    if constexpr (requires { one.cos_outer; }) {
        EXPECT_EQ(one.cos_outer, other.cos_outer);
    }
}

// A light of each kind on a node that turns and flies.
TEST(GltfMotion, LightsStandWhereTheStillsHaveThem) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    auto& lights = file.json["extensions"]["KHR_lights_punctual"]["lights"];
    lights = {{{"type", "point"}, {"intensity", 2}},
              {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}},
              {{"type", "directional"}}};
    const int root = file.add_root({{"children", {1, 2, 3}}});
    for (int i = 0; i < 3; ++i)
        file.add("nodes", {{"translation", {i, 1, 0}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    swing(file, root);
    const SavedGltf saved(file);
    const GltfFile open = saved.at(kAt, kOpen);
    ASSERT_EQ(open.scene.lights.size(), 3u);
    for (int i = 0; i <= 20; ++i) {
        const float time = float(i) / 20;
        const GltfFile still = saved.at(kAt + (double(time) - 0.5) * kOpen);
        expect_still(still);
        for (uint32_t k = 0; k < 3; ++k) {
            std::optional<Light> moved;
            const Light& light = light_at(open.scene, k, time, moved);
            ASSERT_EQ(light.index(), still.scene.lights[k].index());
            std::visit([&](const auto& one) { expect_near(one, still.scene.lights[k]); }, light);
        }
    }
}

TEST(GltfMotion, LightsWithARadiusAreBallsThatMove) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 2}, {"extras", {{"petzval", {{"radius_m", 0.1}}}}}}};
    const int node = file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    swing(file, node);
    const SavedGltf saved(file);
    const GltfFile open = saved.at(kAt, kOpen);
    ASSERT_EQ(open.scene.instances.size(), 1u);
    EXPECT_TRUE(open.scene.instances[0].moves);
    for (const float time : {0.f, 0.3f, 0.5f, 0.8f, 1.f}) {
        const GltfFile still = saved.at(kAt + (double(time) - 0.5) * kOpen);
        EXPECT_LT(apart(triangles_at(open.scene, time), triangles_at(still.scene, 0.5f)), 1e-3);
    }
}

// What is not followed is said.
TEST(GltfMotion, ASpotWithARadiusThatTurnsIsWarnedOf) {
    for (const bool turns : {false, true}) {
        TinyGltf file;
        file.json["extensionsUsed"] = {"KHR_lights_punctual"};
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "spot"},
             {"spot", json::object()},
             {"extras", {{"petzval", {{"radius_m", 0.1}}}}}}};
        const int node = file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        animate(file, node, "translation", {0, 1}, {0, 0, 0, 1, 2, 3});
        if (turns) spin(file, node, kAxis, 60);
        const GltfFile open = SavedGltf(file).at(kAt, kOpen);
        EXPECT_EQ(contains_line(open.warnings, "shines as in the middle"), turns);
    }
}

TEST(GltfMotion, CamerasStandWhereTheStillsHaveThem) {
    TinyGltf file;
    file.add("cameras",
             {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    const int root = file.add_root({{"children", {1}}, {"scale", {2, 2, 2}}});
    file.add("nodes", {{"camera", 0}, {"translation", {0, 1, 4}}});
    swing(file, root);
    const SavedGltf saved(file);
    const GltfFile open = saved.at(kAt, kOpen);
    ASSERT_EQ(open.cameras.size(), 1u);
    const auto& steps = open.cameras[0].steps;
    ASSERT_GE(steps.size(), 2u);
    for (size_t i = 0; i < steps.size(); i += 8) {
        const double share = double(i) / double(steps.size() - 1) - 0.5;
        const GltfFile still = saved.at(kAt + share * kOpen);
        expect_still(still);
        EXPECT_TRUE(steps[i].equalWithAbsError(still.cameras[0].to_world, 1e-6f)) << i;
    }
    EXPECT_TRUE(open.cameras[0].to_world.equalWithAbsError(saved.at(kAt).cameras[0].to_world, 0.f));
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
}  // namespace petzval
