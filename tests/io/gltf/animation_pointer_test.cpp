// SPDX-License-Identifier: Apache-2.0
// What KHR_animation_pointer moves besides nodes.
#include <gtest/gtest.h>

#include "tests/support/animation/animated_gltf.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_png.h"

namespace petzval::test {
namespace {

using nlohmann::json;

/// A triangle with this material.
AnimatedGltf with_material(json material) {
    AnimatedGltf file;
    file.add("materials", std::move(material));
    file.add_root({{"mesh", file.add_probe({{"material", 0}})}});
    return file;
}

/// Adds a channel from `first` at 0 s to `last` at 2 s.
void move(AnimatedGltf& file, const std::string& pointer, const std::vector<float>& first,
          const std::vector<float>& last, const char* mode = "LINEAR") {
    const std::string type = first.size() == 1 ? "SCALAR" : "VEC" + std::to_string(first.size());
    std::vector<float> values = first;
    values.insert(values.end(), last.begin(), last.end());
    file.add_channel(pointer_target(pointer), {0, 2}, type.c_str(), values, mode);
}

Material material_at(const TinyGltf& file, double time_s) {
    return load_at(file, time_s).scene.materials.at(0);
}

TEST(AnimationPointer, FactorsOfMaterialsMove) {
    AnimatedGltf file =
        with_material({{"alphaMode", "MASK"},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}},
                       {"extensions",
                        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1}}},
                         {"KHR_materials_clearcoat", json::object()},
                         {"KHR_materials_sheen", json::object()},
                         {"KHR_materials_anisotropy", json::object()},
                         {"KHR_materials_iridescence", json::object()},
                         {"KHR_materials_specular", json::object()},
                         {"KHR_materials_transmission", json::object()},
                         {"KHR_materials_ior", json::object()}}}});
    const std::string at = "/materials/0/", layer = at + "extensions/KHR_materials_";
    move(file, at + "pbrMetallicRoughness/baseColorFactor", {0, 0.5f, 1, 1}, {1, 0, 0, 0});
    move(file, at + "pbrMetallicRoughness/metallicFactor", {0}, {1});
    move(file, at + "pbrMetallicRoughness/roughnessFactor", {1}, {0.5f});
    move(file, at + "alphaCutoff", {0}, {0.5f});
    move(file, at + "emissiveFactor", {0, 0, 0}, {1, 0.5f, 0.25f});
    move(file, layer + "emissive_strength/emissiveStrength", {0}, {8});
    move(file, layer + "clearcoat/clearcoatFactor", {0.5f}, {1});
    move(file, layer + "clearcoat/clearcoatRoughnessFactor", {0.25f}, {0.75f});
    move(file, layer + "sheen/sheenColorFactor", {0, 0, 0}, {1, 0.5f, 0});
    move(file, layer + "sheen/sheenRoughnessFactor", {0}, {1});
    move(file, layer + "anisotropy/anisotropyStrength", {0}, {1});
    move(file, layer + "anisotropy/anisotropyRotation", {0}, {3});
    move(file, layer + "iridescence/iridescenceFactor", {0}, {1});
    move(file, layer + "iridescence/iridescenceIor", {1}, {2});
    move(file, layer + "iridescence/iridescenceThicknessMaximum", {100}, {500});
    move(file, layer + "specular/specularFactor", {0}, {1});
    move(file, layer + "specular/specularColorFactor", {0, 1, 0}, {1, 1, 0.5f});
    move(file, layer + "transmission/transmissionFactor", {0}, {1});
    move(file, layer + "ior/ior", {1}, {2});
    const io::GltfFile loaded = load_at(file, 0.5);
    const Material& m = loaded.scene.materials.at(0);
    EXPECT_FLOAT_EQ(m.base_color[0], 0.25f);
    EXPECT_FLOAT_EQ(m.base_color[1], 0.375f);
    EXPECT_FLOAT_EQ(m.base_color[2], 0.75f);
    EXPECT_FLOAT_EQ(m.alpha, 0.75f);
    EXPECT_FLOAT_EQ(m.metallic, 0.25f);
    EXPECT_FLOAT_EQ(m.roughness, 0.875f);
    EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.125f);
    EXPECT_FLOAT_EQ(m.emissive[0], 0.5f);  // a quarter of 1 times a quarter of 8
    EXPECT_FLOAT_EQ(m.emissive[2], 0.125f);
    EXPECT_FLOAT_EQ(m.coat, 0.625f);
    EXPECT_FLOAT_EQ(m.coat_roughness, 0.375f);
    EXPECT_FLOAT_EQ(m.sheen_color[1], 0.125f);
    EXPECT_FLOAT_EQ(m.sheen_roughness, 0.25f);
    EXPECT_FLOAT_EQ(m.anisotropy, 0.25f);
    EXPECT_FLOAT_EQ(m.anisotropy_rotation_rad, 0.75f);
    EXPECT_FLOAT_EQ(m.iridescence, 0.25f);
    EXPECT_FLOAT_EQ(m.film_ior, 1.25f);
    EXPECT_FLOAT_EQ(m.film_thickest_nm, 200);
    EXPECT_FLOAT_EQ(m.specular, 0.25f);
    EXPECT_FLOAT_EQ(m.specular_color[2], 0.125f);
    EXPECT_FLOAT_EQ(m.transmission, 0.25f);
    EXPECT_FLOAT_EQ(m.ior, 1.25f);
    for (const std::string& line : loaded.warnings) EXPECT_FALSE(has(line, "animates")) << line;
}

