// SPDX-License-Identifier: Apache-2.0
// Suns with an angle, area lamps, lamps that are not seen, and what a scene asks for:
// extras.petzval.
#include <gtest/gtest.h>

#include "io/base/error.h"
#include "tests/support/load_tiny_gltf.h"

namespace petzval::io {
namespace {

using nlohmann::json;

TinyGltf lit(json light, json node = json::object()) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = json::array({std::move(light)});
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.add_root(std::move(node));
    return file;
}

json extras(json ours) {
    return {{"petzval", std::move(ours)}};
}

TinyGltf with_node(json ours, json node = json::object()) {
    TinyGltf file;
    node["extras"] = extras(std::move(ours));
    file.add_root(std::move(node));
    return file;
}

/// The complaint about a file that is refused.
std::string complaint(const TinyGltf& file) {
    try {
        static_cast<void>(load(file));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

void expect_complaint(const TinyGltf& file, const std::string& part) {
    EXPECT_NE(complaint(file).find(part), std::string::npos) << complaint(file) << " not " << part;
}

SunLight sun_of(const GltfFile& file) {
    return std::get<SunLight>(file.scene.lights.at(0));
}

TEST(SunExtras, AnAngleMakesADisc) {
    const json light = {{"type", "directional"},
                        {"intensity", 100},
                        {"extras", extras({{"angle_deg", 0.53}, {"visible", false}})}};
    const GltfFile loaded = load(lit(light));
    const double half_rad = 0.265 * double(kPi) / 180;
    EXPECT_NEAR(sun_of(loaded).versine, half_rad * half_rad / 2, 1e-9);
    EXPECT_TRUE(sun_of(loaded).unseen);
    EXPECT_EQ(sun_of(loaded).illuminance_lx[0], 100.f);
    EXPECT_TRUE(contains_line(loaded.honoured, "suns with an angle"));
    EXPECT_TRUE(loaded.warnings.empty());
    for (const json& none : {json(0), json(0.005)}) {
        json thin = light;
        thin["extras"] = extras({{"angle_deg", none}});
        EXPECT_FALSE(sun_of(load(lit(thin))).has_disc());
        EXPECT_EQ(load(lit(thin)).warnings.empty(), none == json(0));
    }
    const GltfFile point = load(lit({{"type", "point"}, {"extras", extras({{"angle_deg", 1}})}}));
    EXPECT_TRUE(contains_line(point.warnings, "only a directional light has a use for angle_deg"));
}

TEST(SunExtras, WrongOnesAreNamed) {
    const auto of = [](json ours) {
        return lit({{"type", "directional"}, {"extras", extras(std::move(ours))}});
    };
    for (const json& angle : {json(-1), json(181), json("wide")})
        expect_complaint(of({{"angle_deg", angle}}), "extras/petzval/angle_deg");
    expect_complaint(of({{"visible", 0}}), "extras/petzval/visible");
    expect_complaint(of({{"angle", 1}}), "radius_m, angle_deg, visible");
}

TEST(LampExtras, ABallMayBeUnseen) {
    const GltfFile loaded =
        load(lit({{"type", "point"}, {"extras", extras({{"radius_m", 0.1}, {"visible", false}})}}));
    EXPECT_TRUE(loaded.scene.materials.at(0).unseen);
    const GltfFile plain = load(lit({{"type", "point"}, {"extras", extras({{"radius_m", 0.1}})}}));
    EXPECT_FALSE(plain.scene.materials.at(0).unseen);
}

TEST(AreaExtras, ANodeOfItsOwnShines) {
    const GltfFile loaded = load(with_node(
        {{"area", {2, 0.5}}, {"intensity_cd", 40}, {"color", {1, 0.5, 0}}, {"visible", false}},
        {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}}));
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    const Mesh& mesh = loaded.scene.meshes[0];
    Box3f box;
    for (const V3f& p : mesh.positions) box.extendBy(p);
    EXPECT_LT((box.size() - V3f(2, 0.5f, 0)).length(), 1e-6f);  // scale does not change it
    EXPECT_LT((box.center() - V3f(1, 2, 3)).length(), 1e-6f);
    for (const auto& [a, b, c] : mesh.triangles)
        EXPECT_LT(
            (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).z,
            0);  // along -z
    const Material& material = loaded.scene.materials.at(0);
    EXPECT_FLOAT_EQ(material.emissive[0], 40);
    EXPECT_FLOAT_EQ(material.emissive[1], 20);
    EXPECT_EQ(material.emissive[2], 0.f);
    EXPECT_TRUE(material.unseen);
    EXPECT_FALSE(material.double_sided);
    EXPECT_TRUE(contains_line(loaded.contents, "0 directional, 1 with an area"));
    EXPECT_TRUE(contains_line(loaded.honoured, "nodes with an area"));
    EXPECT_TRUE(loaded.warnings.empty());
}

TEST(AreaExtras, TheLightOfTheNodeIsReplaced) {
    TinyGltf file = lit({{"type", "spot"}, {"intensity", 8}, {"spot", json::object()}},
                        {{"extras", extras({{"area", {1, 1}}, {"shape", "ellipse"}})}});
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.scene.lights.empty());
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    double area_m2 = 0;
    const Mesh& mesh = loaded.scene.meshes[0];
    for (const auto& [a, b, c] : mesh.triangles)
        area_m2 += double((mesh.positions[b] - mesh.positions[a])
                              .cross(mesh.positions[c] - mesh.positions[a])
                              .length()) /
                   2;
    EXPECT_NEAR(area_m2, double(kPi) / 4, 1e-5);
    EXPECT_NEAR(loaded.scene.materials.at(0).emissive[0] * area_m2, 8, 1e-4);
    EXPECT_TRUE(loaded.scene.materials.at(0).beam);
    // The node's own strength goes before that of its light.
    file.json["nodes"][0]["extras"]["petzval"]["intensity_cd"] = 4;
    EXPECT_NEAR(load(file).scene.materials.at(0).emissive[0] * area_m2, 4, 1e-4);
    file.json["extensions"]["KHR_lights_punctual"]["lights"][0] = {{"type", "directional"}};
    expect_complaint(file, "angle_deg");
}

TEST(AreaExtras, WrongOnesAreNamed) {
    for (const json& sides : {json(1), json{1}, json{0, 1}, json{1, -1}, json{"a", 1}})
        expect_complaint(with_node({{"area", sides}, {"intensity_cd", 1}}),
                         "/nodes/0/extras/petzval/area");
    expect_complaint(with_node({{"area", {1, 1}}}), "intensity_cd");
    expect_complaint(with_node({{"intensity_cd", 1}}), "area");
    expect_complaint(with_node({{"area", {1, 1}}, {"intensity_cd", 1}, {"shape", "disk"}}),
                     "ellipse");
    expect_complaint(with_node({{"area", {1, 1}}, {"intensity_cd", -1}}), "intensity_cd");
    expect_complaint(with_node({{"aera", {1, 1}}}), "aera");
    EXPECT_EQ(complaint(with_node(json::object())), "");
    const GltfFile tiny = load(
        with_node({{"area", {1e-5, 1}}, {"intensity_cd", 1}}, {{"translation", {1000, 0, 0}}}));
    EXPECT_TRUE(contains_line(tiny.warnings, "its area lamp is left out"));
    EXPECT_TRUE(load(with_node({{"area", {1, 1}}, {"intensity_cd", 0}})).scene.meshes.empty());
}

TEST(SceneExtras, AreThoseOfTheSceneThatIsShown) {
    TinyGltf file;
    file.json["scenes"] = json::array({json::object(), json::object()});
    file.json["scene"] = 1;
    file.json["scenes"][1]["extras"] = extras(
        {{"sky", "dusk.hdr"}, {"sky_rotation_deg", 90}, {"exposure_ev", -7}, {"view", "ACES"}});
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.extras.sky, "dusk.hdr");
    EXPECT_EQ(loaded.extras.sky_rotation_deg, 90.f);
    EXPECT_EQ(loaded.extras.exposure_ev, -7.f);
    EXPECT_EQ(loaded.extras.view, "ACES");
    EXPECT_TRUE(contains_line(loaded.contents, "sky: dusk.hdr, turned by 90 degrees"));
    file.json["scene"] = 0;
    EXPECT_FALSE(load(file).extras.sky);
    file.json["scenes"][0]["extras"] = extras({{"sky", 1}});
    expect_complaint(file, "/scenes/0/extras/petzval/sky");
    file.json["scenes"][0]["extras"] = extras({{"exposure", 1}});
    expect_complaint(file, "exposure_ev");
}

