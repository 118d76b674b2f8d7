// SPDX-License-Identifier: Apache-2.0
// Lights and cameras that move or zoom while the shutter is open, against stills of single moments.
#include "tests/io/gltf/swinging.h"

namespace petzval::io {
namespace {

using namespace test;

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

template <class L>
void expect_near_lamp(const L& one, const Light& light) {
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
            std::visit([&](const auto& one) { expect_near_lamp(one, still.scene.lights[k]); },
                       light);
        }
    }
}

/// A node with a light of one of three sizes: a ball, a rectangle, an ellipse.
int add_sized(TinyGltf& file, json light, int size) {
    json node = json::object();
    if (size == 0)
        light["extras"]["petzval"]["radius_m"] = 0.1;
    else
        node["extras"]["petzval"] = {{"area", {0.4, 0.1}},
                                     {"shape", size == 1 ? "rectangle" : "ellipse"}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {std::move(light)};
    node["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    return file.add_root(std::move(node));
}

TEST(GltfMotion, LightsWithASizeMoveAsTheStillsDo) {
    for (const int size : {0, 1, 2}) {
        TinyGltf file;
        swing(file, add_sized(file, {{"type", "point"}, {"intensity", 2}}, size));
        const SavedGltf saved(file);
        const GltfFile open = saved.at(kAt, kOpen);
        ASSERT_EQ(open.scene.instances.size(), 1u) << size;
        EXPECT_TRUE(open.scene.instances[0].moves);
        for (const float time : {0.f, 0.3f, 0.5f, 0.8f, 1.f}) {
            const GltfFile still = saved.at(kAt + (double(time) - 0.5) * kOpen);
            expect_still(still);
            EXPECT_LT(apart(triangles_at(open.scene, time), triangles_at(still.scene, 0.5f)), 1e-3)
                << size << ", at " << time;
        }
    }
}

// What is not followed is said.
TEST(GltfMotion, ASpotWithASizeThatTurnsIsWarnedOf) {
    for (const int size : {0, 1})
        for (const bool turns : {false, true}) {
            TinyGltf file;
            const int node = add_sized(file, {{"type", "spot"}, {"spot", json::object()}}, size);
            animate(file, node, "translation", {0, 1}, {0, 0, 0, 1, 2, 3});
            if (turns) spin(file, node, kAxis, 60);
            const GltfFile open = SavedGltf(file).at(kAt, kOpen);
            EXPECT_EQ(contains_line(open.warnings, "shines as in the middle"), turns) << size;
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

}  // namespace
}  // namespace petzval::io
