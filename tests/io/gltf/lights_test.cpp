// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual, cameras, and the lines of `petzval info` about them.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// A node with this light.
TinyGltf lit_by(json light, json node = json::object()) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = json::array({std::move(light)});
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.add_root(std::move(node));
    return file;
}

template <class Kind>
Kind only_light(const TinyGltf& file) {
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.lights.size(), 1u);
    return std::get<Kind>(loaded.scene.lights.at(0));
}

void expect_near(const V3f& a, const V3f& b) {
    EXPECT_LT((a - b).length(), 1e-6f) << a << " is not " << b;
}

/// A quarter turn about x: -z, where lights and cameras look, becomes y.
const json kLookUp = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

TEST(GltfLights, PointLight) {
    const auto light = only_light<PointLight>(
        lit_by({{"type", "point"}, {"color", {0.5, 1, 0.25}}, {"intensity", 100}},
               {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}}));
    EXPECT_EQ(light.position, V3f(1, 2, 3));
    EXPECT_EQ(light.intensity_cd[0], 50.f);  // scale does not change a light
    EXPECT_EQ(light.intensity_cd[1], 100.f);
    EXPECT_EQ(light.intensity_cd[2], 25.f);
}

TEST(GltfLights, DirectionalLightShinesAlongMinusZ) {
    const auto plain = only_light<SunLight>(lit_by({{"type", "directional"}}));
    EXPECT_EQ(plain.direction, V3f(0, 0, -1));
    EXPECT_EQ(plain.illuminance_lx[0], 1.f);
    const auto turned = only_light<SunLight>(lit_by({{"type", "directional"}, {"intensity", 6830}},
                                                    {{"rotation", kLookUp}, {"scale", {3, 3, 3}}}));
    expect_near(turned.direction, {0, 1, 0});
    EXPECT_EQ(turned.illuminance_lx[1], 6830.f);
}

TEST(GltfLights, SpotLight) {
    const auto light = only_light<SpotLight>(
        lit_by({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
               {{"translation", {1, 2, 3}}, {"rotation", kLookUp}}));
    EXPECT_EQ(light.position, V3f(1, 2, 3));
    expect_near(light.direction, {0, 1, 0});
    EXPECT_EQ(light.cos_inner, static_cast<float>(std::cos(0.25)));
    EXPECT_EQ(light.cos_outer, static_cast<float>(std::cos(0.5)));
    const auto standard =
        only_light<SpotLight>(lit_by({{"type", "spot"}, {"spot", json::object()}}));
    EXPECT_EQ(standard.cos_inner, 1.f);
    EXPECT_NEAR(standard.cos_outer, std::sqrt(0.5), 1e-7);
}

// With the radius that this extras object gives.
TinyGltf ball(json light, json extras) {
    light["extras"] = std::move(extras);
    return lit_by(std::move(light), {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}});
}

TEST(GltfLights, ARadiusMakesABall) {
    for (const json& extras : {json{{"petzval", {{"radius_m", 0.5}}}}, json{{"radius", 0.5}},
                               json{{"petzval", {{"radius_m", 0.5}}}, {"radius", 7}}}) {
        const GltfFile loaded = load(ball({{"type", "point"}, {"intensity", 100}}, extras));
        EXPECT_TRUE(loaded.scene.lights.empty());
        ASSERT_EQ(loaded.scene.meshes.size(), 1u);
        for (const V3f& p : loaded.scene.meshes[0].positions)
            EXPECT_NEAR((p - V3f(1, 2, 3)).length(), 0.5f, 1e-6f);  // scale does not change it
        const double nits = 100 / (double(kPi) * 0.25);
        EXPECT_NEAR(loaded.scene.materials[0].emissive[0], nits, 0.01 * nits);
        EXPECT_FALSE(loaded.scene.materials[0].beam);
        EXPECT_TRUE(contains_line(loaded.contents,
                                  "lights: 1 point, 0 spot, 0 directional (1 with "
                                  "a radius), 0 emissive meshes"));
        EXPECT_TRUE(contains_line(loaded.contents, "meshes: 0, placed 0 times"));
        EXPECT_TRUE(contains_line(loaded.honoured, "with a radius"));
        EXPECT_TRUE(loaded.warnings.empty());
    }
}