// What Blender's exporter leaves out: said of its files alone, and only where it shows.
TEST(LostByExporter, TellsWhatShows) {
    TinyGltf file = lit({{"type", "directional"}, {"name", "Sun"}});
    file.json["asset"]["generator"] = "Khronos glTF Blender I/O v3.4.50";
    file.add_root({{"name", "Area.001"}});
    file.add_root({{"name", "Empty"}});
    file.add_root({{"name", "Full"}, {"mesh", file.add_triangle()}});
    const GltfFile blender = load(file);
    EXPECT_TRUE(
        contains_line(blender.lost, "by their names, empty nodes were some: 1 \"Area.001\";"));
    EXPECT_TRUE(contains_line(blender.lost, "as it does Empties: 2 \"Empty\""));
    EXPECT_FALSE(contains_line(blender.lost, "Full"));
    EXPECT_TRUE(contains_line(blender.lost, "the angle of 1 sun"));
    EXPECT_TRUE(contains_line(blender.lost, "the world"));
    EXPECT_TRUE(contains_line(blender.lost, "Include > Cameras"));
    EXPECT_TRUE(contains_line(blender.lost, "that objects were hidden"));
    EXPECT_NE(blender.lamp_unit_doubt.find("Unitless"), std::string::npos);

    TinyGltf mended = file;
    mended.json["nodes"][1]["extras"] = extras({{"area", {1, 1}}, {"intensity_cd", 1}});
    mended.json["nodes"][2]["extras"] = extras({{"area", {1, 1}}, {"intensity_cd", 1}});
    mended.json["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"] =
        extras({{"angle_deg", 0.5}});
    mended.json["scenes"][0]["extras"] = extras({{"sky", "dusk.hdr"}});
    const GltfFile all_there = load(mended);
    for (const char* part : {"area lamps", "the angle of", "the world"})
        EXPECT_FALSE(contains_line(all_there.lost, part)) << part;

    file.json["asset"]["generator"] = "Another program";
    EXPECT_TRUE(load(file).lost.empty());
    EXPECT_TRUE(load(file).lamp_unit_doubt.empty());
}

TEST(LostByExporter, BonesAreNotAreaLamps) {
    const std::filesystem::path armature = PETZVAL_SHARED "/faults2/blender/armature.glb";
    if (!std::filesystem::exists(armature)) GTEST_SKIP() << armature << " is not here";
    EXPECT_FALSE(contains_line(load_gltf(armature).lost, "area lamps"));
    const auto lights = armature.parent_path() / "lights.glb";
    EXPECT_TRUE(contains_line(load_gltf(lights).lost, "empty nodes were some: 8 \"AREA\""));
    EXPECT_TRUE(contains_line(load_gltf(lights).lost, "the radius of 2 point or spot lamps"));
    EXPECT_TRUE(contains_line(load_gltf(lights).lost, "depth of field of 1 camera"));
}

}  // namespace
}  // namespace petzval::io
