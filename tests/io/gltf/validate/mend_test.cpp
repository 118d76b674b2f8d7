// SPDX-License-Identifier: Apache-2.0
// A correct file that uses everything, with one slip of an exporter at a time: the file is read,
// the warning names the place, and what was put right has the value that it should have.
// docs/design/refusals.md lists these rules.
#include <gtest/gtest.h>

#include "io/base/error.h"
#include "io/gltf/validate/source.h"
#include "tests/support/full_gltf.h"

namespace petzval::io {
namespace {

using nlohmann::json;

struct Slip {
    const char* place;    ///< JSON pointer of the value to replace
    const char* value;    ///< JSON; empty to remove it
    const char* warning;  ///< part of the one warning; empty: read in silence
    const char* mended =
        nullptr;  ///< JSON at that place afterwards; "" for nothing; else as it was
};

void expect_mended(const std::vector<Slip>& slips) {
    for (const Slip& slip : slips) {
        TinyGltf file = full_gltf();
        const json::json_pointer place(slip.place);
        if (*slip.value)
            file.json[place] = json::parse(slip.value);
        else
            file.json[place.parent_pointer()].erase(place.back());
        SCOPED_TRACE(std::string(slip.place) + " = " + slip.value);
        const TempFolder folder;
        try {
            const GltfSource source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
            const auto warnings = source.warnings.lines();
            EXPECT_EQ(warnings.size(), *slip.warning ? 1u : 0u);
            if (*slip.warning && !warnings.empty()) {
                EXPECT_TRUE(has(warnings[0], slip.warning));
            }
            for (size_t i = 1; i < warnings.size(); ++i) ADD_FAILURE() << warnings[i];
            if (!slip.mended) continue;
            EXPECT_EQ(source.json.contains(place), *slip.mended != 0);
            if (*slip.mended && source.json.contains(place)) {
                EXPECT_EQ(source.json[place], json::parse(slip.mended));
            }
        } catch (const InputError& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

TEST(GltfMend, Document) {
    expect_mended({
        {"/asset/version", "2.0", "/asset/version: is 2; it is taken as \"2.0\"", "\"2.0\""},
        {"/asset/version", "\"2\"", "/asset/version: is \"2\"; it is taken", "\"2.0\""},
        {"/asset/version", "\"2.0x\"", "/asset/version: is \"2.0x\"; it is taken", "\"2.0\""},
        {"/asset/version", "\"2.7\"", ""},
        {"/asset/minVersion", "7", "/asset/minVersion: is 7, no version of glTF 2", ""},
        {"/asset/generator", "null",
         "/asset: a member \"generator\" is null; it is taken as absent", ""},
        {"/extensionsUsed/2", "\"KHR_lights_punctual\"", ""},
        {"/extensionsUsed/2", "\"X_y\"", "/extensionsUsed: X_y is not supported and is ignored"},
        {"/extensionsUsed", R"(["KHR_lights_punctual", "KHR_materials_ior"])",
         "/extensionsUsed: does not list KHR_materials_dispersion, which an object has; it is ad"},
        {"/extensionsRequired", R"(["KHR_materials_unlit"])",
         "/extensionsUsed: does not list KHR_materials_unlit, which the file requires"},
        {"/textures/0/extensions", R"({"KHR_materials_ior": {}})",
         "/textures/0/extensions/KHR_materials_ior: stands where"},
        {"/nodes/1/extensions", "[]", "/nodes/1: a member \"extensions\" is an empty list", ""},
        {"/materials/0/extensions/KHR_materials_ior", "[]",
         "an extension KHR_materials_ior is [] instead of an object", "{}"},
        {"/materials/0/pbrMetallicRoughness", "[]",
         "/materials/0: a member \"pbrMetallicRoughness\" is an empty list", ""},
        {"/nodes/0/children", "{}", "/nodes/0: a member \"children\" is an empty object", ""},
        {"/meshes/0/primitives/0/attributes/NORMAL", "-1",
         "/meshes/0/primitives/0/attributes: a member \"NORMAL\" is -1", ""},
        {"/materials/0/name", "1", "/materials/0: a member \"name\" is no text", ""},
        {"/skins/0/skeleton", "-1", "/skins/0: a member \"skeleton\" is -1; it is taken as absent",
         ""},
        {"/nodes/0/mesh", "-1", "/nodes/0: a member \"mesh\" is -1", ""},
        {"/animations/0/samplers/0/input", "99", "/animations/0: is broken in places"},
        {"/animations/0/channels/0/sampler", "1", "/animations/0: is broken"},
        {"/animations/0/channels/0/target/node", "9", "/animations/0: is broken"},
        {"/animations", "{}", "/animations: is an empty object instead of a list", ""},
    });
}

TEST(GltfMend, BuffersAndAccessors) {
    expect_mended({
        {"/buffers", R"([{"byteLength": 100000}])", "/buffers/0: byteLength is 100000, but there"},
        {"/buffers", "[{}]", "/buffers/0: has no byteLength; there are"},
        {"/bufferViews/9/byteLength", "10", "/bufferViews/9: ends at byte", "8"},
        {"/bufferViews/0/byteStride", "0", "/bufferViews/0/byteStride: is 0", ""},
        {"/bufferViews/0/byteStride", "12", ""},
        {"/bufferViews/0/target", "\"a\"", "", ""},
        {"/accessors/0/normalized", "true", "/accessors/0/normalized: goes with 8- and 16-bit", ""},
        {"/accessors/0/normalized", "0", "", "false"},
        {"/accessors/0/min", "[0, 0]", "", ""},
        {"/accessors/0/max/1", "\"a\"", ""},
        {"/accessors/6/count", "0", "/accessors/6: holds no elements; what names it", "1"},
        {"/accessors/6/bufferView", "99", "/accessors/6: is broken, but nothing needs it", ""},
        {"/accessors/6/byteOffset", "1", "/accessors/6: is broken, but nothing needs it", ""},
        {"/bufferViews/10", R"({"buffer": 7, "byteLength": 1})", "/bufferViews/10: is broken, but"},
        {"/accessors/7/sparse/count", "0", "/accessors/7/sparse: replaces no element", nullptr},
    });
}

TEST(GltfMend, Meshes) {
    const char* const texcoord = "/meshes/0/primitives/0/attributes/TEXCOORD_0";
    expect_mended({
        {"/meshes/0/primitives/0/attributes/TEXCOORD_01", "2",
         "/meshes/0/primitives/0/attributes/TEXCOORD_01: is no attribute of glTF", ""},
        {"/meshes/0/primitives/0/attributes/MINE", "0", "attributes/MINE: is no attribute", ""},
        {"/meshes/0/primitives/0/attributes/NORMAL_0", "0", "attributes/NORMAL_0: is no att", ""},
        {"/meshes/0/primitives/0/attributes/NORMAL", "4",
         "/meshes/0/primitives/0/attributes/NORMAL: has a format that it must not have", ""},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_2", "2", ""},
        {"/meshes/0/primitives/0/attributes/_MINE", "6", ""},
        {"/meshes/0/primitives/0/attributes/_MINE", "5",
         "/meshes/0/primitives/0/attributes/_MINE: has another number of elements", ""},
        {"/accessors/2/count", "2",
         "/meshes/0/primitives/0/attributes/TEXCOORD_0: has another number of elements"},
        {texcoord, "", "", nullptr},
        {"/accessors/3/normalized", "true", "/accessors/3/normalized: is ignored", ""},
        {"/accessors/1/normalized", "true", "/accessors/1/normalized: is ignored", ""},
        {"/meshes/0/primitives/0/targets/0/NORMAL", "0",
         "/meshes/0/primitives/0/targets/0/NORMAL: morphs an attribute that is not there", ""},
        {"/meshes/0/weights", "[1, 2]", "/meshes/0/weights: holds 2 numbers for 1", "[1]"},
        {"/nodes/1/weights", "[]", "/nodes/1/weights: holds 0 numbers for 1", "[0]"},
        {"/meshes/1", R"({"name": "none"})", "/meshes/1: has no primitives; it shows nothing"},
        {"/meshes/1", R"({"primitives": [{}]})", ""},
        {"/meshes/1", R"({"primitives": [{"attributes": {"POSITION": 0}, "mode": 9}]})",
         "/meshes/1/primitives/0: mode is unknown"},
    });
}

TEST(GltfMend, Materials) {
    const char* const colour = "/materials/0/pbrMetallicRoughness/baseColorFactor";
    const char* const metallic = "/materials/0/pbrMetallicRoughness/metallicFactor";
    expect_mended({
        {colour, "[1.00000012, 1, 1, 1]", "", "[1, 1, 1, 1]"},
        {colour, "[1, 1.2, -3, 1]",
         "baseColorFactor/1: is 1.2 and must be from 0 to 1; 1 is taken"
         " (and 1 more",
         nullptr},
        {colour, "[1, 0.5, 0]", "baseColorFactor: holds 3 numbers; it must hold 4",
         "[1, 0.5, 0, 1]"},
        {metallic, "1.01", "metallicFactor: is 1.01 and must be from 0 to 1; 1 is taken", "1"},
        {metallic, "-0.001", "", "0"},
        {"/materials/0/pbrMetallicRoughness/roughnessFactor", "2", "roughnessFactor: is 2", "1"},
        {"/materials/0/emissiveFactor", "[0, -1, 0]", "/emissiveFactor/1: is -1 and must not be be",
         "[0, 0, 0]"},
        {"/materials/0/emissiveFactor", "[1.001, 1, 0]", "", "[1, 1, 0]"},
        {"/materials/0/emissiveFactor", "[5, 1, 0]",
         "/emissiveFactor: is above 1; it is taken as it", "[5, 1, 0]"},
        {"/materials/0/alphaMode", "\"blend\"", "/materials/0/alphaMode: is \"blend\"; BLEND",
         "\"BLEND\""},
        {"/materials/0/alphaMode", "\"CUTOUT\"",
         "/materials/0/alphaMode: is \"CUTOUT\", which is unknown; OPAQUE is taken", "\"OPAQUE\""},
        {"/materials/0/alphaCutoff", "-1", "/materials/0/alphaCutoff: is -1", "0"},
        {"/materials/0/doubleSided", "1", "/materials/0/doubleSided: is a number", "true"},
        {"/materials/0/occlusionTexture", R"({"index": 0, "strength": 1.5})", "strength: is 1.5"},
        {"/materials/0/normalTexture", "{}", "/materials/0/normalTexture: names no texture", ""},
        {"/materials/0/normalTexture", R"({"index": -1})", "normalTexture: names no texture", ""},
        {"/materials/0/extensions/KHR_materials_ior/ior", "0.5",
         "ior: is 0.5 and must not be below "
         "1; 1 is taken",
         "1"},
        {"/materials/0/extensions/KHR_materials_ior/ior", "0", "", "0"},
        {"/materials/0/extensions/KHR_materials_dispersion/dispersion", "-1", "dispersion: is -1",
         "0"},
    });
}

TEST(GltfMend, MaterialExtensions) {
    const char* const all =
        R"({"KHR_materials_transmission": {"transmissionFactor": 1.5},
            "KHR_materials_volume": {"attenuationDistance": 0, "attenuationColor": [2, 1, 1]},
            "KHR_materials_specular": {"specularFactor": 3, "specularColorFactor": [-1, 2, 1]},
            "KHR_materials_clearcoat": {"clearcoatFactor": 2, "clearcoatRoughnessFactor": -1},
            "KHR_materials_sheen": {"sheenColorFactor": [3, 0, -1], "sheenRoughnessFactor": 4},
            "KHR_materials_anisotropy": {"anisotropyStrength": -0.5},
            "KHR_materials_iridescence": {"iridescenceFactor": 9, "iridescenceIor": 0.5,
                "iridescenceThicknessMinimum": -1, "iridescenceThicknessMaximum": -2},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 7,
                "diffuseTransmissionColorFactor": [0.5, 0.5]},
            "KHR_materials_volume_scatter": {"multiscatterColor": [0.5, 2, -1],
                "scatterAnisotropy": -1.5},
            "KHR_materials_emissive_strength": {"emissiveStrength": -2}})";
    TinyGltf file = full_gltf();
    file.json["materials"][0]["extensions"] = json::parse(all);
    const TempFolder folder;
    const GltfSource source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    EXPECT_EQ(source.json["materials"][0]["extensions"],
              json::parse(
                  R"({"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"attenuationColor": [1, 1, 1]},
            "KHR_materials_specular": {"specularFactor": 1, "specularColorFactor": [0, 2, 1]},
            "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0},
            "KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0], "sheenRoughnessFactor": 1},
            "KHR_materials_anisotropy": {"anisotropyStrength": 0},
            "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1,
                "iridescenceThicknessMinimum": 0, "iridescenceThicknessMaximum": 0},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1,
                "diffuseTransmissionColorFactor": [0.5, 0.5, 1]},
            "KHR_materials_volume_scatter": {"multiscatterColor": [0.5, 1, 0],
                "scatterAnisotropy": -1},
            "KHR_materials_emissive_strength": {"emissiveStrength": 0}})"));
    EXPECT_GE(source.warnings.lines().size(), 6u);
}

