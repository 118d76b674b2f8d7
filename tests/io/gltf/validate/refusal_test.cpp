// SPDX-License-Identifier: Apache-2.0
// A correct file that uses everything, spoilt in one place at a time: the message names the place.
#include <gtest/gtest.h>

#include "io/gltf/validate/source.h"
#include "tests/support/full_gltf.h"

namespace petzval {
namespace {

using nlohmann::json;

struct Spoilt {
    const char* place;  ///< JSON pointer of the value to replace
    const char* value;  ///< JSON; empty to remove it
    const char* expected;
};

void expect_refused(const std::vector<Spoilt>& cases) {
    for (const Spoilt& spoilt : cases) {
        TinyGltf file = full_gltf();
        const json::json_pointer place(spoilt.place);
        if (*spoilt.value)
            file.json[place] = json::parse(spoilt.value);
        else
            file.json[place.parent_pointer()].erase(place.back());
        EXPECT_TRUE(has(refused_glb(file), std::string("a.glb: ") + spoilt.expected))
            << spoilt.place << " = " << spoilt.value;
    }
}

TEST(GltfRefusal, TheWholeFileIsFine) {
    const TempFolder folder;
    const auto path = full_gltf().save_glb(folder.path / "a.glb");
    const GltfSource source = read_gltf_source(path);
    EXPECT_TRUE(source.warnings.empty()) << source.warnings.front();
}

TEST(GltfRefusal, AssetAndExtensions) {
    expect_refused({
        {"/asset", "", "has no \"asset\""},
        {"/asset", "[]", "/asset: must be an object"},
        {"/asset/version", "\"1.0\"", "/asset/version: is 1.0"},
        {"/asset/version", "2.0", "/asset/version: must be a string"},
        {"/asset/version", "\"2\"", "/asset/version: must be a version"},
        {"/asset/version", "\"2.0x\"", "/asset/version: must be a version"},
        {"/asset/version", "\"99999999999999.0\"", "/asset/version: must be a version"},
        {"/asset/minVersion", "\"2.1\"", "/asset/minVersion: is more than the version"},
        {"/extensionsUsed", "{}", "/extensionsUsed: must be an array of strings"},
        {"/extensionsUsed/0", "1", "/extensionsUsed: must be an array of strings"},
        {"/extensionsUsed/1", "\"KHR_x\"",
         "/materials/0/extensions/KHR_materials_ior: is not decl"},
        {"/extensionsRequired", R"(["KHR_draco_mesh_compression"])",
         "/extensionsRequired: the file requires the extension KHR_draco_mesh_compression"},
        {"/extensionsRequired", R"(["KHR_materials_unlit"])",
         "/extensionsRequired: KHR_materials_unlit is not listed"},
        {"/textures/0/extensions", R"({"KHR_materials_ior": {}})",
         "/textures/0/extensions/KHR_materials_ior: stands where"},
        {"/nodes/1/extensions", "[]", "/nodes/1/extensions: must be an object"},
        {"/nodes/1/extensions", R"({"KHR_x": 1})", "/nodes/1/extensions/KHR_x: must be an object"},
        {"/materials/0/name", "1", "/materials/0/name: must be a string"},
        {"/materials", "{}", "/materials: must be an array"},
    });
}

TEST(GltfRefusal, MinimumVersionBeyondOurs) {
    TinyGltf file = full_gltf();
    file.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
    EXPECT_TRUE(has(refused_glb(file), "/asset/minVersion: is 2.1; only glTF 2.0"));
}

TEST(GltfRefusal, Buffers) {
    expect_refused({
        {"/buffers", R"([{"byteLength": 100000}])",
         "/buffers/0: byteLength is 100000, but the BIN"},
        {"/buffers", R"([{}])", "/buffers/0: has no \"byteLength\""},
        {"/buffers", R"([{"byteLength": 0}])", "/buffers/0/byteLength: must be at least 1"},
        {"/buffers", R"([{"byteLength": 4, "uri": "data:application/octet-stream;base64,AA=="}])",
         "/buffers/0: byteLength is 4, but there are 1 bytes"},
        {"/buffers", R"([{"byteLength": 1, "uri": "data:text/html;base64,AA=="}])",
         "/buffers/0/uri: holds \"text/html\""},
        {"/buffers", R"([{"byteLength": 1, "uri": "http://a/b"}])",
         "/buffers/0/uri: \"http://a/b\""},
        {"/buffers", R"([{"byteLength": 1, "uri": "/dev/zero"}])", "/buffers/0/uri: \"/dev/zero\""},
        {"/bufferViews/0/buffer", "1", "/bufferViews/0/buffer: there is no buffer 1"},
        {"/bufferViews/0/byteLength", "100000", "/bufferViews/0: ends at byte 100000"},
        {"/bufferViews/0/byteOffset", "9007199254740992", "/bufferViews/0: ends at byte"},
        {"/bufferViews/0/byteOffset", "-1", "/bufferViews/0/byteOffset: must be a whole number"},
        {"/bufferViews/0/byteLength", "0", "/bufferViews/0/byteLength: must be at least 1"},
        {"/bufferViews/0/byteStride", "6", "/bufferViews/0/byteStride: must be a multiple"},
        {"/bufferViews/0/byteStride", "256", "/bufferViews/0/byteStride: must be a multiple"},
        {"/bufferViews/0/byteStride", "40", "/bufferViews/0/byteStride: is 40, more than"},
        {"/bufferViews/0/target", "\"a\"", "/bufferViews/0/target: must be a whole number"},
    });
}

TEST(GltfRefusal, Accessors) {
    expect_refused({
        {"/accessors/0/bufferView", "99", "/accessors/0/bufferView: there is no bufferView 99"},
        {"/accessors/0/count", "4", "/accessors/0: 4 elements of 12 bytes from byte 0 do not fit"},
        {"/accessors/0/count", "9007199254740992", "/accessors/0: 9007199254740992 elements"},
        {"/accessors/0/count", "0", "/accessors/0/count: must be at least 1"},
        {"/accessors/0/byteOffset", "4", "/accessors/0: 3 elements of 12 bytes from byte 4"},
        {"/accessors/0/byteOffset", "28", "/accessors/0: 3 elements of 12 bytes from byte 28"},
        {"/accessors/0/byteOffset", "40", "/accessors/0: 3 elements of 12 bytes from byte 40"},
        {"/accessors/0/byteOffset", "2", "/accessors/0/byteOffset: its data must start"},
        {"/accessors/0/normalized", "true", "/accessors/0/normalized: only 8- and 16-bit"},
        {"/accessors/0/normalized", "1", "/accessors/0/normalized: must be true or false"},
        {"/accessors/0/min", "[0, 0]", "/accessors/0/min: must hold 3 numbers"},
        {"/accessors/0/max/1", "\"a\"", "/accessors/0/max/1: must be a number"},
        {"/accessors/0/type", "3", "/accessors/0/type: must be a string"},
        {"/accessors/0/componentType", "", "/accessors/0: has no \"componentType\""},
        {"/accessors/7/sparse/count", "5", "/accessors/7/sparse/count: must be from 1 to"},
        {"/accessors/7/sparse/count", "3", "/accessors/7/sparse/indices: 3 elements of 2 bytes"},
        {"/accessors/7/count", "3", "/accessors/7/sparse/indices: index 1 is beyond"},
        {"/accessors/7/sparse/indices/componentType", "5126", "/accessors/7/sparse/indices/compo"},
        {"/accessors/7/sparse/values/byteOffset", "4", "/accessors/7/sparse/values: 2 elements"},
        {"/accessors/7/sparse/values/bufferView", "99", "/accessors/7/sparse/values/bufferView"},
    });
}

TEST(GltfRefusal, Meshes) {
    const char* attributes = "/meshes/0/primitives/0/attributes";
    expect_refused({
        {"/meshes/0/primitives", "", "/meshes/0: has no \"primitives\""},
        {"/meshes/0/primitives/0/indices", "99", "/meshes/0/primitives/0/indices: there is no"},
        {"/meshes/0/primitives/0/indices", "0", "/meshes/0/primitives/0/indices: accessor 0 is V"},
        {"/meshes/0/primitives/0/material", "1", "/meshes/0/primitives/0/material: there is no"},
        {"/meshes/0/primitives/0/mode", "\"a\"", "/meshes/0/primitives/0/mode: must be a whole"},
        {attributes, "[]", "/meshes/0/primitives/0/attributes: must be an object"},
        {"/meshes/0/primitives/0/attributes/POSITION", "9", "/meshes/0/primitives/0/attributes/P"},
        {"/meshes/0/primitives/0/attributes/POSITION", "2",
         "/meshes/0/primitives/0/attributes/POSITION: is VEC2 of float"},
        {"/accessors/3/normalized", "true",
         "/meshes/0/primitives/0/attributes/JOINTS_0: is VEC4 of uint8n"},
        {"/accessors/0/type", "\"WHAT\"", "/meshes/0/primitives/0/attributes/POSITION: is WHAT"},
        {"/accessors/2/count", "2", "/meshes/0/primitives/0/attributes/TEXCOORD_0: accessor 2 has"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_2", "2",
         "/meshes/0/primitives/0/attributes: t"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_01", "2",
         "/meshes/0/primitives/0/attributes/T"},
        {"/meshes/0/primitives/0/attributes/NORMAL_0", "0",
         "/meshes/0/primitives/0/attributes/NOR"},
        {"/meshes/0/primitives/0/attributes/MINE", "0",
         "/meshes/0/primitives/0/attributes/MINE: i"},
        {"/meshes/0/primitives/0/targets/0/NORMAL", "0", "/meshes/0/primitives/0/targets/0/NORMAL"},
        {"/meshes/0/weights", "[1, 2]", "/meshes/0/weights: must hold 1 numbers"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_0", "",
         "/meshes/0/primitives/0: material 0 has a texture on TEXCOORD_0"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
         R"({"KHR_texture_transform": {"texCoord": 3}})",
         "/meshes/0/primitives/0: material 0 has a texture on TEXCOORD_3"},
        {"/accessors/1/normalized", "true", "/meshes/0/primitives/0/indices: accessor 1 is SCALAR"},
    });
}

TEST(GltfRefusal, Materials) {
    expect_refused({
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1",
         "/materials/0/pbrMetallicRoughness/baseColorTexture/index: there is no texture 1"},
        {"/materials/0/normalTexture", "0", "/materials/0/normalTexture: must be an object"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1]",
         "/materials/0/pbrMetallicRoughness/baseColorFactor: must hold 4"},
        {"/materials/0/pbrMetallicRoughness/roughnessFactor", "2",
         "/materials/0/pbrMetallicRoughness/roughnessFactor: must be from 0 to 1"},
        {"/materials/0/emissiveFactor", "[0, \"1\", 0]",
         "/materials/0/emissiveFactor/1: must be a"},
        {"/materials/0/alphaMode", "1", "/materials/0/alphaMode: must be a string"},
        {"/materials/0/alphaCutoff", "-1", "/materials/0/alphaCutoff: must be from 0"},
        {"/materials/0/alphaCutoff", "1e40", "/materials/0/alphaCutoff: must be from 0"},
        {"/materials/0/doubleSided", "0", "/materials/0/doubleSided: must be true or false"},
        {"/materials/0/extensions/KHR_materials_ior/ior", "0.5",
         "/materials/0/extensions/KHR_materials_ior/ior: must be 0 or at least 1"},
        {"/textures/0/source", "9", "/textures/0/source: there is no image 9"},
        {"/textures/0/sampler", "9", "/textures/0/sampler: there is no sampler 9"},
        {"/samplers/0/magFilter", "\"x\"", "/samplers/0/magFilter: must be a whole number"},
        {"/images/0", "{}", "/images/0: must have either"},
        {"/images/0/bufferView", "99", "/images/0/bufferView: there is no bufferView 99"},
        {"/images/0", R"({"uri": "data:image/png;base64,`"})",
         "/images/0/uri: is not a valid data"},
    });
}

TEST(GltfRefusal, NodesAndWhatTheyHold) {
    const char* light = "/extensions/KHR_lights_punctual/lights/0";
    expect_refused({
        {"/scene", "1", "/scene: there is no scene 1"},
        {"/scene", "\"0\"", "/scene: must be a whole number"},
        {"/scenes/0/nodes", "[3]", "/scenes/0/nodes/0: there is no node 3"},
        {"/scenes/0/nodes", "[0, 0]", "/scenes/0/nodes/1: names node 0 again"},
        {"/scenes/0/nodes", "[1]", "/scenes/0/nodes: node 1 is not a root"},
        {"/nodes/0/children", "[1, 3]", "/nodes/0/children/1: there is no node 3"},
        {"/nodes/1/children", "[2]", "/nodes/1/children: node 2 is a child of node 0 already"},
        {"/nodes/1/children", "[0]", "/nodes/0: is its own ancestor"},
        {"/nodes/0/children", "[0, 1, 2]", "/nodes/0: is its own ancestor"},
        {"/nodes/0/matrix", "[1]", "/nodes/0/matrix: must hold 16 numbers"},
        {"/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "/nodes/0: has both a matrix"},
        {"/nodes/0/rotation", "[1, 1, 1, 1]", "/nodes/0/rotation: must be a unit quaternion"},
        {"/nodes/0/scale", "[1, 1, null]", "/nodes/0/scale/2: must be a number"},
        {"/nodes/0/translation", "[1e39, 0, 0]", "/nodes/0/translation/0: must be from"},
        {"/nodes/1/mesh", "1", "/nodes/1/mesh: there is no mesh 1"},
        {"/nodes/1/mesh", "", "/nodes/1/skin: has no meaning"},
        {"/nodes/1/skin", "1", "/nodes/1/skin: there is no skin 1"},
        {"/nodes/1/weights", "[1, 2]", "/nodes/1/weights: must hold 1 numbers"},
        {"/nodes/2/camera", "2", "/nodes/2/camera: there is no camera 2"},
        {"/nodes/2/extensions/KHR_lights_punctual/light", "1",
         "/nodes/2/extensions/KHR_lights_punctual/light: there is no light 1"},
        {light, R"({"type": "spot"})", "/extensions/KHR_lights_punctual/lights/0: has no \"spot\""},
        {light, R"({"type": "point", "intensity": -1})",
         "/extensions/KHR_lights_punctual/lights/0/i"},
        {light, R"({"type": "point", "range": 0})",
         "/extensions/KHR_lights_punctual/lights/0/range"},
        {light, R"({"type": "spot", "spot": {"innerConeAngle": 1}})",
         "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle: must be less"},
        {"/cameras/0/type", "", "/cameras/0: has no \"type\""},
        {"/cameras/0/perspective/yfov", "0", "/cameras/0/perspective/yfov: must be more than 0"},
        {"/cameras/0/perspective/zfar", "1",
         "/cameras/0/perspective/zfar: must be more than znear"},
        {"/cameras/1/orthographic/xmag", "0", "/cameras/1/orthographic/xmag: must not be 0"},
        {"/skins/0/joints", "[]", "/skins/0/joints: must name at least one"},
        {"/skins/0/joints", "[7]", "/skins/0/joints/0: there is no node 7"},
        {"/skins/0/joints", "[0, 1]", "/skins/0/inverseBindMatrices: has 1 matrices for 2"},
        {"/skins/0/inverseBindMatrices", "0", "/skins/0/inverseBindMatrices: must be MAT4"},
        {"/animations/0/samplers/0/input", "99", "/animations/0/samplers/0/input: there is no"},
        {"/animations/0/channels/0/sampler", "1", "/animations/0/channels/0/sampler: there is no"},
        {"/animations/0/channels/0/target/node", "9", "/animations/0/channels/0/target/node: ther"},
    });
}

}  // namespace
}  // namespace petzval