TEST(AnimationPointer, VolumesAndGlossinessMove) {
    AnimatedGltf file =
        with_material({{"extensions",
                        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                         {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}});
    const std::string volume = "/materials/0/extensions/KHR_materials_volume/";
    move(file, volume + "attenuationDistance", {1}, {5});
    move(file, volume + "attenuationColor", {0, 0.5f, 1}, {1, 1, 1});
    EXPECT_FLOAT_EQ(material_at(file, 1).attenuation_distance_m, 3);
    EXPECT_FLOAT_EQ(material_at(file, 1).attenuation_color[1], 0.75f);

    AnimatedGltf glossy =
        with_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", json::object()}}}});
    const std::string at = "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/";
    move(glossy, at + "specularFactor", {0, 0, 0}, {1, 0.5f, 0.25f});
    move(glossy, at + "glossinessFactor", {0}, {1});
    EXPECT_FLOAT_EQ(material_at(glossy, 1).specular_color[1], 0.25f);
    EXPECT_FLOAT_EQ(material_at(glossy, 0.5).roughness, 0.75f);
}

TEST(AnimationPointer, FactorsThatTheFileLeavesToTheirDefaultMoveToo) {
    AnimatedGltf file = with_material({{"name", "bare"}});
    move(file, "/materials/0/pbrMetallicRoughness/metallicFactor", {0}, {1});
    EXPECT_FLOAT_EQ(material_at(file, 1).metallic, 0.5f);
}

TEST(AnimationPointer, TexturesSlideTurnAndGrow) {
    const json transform = {{"KHR_texture_transform", {{"offset", {7, 7}}}}};
    AnimatedGltf file =
        with_material({{"pbrMetallicRoughness",
                        {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}},
                       {"normalTexture", {{"index", 0}, {"scale", 1}}}});
    file.add_image(tiny_png(1, 1, {128, 128, 255, 255}));
    file.add("textures", {{"source", 0}});
    const std::string at =
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    move(file, at + "offset", {0, 0}, {1, 0.5f});
    move(file, at + "rotation", {0}, {2});
    move(file, at + "scale", {1, 1}, {3, 5});
    move(file, "/materials/0/normalTexture/scale", {0}, {4});
    const Material m = material_at(file, 1);
    const TextureSlot& slot = m.base_color_texture;
    // Offset (1/2, 1/4), 1 radian, scale (2, 3).
    const float c = std::cos(1.f), s = std::sin(1.f);
    const std::array<float, 3> u = {2 * c, 3 * s, 0.5f}, v = {-2 * s, 3 * c, 0.25f};
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(slot.u_row[k], u[k], 1e-6) << k;
        EXPECT_NEAR(slot.v_row[k], v[k], 1e-6) << k;
    }
    EXPECT_FLOAT_EQ(m.normal_scale, 2);
}

AnimatedGltf with_light(const char* type) {
    AnimatedGltf file;
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", type}, {"color", {1, 1, 1}}, {"intensity", 1}}};
    if (std::string(type) == "spot")
        file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"] = json::object();
    file.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_animation_pointer"};
    file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return file;
}