TEST(GltfMend, Textures) {
    expect_mended({
        {"/samplers/0/magFilter", "\"x\"", "/samplers/0/magFilter: is \"x\", which is unknown", ""},
        {"/samplers/0/wrapS", "1", "/samplers/0/wrapS: is 1, which is unknown; REPEAT is taken",
         ""},
        {"/images/0/mimeType", "\"image/jpeg\"", ""},
        {"/images/0/mimeType", "7", "/images/0/mimeType: is no text", ""},
        {"/images/0/mimeType", "", ""},
        {"/images/0/uri", "\"a.png\"", "/images/0/uri: stands beside a bufferView", ""},
        {"/images/0", R"({"name": "none"})", "/images/0: has neither a uri nor a bufferView"},
        {"/images/0", R"({"uri": "absent.png"})",
         "/images/0/uri: there is no file \"absent.png\"; the texture is left out"},
        {"/images/0", R"({"uri": "C:\\wood.png"})",
         "/images/0/uri: \"C:\\wood.png\" is not a relative path to a file; the texture is left"},
        {"/images/1", R"({"uri": 7})", "/images/1: is broken, but nothing needs it"},
        {"/textures/0", "{}", ""},
    });
}

TEST(GltfMend, CamerasAndLights) {
    const char* const light = "/extensions/KHR_lights_punctual/lights/0";
    expect_mended({
        {"/cameras/0/type", "", "/cameras/0: has no type; what it holds tells", "\"perspective\""},
        {"/cameras/0/perspective/yfov", "0", "/cameras/0: has a yfov of 0; it is left out"},
        {"/cameras/0/perspective/yfov", "-1", "/cameras/0: has a yfov of -1; it is left out"},
        {"/cameras/0/perspective/yfov", "", "/cameras/0: has no yfov; it is left out"},
        {"/cameras/0/perspective/znear", "0", "/cameras/0/perspective: has clipping planes"},
        {"/cameras/0/perspective/znear", "", ""},
        {"/cameras/0/perspective/zfar", "0.5", "/cameras/0/perspective: has clipping planes", ""},
        {"/cameras/0/perspective/aspectRatio", "0", "aspectRatio: is 0; it is taken as absent", ""},
        {"/cameras/0/perspective", "", "/cameras/0: has no perspective; it is left out"},
        {"/cameras/1/orthographic/xmag", "0", "/cameras/1: has an xmag of 0; it is left out"},
        {"/cameras/1/orthographic/zfar", "0", "/cameras/1/orthographic: has clipping planes"},
        {"/cameras/0", R"({"type": "fisheye"})", "/cameras/0: is of the unknown type \"fisheye\""},
        {light, R"({"type": "spot"})", "lights/0: has no spot; a cone of the default"},
        {light, R"({"type": "point", "intensity": -1})", "lights/0/intensity: is -1"},
        {light, R"({"type": "point", "color": [2, -1, 1]})", "lights/0/color/1: is -1"},
        {light, R"({"type": "point", "range": 0})", "", nullptr},
        {light, R"({"type": "spot", "spot": {"innerConeAngle": 1}})", "innerConeAngle: is 1 and"},
        {light, R"({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}})", ""},
        {light, R"({"type": "spot", "spot": {"outerConeAngle": 2}})", "outerConeAngle: is 2 and"},
        {light, R"({"type": "spot", "spot": {"outerConeAngle": 0}})", "lights/0: has an outerCone"},
        {light, R"({"color": [1, 1, 1]})", "lights/0: has no type; it is left out"},
        {light, R"({"type": "area"})", "lights/0: is of the unknown type \"area\""},
    });
}

