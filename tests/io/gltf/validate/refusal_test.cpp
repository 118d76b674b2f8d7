// SPDX-License-Identifier: Apache-2.0
// A correct file that uses everything, spoilt in one place at a time: the message names the place.
#include <gtest/gtest.h>

#include "io/gltf/validate/source.h"
#include "tests/support/full_gltf.h"

namespace petzval::io {
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
    EXPECT_EQ(source.warnings.lines(), std::vector<std::string>());
}

TEST(GltfRefusal, AssetAndExtensions) {
    expect_refused({
        {"/asset", "", "has no \"asset\""},
        {"/asset", "[]", "/asset: must be an object"},
        {"/asset/version", "\"1.0\"", "/asset/version: is 1.0"},
        {"/asset/version", "\"99999999999999.0\"", "/asset/version: must be a version"},
        {"/asset/minVersion", "\"2.1\"", "/asset/minVersion: is more than the version"},
        {"/extensionsUsed/0", "1", "/extensionsUsed: must be an array of strings"},
        {"/extensionsRequired", R"(["KHR_gaussian_splatting"])",
         "/extensionsRequired: the file requires the extension KHR_gaussian_splatting"},
        {"/nodes/1/extensions", R"({"KHR_x": 1})", "/nodes/1/extensions/KHR_x: must be an object"},
        {"/materials", R"({"a": 1})", "/materials: must be an array"},
    });
}

TEST(GltfRefusal, MinimumVersionBeyondOurs) {
    TinyGltf file = full_gltf();
    file.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
    EXPECT_TRUE(has(refused_glb(file), "/asset/minVersion: is 2.1; only glTF 2.0"));
}

TEST(GltfRefusal, Buffers) {
    expect_refused({
        {"/buffers", R"([{"byteLength": 0}])", "/accessors/0: 3 elements of 12 bytes"},
        {"/buffers", R"([{"byteLength": 4, "uri": "data:application/octet-stream;base64,AA=="}])",
         "/accessors/0: 3 elements of 12 bytes"},
        {"/buffers", R"([{"byteLength": 1, "uri": "http://a/b"}])",
         "/buffers/0/uri: \"http://a/b\""},
        {"/buffers", R"([{"byteLength": 1, "uri": "/dev/zero"}])", "/buffers/0/uri: \"/dev/zero\""},
        {"/bufferViews/0/buffer", "1", "/bufferViews/0/buffer: there is no buffer 1"},
        {"/bufferViews/0/byteOffset", "9007199254740992", "/accessors/0: 3 elements"},
        {"/bufferViews/0/byteOffset", "-1", "/bufferViews/0/byteOffset: must be a whole number"},
        {"/bufferViews/0/byteLength", "0", "/accessors/0: 3 elements"},
        {"/bufferViews/0/byteStride", "6", "/accessors/0: an element takes 12 bytes, but"},
        {"/bufferViews/0/byteStride", "256", "/accessors/0: 3 elements of 256 bytes"},
    });
}

TEST(GltfRefusal, Accessors) {
    expect_refused({
        {"/accessors/0/bufferView", "99", "/accessors/0/bufferView: there is no bufferView 99"},
        {"/accessors/1/count", "9", "/accessors/1: 9 elements of 2 bytes from byte 0 do not fit"},
        {"/accessors/1/count", "9007199254740992", "/accessors/1: 9007199254740992 elements"},
        {"/accessors/4/count", "0", "/accessors/4/count: must be at least 1"},
        {"/accessors/0/byteOffset", "4", "/accessors/0: 3 elements of 12 bytes from byte 4"},
        {"/accessors/0/byteOffset", "28", "/accessors/0: 3 elements of 12 bytes from byte 28"},
        {"/accessors/0/byteOffset", "40", "/accessors/0: 3 elements of 12 bytes from byte 40"},
        {"/accessors/0/byteOffset", "2", "/accessors/0: 3 elements of 12 bytes from byte 2"},
        {"/accessors/0/type", "3", "/accessors/0/type: must be a string"},
        {"/accessors/0/componentType", "", "/accessors/0: has no \"componentType\""},
        {"/accessors/7/sparse/count", "5", "/accessors/7/sparse/count: must be from 1 to"},
        {"/accessors/7/sparse/count", "3", "/accessors/7/sparse/indices: 3 elements of 2 bytes"},
        {"/accessors/7/sparse/indices/componentType", "5126", "/accessors/7/sparse/indices/compo"},
        {"/accessors/7/sparse/values/byteOffset", "4", "/accessors/7/sparse/values: 2 elements"},
        {"/accessors/7/sparse/values/bufferView", "99", "/accessors/7/sparse/values/bufferView"},
    });
}