TEST(AnimationPointer, LightsMove) {
    AnimatedGltf file = with_light("spot");
    const std::string at = "/extensions/KHR_lights_punctual/lights/0/";
    move(file, at + "color", {1, 0, 0.5f}, {0, 1, 0.5f});
    move(file, at + "intensity", {0}, {8});
    move(file, at + "spot/innerConeAngle", {0}, {0.5f});
    move(file, at + "spot/outerConeAngle", {0.5f}, {1});
    move(file, "/nodes/0/translation", {0, 0, 0}, {0, 4, 0});
    const io::GltfFile loaded = load_at(file, 0.5);
    const auto& light = std::get<SpotLight>(loaded.scene.lights.at(0));
    EXPECT_FLOAT_EQ(light.intensity_cd[0], 1.5f);  // 2 cd, and a red of 3/4
    EXPECT_FLOAT_EQ(light.intensity_cd[1], 0.5f);
    EXPECT_FLOAT_EQ(light.cos_inner, std::cos(0.125f));
    EXPECT_FLOAT_EQ(light.cos_outer, std::cos(0.625f));
    EXPECT_EQ(light.position, V3f(0, 1, 0));
    EXPECT_TRUE(renders(loaded, "KHR_animation_pointer"));
    file.json["extensionsRequired"] = {"KHR_animation_pointer"};
    EXPECT_EQ(load_at(file, 0.5).scene.lights.size(), 1u);
}

TEST(AnimationPointer, CamerasMove) {
    AnimatedGltf file;
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}});
    file.add_root({{"camera", 0}});
    file.add_root({{"camera", 1}});
    move(file, "/cameras/0/perspective/yfov", {0.5f}, {1.5f});
    move(file, "/cameras/0/perspective/aspectRatio", {1}, {3});
    move(file, "/cameras/1/orthographic/xmag", {2}, {4});
    file.add_channel(node_target(0, "translation"), {0, 2}, "VEC3", {0, 0, 0, 2, 4, 6});
    const io::GltfFile loaded = load_at(file, 1);
    ASSERT_EQ(loaded.cameras.size(), 2u);
    EXPECT_FLOAT_EQ(loaded.cameras[0].yfov_rad, 1);
    EXPECT_FLOAT_EQ(loaded.cameras[0].aspect.value_or(0), 2);
    EXPECT_EQ(loaded.cameras[0].to_world[3][1], 2);
    EXPECT_FLOAT_EQ(loaded.cameras[1].xmag_m, 3);
}

TEST(AnimationPointer, NodesAppearAndVanish) {
    AnimatedGltf file;
    const json visible = {{"KHR_node_visibility", {{"visible", true}}}};
    file.json["extensionsUsed"] = {"KHR_node_visibility", "KHR_animation_pointer"};
    file.add_root({{"mesh", file.add_probe()}, {"extensions", visible}});
    const int output = file.add_accessor<uint8_t>("SCALAR", {1, 0, 1});
    for (const char* mode : {"STEP", "LINEAR"}) {  // a truth has no values between
        file.json.erase("animations");
        file.add_channel_to(output,
                            pointer_target("/nodes/0/extensions/KHR_node_visibility/visible"),
                            {0, 1, 2}, mode);
        EXPECT_EQ(load_at(file, 0.9).scene.meshes.size(), 1u);
        EXPECT_EQ(load_at(file, 1).scene.meshes.size(), 0u);
        EXPECT_EQ(load_at(file, 1.9).scene.meshes.size(), 0u);
    }
}

TEST(AnimationPointer, WeightsOfAMeshMoveAsAListOrOneByOne) {
    AnimatedGltf file;
    json targets = json::array();
    for (const auto& by : {std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0},
                           std::vector<float>{0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}})
        targets.push_back({{"POSITION", file.add_positions(by)}});
    file.add_root({{"mesh", file.add_probe({{"targets", targets}})}});
    file.json["meshes"][0]["weights"] = {0.25, 0.5};
    file.add_channel(pointer_target("/meshes/0/weights/1"), {0, 2}, "SCALAR", {0, 2});
    EXPECT_EQ(load_at(file, 0.5).scene.meshes.at(0).positions.at(0), V3f(0.25f, 0.5f, 0));
    EXPECT_EQ(load_at(file, 1.5).scene.meshes.at(0).positions.at(0), V3f(0.25f, 1.5f, 0));
    file.json.erase("animations");
    file.add_channel(pointer_target("/meshes/0/weights"), {0, 2}, "SCALAR", {0, 2, 4, 0});
    EXPECT_EQ(load_at(file, 0.5).scene.meshes.at(0).positions.at(0), V3f(1, 1.5f, 0));
    file.json["meshes"][0].erase("weights");
    EXPECT_EQ(load_at(file, 0.5).scene.meshes.at(0).positions.at(0), V3f(1, 1.5f, 0));
}