TEST(GltfMend, Nodes) {
    expect_mended({
        {"/nodes/0/rotation", "[0, 0, 0, 1.005]", ""},
        {"/nodes/0/rotation", "[1, 1, 1, 1]",
         "/nodes/0/rotation: is a quaternion of length 2; it is scaled to 1"},
        {"/nodes/0/rotation", "[0, 0, 0, 0]", "/nodes/0/rotation: is a quaternion of length 0", ""},
        {"/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]", ""},
        {"/nodes/0", R"({"children": [1, 2], "scale": [2, 1, 1],
                         "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]})",
         "/nodes/0: has a matrix and translation, rotation or scale; the matrix is taken"},
        {"/nodes/0", R"({"children": [1, 2], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,0.9]})",
         "/nodes/0/matrix: has a last row other than"},
        {"/nodes/0/children", "[1, 2, 2]", "/nodes/0/children: names a node twice", "[1, 2]"},
        {"/nodes/0/children", "[1, -1, 2, -1]", "/nodes/0/children: names node -1", "[1, 2]"},
        {"/scenes/0/nodes", "[-1, 0]", "/scenes/0/nodes: names node -1, which is none", "[0]"},
        {"/nodes/2/extensions/KHR_lights_punctual/light", "-1",
         "/nodes/2/extensions/KHR_lights_punctual/light: is -1; the node is taken", ""},
        {"/scenes/0/nodes", "[0, 0]", "/scenes/0/nodes: names a node twice", "[0]"},
        {"/scenes/0/nodes", "[0, 1]", "/scenes/0/nodes: node 1 is not a root, but a child of"},
        {"/nodes/2/weights", "[1]", "/nodes/2/weights: has no meaning on a node without a mesh",
         ""},
        {"/nodes/2/skin", "0", "/nodes/2/skin: has no meaning on a node without a mesh", ""},
    });
}