TEST(GltfLights, ASpotWithARadiusKeepsItsBeamAndWhite) {
    const GltfFile loaded =
        load(ball({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
                  {{"petzval", {{"radius_m", 0.1}, {"illuminant", "a"}}}}));
    ASSERT_EQ(loaded.scene.materials.size(), 1u);
    const Material& material = loaded.scene.materials[0];
    ASSERT_TRUE(material.beam);
    expect_near(material.beam->direction, {0, 0, -1});
    EXPECT_EQ(material.beam->cos_inner, static_cast<float>(std::cos(0.25)));
    EXPECT_EQ(material.beam->cos_outer, static_cast<float>(std::cos(0.5)));
    EXPECT_EQ(material.illuminant, 0);
    EXPECT_TRUE(contains_line(loaded.contents, "0 point, 1 spot, 0 directional (1 with a radius)"));
}

TEST(GltfLights, ARadiusOfNothingLeavesAPoint) {
    for (const json& extras :
         {json{{"petzval", {{"radius_m", 0}}}}, json{{"radius", 0}}, json{{"radius", -1}},
          json{{"radius", "wide"}}, json{{"radius", 1e30}}, json(3), json{{"Radius", 1}}}) {
        const GltfFile loaded = load(ball({{"type", "point"}}, extras));
        EXPECT_EQ(loaded.scene.lights.size(), 1u) << extras;
        EXPECT_TRUE(loaded.scene.meshes.empty() && loaded.warnings.empty()) << extras;
    }
}

TEST(GltfLights, ARadiusThatCannotBeIsNamed) {
    for (const json& radius : {json(-1), json("wide"), json(2e6)}) {
        const TempFolder folder;
        const auto path = ball({{"type", "point"}}, {{"petzval", {{"radius_m", radius}}}})
                              .save_glb(folder.path / "test.glb");
        EXPECT_THROW(static_cast<void>(load_gltf(path)), std::runtime_error) << radius;
    }
    const GltfFile sun = load(ball({{"type", "directional"}}, {{"petzval", {{"radius_m", 1}}}}));
    EXPECT_EQ(sun.scene.lights.size(), 1u);
    EXPECT_TRUE(contains_line(sun.warnings, "a directional light has no use for a radius"));
    for (const auto& [intensity, radius] : {std::pair(1.0, 1e-7), {1e38, 1e-3}, {1.0, 1e-5}}) {
        const GltfFile tiny = load(ball({{"type", "point"}, {"intensity", intensity}},
                                        {{"petzval", {{"radius_m", radius}}}}));
        EXPECT_EQ(tiny.scene.lights.size(), 1u);
        EXPECT_TRUE(contains_line(tiny.warnings, "is rendered as a point")) << radius;
    }
}

TEST(GltfLights, DarkOnesAreLeftOut) {
    EXPECT_TRUE(load(lit_by({{"type", "point"}, {"intensity", 0}})).scene.lights.empty());
    EXPECT_TRUE(load(lit_by({{"type", "point"}, {"color", {0, 0, 0}}})).scene.lights.empty());
}

TEST(GltfLights, AreListed) {
    const GltfFile loaded = load(lit_by({{"type", "point"}, {"range", 5}}));
    EXPECT_TRUE(contains_line(loaded.contents,
                              "lights: 1 point, 0 spot, 0 directional, 0 emissive meshes"));
    EXPECT_TRUE(contains_line(loaded.ignored, "1 light range"));
    EXPECT_TRUE(renders(loaded, "KHR_lights_punctual"));
}

TinyGltf seen_by(json camera, json node = json::object()) {
    TinyGltf file;
    node["camera"] = file.add("cameras", std::move(camera));
    file.add_root(std::move(node));
    return file;
}

const json kPerspective = {{"type", "perspective"},
                           {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}};

TEST(GltfCameras, Perspective) {
    const GltfFile loaded = load(seen_by(kPerspective, {{"name", "front"}}));
    ASSERT_EQ(loaded.cameras.size(), 1u);
    const GltfCamera& camera = loaded.cameras[0];
    EXPECT_EQ(camera.name, "front");
    EXPECT_FALSE(camera.orthographic);
    EXPECT_EQ(camera.yfov_rad, 0.5f);
    ASSERT_TRUE(camera.aspect.has_value());
    EXPECT_EQ(*camera.aspect, 1.5f);
    EXPECT_EQ(camera.to_world, M44f());
    EXPECT_TRUE(contains_line(loaded.contents, "camera 0: front, perspective, 28.65 deg vertical"));
}

TEST(GltfCameras, Orthographic) {
    json camera = {{"type", "orthographic"},
                   {"name", "plan"},
                   {"orthographic", {{"xmag", 2}, {"ymag", -3}, {"znear", 0}, {"zfar", 9}}}};
    const GltfFile loaded = load(seen_by(camera, {{"name", "node"}}));
    ASSERT_EQ(loaded.cameras.size(), 1u);
    EXPECT_EQ(loaded.cameras[0].name, "plan");
    EXPECT_TRUE(loaded.cameras[0].orthographic);
    EXPECT_EQ(loaded.cameras[0].xmag_m, 2.f);
    EXPECT_EQ(loaded.cameras[0].ymag_m, 3.f);
    EXPECT_TRUE(contains_line(loaded.contents, "camera 0: plan, orthographic, 4 x 6 m"));
}

TEST(GltfCameras, ScaleAndMirrorLeaveARigidFrame) {
    const GltfFile loaded = load(seen_by(
        kPerspective, {{"translation", {1, 2, 3}}, {"rotation", kLookUp}, {"scale", {-2, 3, 4}}}));
    ASSERT_EQ(loaded.cameras.size(), 1u);
    const M44f& m = loaded.cameras[0].to_world;
    expect_near(V3f(0, 0, 0) * m, {1, 2, 3});
    expect_near(V3f(0, 0, -1) * m, {1, 3, 3});
    expect_near(V3f(0, 1, 0) * m, {1, 2, 4});
    expect_near(V3f(1, 0, 0) * m, {2, 2, 3});  // right stays right
}

TEST(GltfCameras, ThoseThatCannotBeDrawnAreWarnedOf) {
    json wide = kPerspective;
    wide["perspective"]["yfov"] = 3.2;
    const GltfFile too_wide = load(seen_by(wide));
    EXPECT_TRUE(too_wide.cameras.empty());
    EXPECT_TRUE(contains_line(too_wide.warnings, "/cameras/0"));
    EXPECT_TRUE(load(seen_by({{"type", "fisheye"}})).cameras.empty());
    EXPECT_TRUE(load(seen_by(kPerspective, {{"scale", {1, 1, 0}}})).cameras.empty());
}

}  // namespace
}  // namespace petzval::io