TEST(AnimationPointer, ASingleWeightMovesWhereTheFileLeavesTheListOut) {
    AnimatedGltf file;
    const int up = file.add_positions({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
    file.add_root(
        {{"mesh", file.add_probe({{"targets", {{{"POSITION", up}}, {{"POSITION", up}}}}})}});
    file.add_channel(pointer_target("/meshes/0/weights/1"), {0, 2}, "SCALAR", {0, 2});
    EXPECT_EQ(load_at(file, 0.5).scene.meshes.at(0).positions.at(0), V3f(0, 0.5f, 0));
    file.json["meshes"][0]["weights"] = {1, 0};
    file.json.erase("animations");
    file.add_channel(pointer_target("/nodes/0/weights/1"), {0, 2}, "SCALAR", {0, 2});
    EXPECT_EQ(load_at(file, 0.5).scene.meshes.at(0).positions.at(0), V3f(0, 1.5f, 0));
}

TEST(AnimationPointer, ValuesBeyondTheirRangeAreClamped) {
    AnimatedGltf file = with_material({{"pbrMetallicRoughness", json::object()},
                                       {"extensions", {{"KHR_materials_ior", json::object()}}}});
    const std::string at = "/materials/0/pbrMetallicRoughness/";
    file.add_channel(pointer_target(at + "metallicFactor"), {0, 2}, "SCALAR",
                     {0, 0.5f, 9, -9, 0.5f, 0}, "CUBICSPLINE");  // overshoots to 5
    move(file, at + "roughnessFactor", {-1}, {-2});
    move(file, at + "baseColorFactor", {2, -1, 0.5f, 3}, {4, -3, 0.5f, 5});
    move(file, "/materials/0/extensions/KHR_materials_ior/ior", {0.25f}, {0.75f});
    const Material m = material_at(file, 1);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 0);
    EXPECT_EQ(m.base_color[0], 1);
    EXPECT_EQ(m.base_color[1], 0);
    EXPECT_EQ(m.alpha, 1);
    EXPECT_EQ(m.ior, 1);
    AnimatedGltf lit = with_light("point");
    move(lit, "/extensions/KHR_lights_punctual/lights/0/intensity", {-1}, {-3});
    EXPECT_TRUE(load_at(lit, 1).scene.lights.empty());
}

class Nowhere : public testing::TestWithParam<const char*> {};

TEST_P(Nowhere, IsWarnedOfAndChangesNothing) {
    AnimatedGltf file = with_light("point");
    file.add("materials", {{"name", "bare"}});
    file.add("nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
    const int up = file.add_positions({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
    file.add_root({{"mesh", file.add_probe({{"material", 0}, {"targets", {{{"POSITION", up}}}}})},
                   {"children", {1}}});
    file.json["meshes"][0]["weights"] = {0.5};
    const Shape before = [&] {
        const io::GltfFile loaded = load(file);
        return shape_of(loaded.scene, loaded.scene.instances.at(0));
    }();
    // As many numbers as any property takes.
    file.add_channel(pointer_target(GetParam()), {0}, "VEC4", {0.5f, 0.5f, 0.5f, 0.5f});
    const io::GltfFile loaded = load_at(file, 0.5);
    EXPECT_TRUE(contains_line(loaded.warnings, "/animations/0/channels/0/target: animates"));
    EXPECT_EQ(
        apart(before.positions, shape_of(loaded.scene, loaded.scene.instances.at(0)).positions), 0);
    EXPECT_EQ(loaded.scene.lights.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Pointers, Nowhere,
    testing::Values(
        "", "/", "nodes/0/translation", "/nodes", "/nodes/1/color", "/nodes/0",
        "/nodes/9/translation", "/nodes/00/translation", "/nodes/-/translation",
        "/nodes/-1/translation", "/nodes/99999999999999999999999999/translation", "/nodes/0/name",
        "/nodes/0/mesh", "/nodes/0/children/0", "/nodes/0/translation~", "/nodes/0~2/translation",
        "/nodes/2/children/translation", "/nodes/2/children/weights", "/nodes/0/weights",
        "/nodes/0/weights/0", "/nodes/1/weights/0", "/nodes/1/translation", "/nodes/1/rotation",
        "/nodes/0/extensions/KHR_node_visibility/visible", "/materials/0/normalTexture/scale",
        "/materials/7/alphaCutoff", "/materials/0/extensions/KHR_materials_ior/ior",
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/"
        "KHR_texture_transform/offset",
        "/meshes/0/weights/1", "/meshes/0/weights/01", "/meshes/0/weights/00",
        "/meshes/0/weights/123456789012", "/meshes/0/primitives/weights",
        "/meshes/0/primitives/0/weights", "/materials/0/weights/0", "/cameras/0/perspective/yfov",
        "/extensions/KHR_lights_punctual/lights/1/intensity",
        "/extensions/KHR_lights_punctual/lights/color",
        "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
        "/extensions/KHR_lights_punctual/lights/00/color",
        "/extensions/KHR_lights_punctual/lights/18446744073709551616/color", "/asset/version/color",
        "/scenes/0/nodes/color"));

}  // namespace
}  // namespace petzval::test