TEST(GltfRefusal, Meshes) {
    const char* attributes = "/meshes/0/primitives/0/attributes";
    expect_refused({
        {"/meshes/0/primitives/0/indices", "99", "/meshes/0/primitives/0/indices: there is no"},
        {"/meshes/0/primitives/0/indices", "0", "/meshes/0/primitives/0/indices: accessor 0 is V"},
        {"/meshes/0/primitives/0/material", "1", "/meshes/0/primitives/0/material: there is no"},
        {"/meshes/0/primitives/0/mode", "\"a\"", "/meshes/0/primitives/0/mode: must be a whole"},
        {attributes, "[1]", "/meshes/0/primitives/0/attributes: must be an object"},
        {"/meshes/0/primitives/0/attributes/POSITION", "9", "/meshes/0/primitives/0/attributes/P"},
        {"/meshes/0/primitives/0/attributes/POSITION", "2",
         "/meshes/0/primitives/0/attributes/POSITION: is VEC2 of float"},
        {"/accessors/0/type", "\"WHAT\"", "/meshes/0/primitives/0/attributes/POSITION: is WHAT"},
    });
}

TEST(GltfRefusal, Materials) {
    expect_refused({
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1",
         "/materials/0/pbrMetallicRoughness/baseColorTexture/index: there is no texture 1"},
        {"/materials/0/normalTexture", "0", "/materials/0/normalTexture: must be an object"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1]",
         "/materials/0/pbrMetallicRoughness/baseColorFactor: must hold 4"},
        {"/materials/0/emissiveFactor", "[0, \"1\", 0]",
         "/materials/0/emissiveFactor/1: must be a"},
        {"/materials/0/alphaMode", "1", "/materials/0/alphaMode: must be a string"},
        {"/textures/0/source", "9", "/textures/0/source: there is no image 9"},
        {"/textures/0/sampler", "9", "/textures/0/sampler: there is no sampler 9"},
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
        {"/nodes/0/children", "[1, 3]", "/nodes/0/children/1: there is no node 3"},
        {"/nodes/1/children", "[2]", "/nodes/1/children: node 2 is a child of node 0 already"},
        {"/nodes/1/children", "[0]", "/nodes/0: is its own ancestor"},
        {"/nodes/0/children", "[0, 1, 2]", "/nodes/0: is its own ancestor"},
        {"/nodes/0/matrix", "[1]", "/nodes/0/matrix: must hold 16 numbers"},
        {"/nodes/0/scale", "[1, 1, null]", "/nodes/0/scale/2: must be a number"},
        {"/nodes/0/translation", "[1e39, 0, 0]", "/nodes/0/translation/0: must be from"},
        {"/nodes/1/mesh", "1", "/nodes/1/mesh: there is no mesh 1"},
        {"/nodes/1/skin", "1", "/nodes/1/skin: there is no skin 1"},
        {"/nodes/2/camera", "2", "/nodes/2/camera: there is no camera 2"},
        {"/nodes/2/extensions/KHR_lights_punctual/light", "1",
         "/nodes/2/extensions/KHR_lights_punctual/light: there is no light 1"},
        {light, R"({"type": "point", "color": [1]})",
         "/extensions/KHR_lights_punctual/lights/0/color: must hold 3 numbers"},
        {light, R"({"type": 1})",
         "/extensions/KHR_lights_punctual/lights/0/type: must be a string"},
        {"/skins/0/joints", "[]", "/skins/0/joints: must name at least one"},
        {"/skins/0/joints", "[7]", "/skins/0/joints/0: there is no node 7"},
        {"/skins/0/joints", "[0, 1]", "/skins/0/inverseBindMatrices: has 1 matrices for 2"},
        {"/skins/0/inverseBindMatrices", "0", "/skins/0/inverseBindMatrices: must be MAT4"},
    });
}

}  // namespace
}  // namespace petzval::io