TEST(GltfMend, ManySlipsOfOneKindAreOneWarning) {
    TinyGltf file;
    for (int i = 0; i < 5000; ++i)
        file.add("materials", {{"name", std::to_string(i)}, {"alphaMode", "CUTOUT"}});
    const TempFolder folder;
    const auto warnings = read_gltf_source(file.save_gltf(folder.path / "a.gltf")).warnings.lines();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0],
              "/materials/0/alphaMode: is \"CUTOUT\", which is unknown; OPAQUE is "
              "taken (and 4999 more like it)");
}

TEST(GltfMend, EmptyMeshesAndWrongCounts) {
    TinyGltf file;
    const int empty =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 0}});
    file.add_mesh({{"attributes", {{"POSITION", empty}}}, {"indices", empty}});
    const TempFolder folder;
    const auto source = read_gltf_source(file.save_gltf(folder.path / "a.gltf"));
    EXPECT_TRUE(source.json["meshes"][0]["primitives"][0]["attributes"].empty());
    const auto warnings = source.warnings.lines();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], "/accessors/0: holds no elements; what names it shows nothing");
}

TEST(GltfMend, FormatsThatAreNotDeclared) {
    TinyGltf file;
    const int positions = file.add_accessor<int16_t>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int colours = file.add_accessor<uint8_t>("VEC4", std::vector<uint8_t>(12, 255));
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", colours}}}});
    const TempFolder folder;
    const auto source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    const auto warnings = source.warnings.lines();
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_TRUE(has(warnings[0], "/accessors/1/normalized: must be true for COLOR"));
    EXPECT_TRUE(has(warnings[1], "/extensionsUsed: does not list KHR_mesh_quantization"));
    EXPECT_EQ(source.json["accessors"][1]["normalized"], true);
}

// Bytes that lie in odd places are read where they are: alignment is for graphics cards.
TEST(GltfMend, DataInOddPlaces) {
    TinyGltf file;
    const int view = file.add_view(std::vector<uint8_t>(77, 0), {{"byteStride", 13}});
    const auto vectors = [&](int offset) {
        return file.add("accessors", {{"bufferView", view},
                                      {"byteOffset", offset},
                                      {"componentType", 5126},
                                      {"type", "VEC3"},
                                      {"count", 3}});
    };
    file.add_mesh({{"attributes", {{"POSITION", vectors(1)}, {"NORMAL", vectors(27)}}}});
    file.add_root({{"mesh", 0}});
    const TempFolder folder;
    const auto source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    EXPECT_TRUE(source.warnings.empty());
}

}  // namespace
}  // namespace petzval::io
