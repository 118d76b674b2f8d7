// SPDX-License-Identifier: Apache-2.0
// What only shows when several parts of a file, or the bytes behind it, are looked at together.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/full_gltf.h"

namespace petzval {
namespace {

using nlohmann::json;
using nlohmann::literals::operator""_json;

TEST(GltfLimits, NodeTreeDeeperThanAnyRig) {
    const auto chain = [](int length) {
        TinyGltf file;
        for (int i = 0; i + 1 < length; ++i) file.add("nodes", {{"children", {i + 1}}});
        file.add("nodes", json::object());
        return file;
    };
    const TempFolder folder;
    EXPECT_NO_THROW((void)read_gltf_source(chain(1024).save_gltf(folder.path / "a.gltf")));
    EXPECT_TRUE(has(refused_glb(chain(1025)), "/nodes/1024: lies more than 1024 nodes deep"));
}

TEST(GltfLimits, AnAttributeOf32BitIntegers) {
    TinyGltf file;
    const int mine = file.add_accessor<uint32_t>("SCALAR", {1, 2, 3});
    file.add_mesh({{"attributes", {{"_MINE", mine}}}});
    EXPECT_TRUE(has(refused_glb(file), "/attributes/_MINE: is SCALAR of uint32"));
}

TEST(GltfLimits, IndicesBeyondTheVertices) {
    for (const auto& [index, expected] : {std::pair<uint16_t, const char*>{3, "beyond the 3 vert"},
                                          {0xFFFF, "would restart the primitive"}}) {
        TinyGltf file;
        const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
        const int indices = file.add_accessor<uint16_t>("SCALAR", {0, index, 2});
        file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
        EXPECT_TRUE(has(refused_glb(file), expected));
        EXPECT_TRUE(
            has(refused_glb(file), "/meshes/0/primitives/0/indices: index 1 of accessor 1"));
    }
}

TEST(GltfLimits, ValuesThatAreNotFinite) {
    for (const float bad : {NAN, INFINITY, -INFINITY}) {
        TinyGltf file;
        file.add_accessor<float>("VEC3", {0, 0, 0, 1, bad, 0});
        EXPECT_TRUE(has(refused_glb(file), "/accessors/0: element 1 is "));
    }
}

TEST(GltfLimits, JointsBeyondTheSkin) {
    TinyGltf file = full_gltf();
    const size_t at = file.json["bufferViews"][3]["byteOffset"];
    file.bin[at + 5] = 1;
    EXPECT_TRUE(
        has(refused_glb(file), "/nodes/1/skin: mesh 0 names a joint beyond the 1 of skin 0"));
}

TEST(GltfLimits, QuantizedPositionsWithoutTheExtension) {
    TinyGltf file;
    const int positions = file.add_accessor<int16_t>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0});
    file.json["bufferViews"][0]["byteStride"] = 8;
    file.json["accessors"][0]["count"] = 3;
    file.add_mesh({{"attributes", {{"POSITION", positions}}}});
    EXPECT_TRUE(has(refused_glb(file), "POSITION: is VEC3 of int16"));
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const TempFolder folder;
    EXPECT_NO_THROW((void)read_gltf_source(file.save_glb(folder.path / "a.glb")));
}

TEST(GltfLimits, StridedIndices) {
    TinyGltf file = full_gltf();
    file.json["accessors"][1]["count"] = 1;
    file.json["bufferViews"][1]["byteStride"] = 4;
    EXPECT_TRUE(
        has(refused_glb(file), "/meshes/0/primitives/0/indices: their bufferView must not"));
}

TEST(GltfLimits, DataThatOnlyAnUnsupportedExtensionHas) {
    TinyGltf draco = full_gltf();
    draco.json["extensionsUsed"].push_back("KHR_draco_mesh_compression");
    draco.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] =
        json::object();
    const TempFolder folder;
    EXPECT_NO_THROW((void)read_gltf_source(draco.save_glb(folder.path / "a.glb")));
    draco.json["accessors"][0].erase("bufferView");
    EXPECT_TRUE(
        has(refused_glb(draco), "/meshes/0/primitives/0: its vertices are only in KHR_draco"));

    TinyGltf meshopt;
    meshopt.bin = {1};
    meshopt.json["extensionsUsed"] = {"EXT_meshopt_compression"};
    meshopt.json["buffers"] = R"([{"byteLength": 1}, {"byteLength": 9}])"_json;
    meshopt.json["bufferViews"] = R"([{"buffer": 1, "byteLength": 9,
                                       "extensions": {"EXT_meshopt_compression": {}}}])"_json;
    EXPECT_TRUE(has(refused_glb(meshopt), "/bufferViews/0: its data is only in EXT_meshopt"));

    TinyGltf webp = full_gltf();
    webp.json["extensionsUsed"].push_back("EXT_texture_webp");
    webp.json["textures"][0] = R"({"extensions": {"EXT_texture_webp": {"source": 0}}})"_json;
    EXPECT_TRUE(has(refused_glb(webp), "/textures/0: its image is only in EXT_texture_webp"));
}

TEST(GltfLimits, AttributesThatDoNotLieInOrder) {
    TinyGltf file;
    const int bytes = file.add_view(std::vector<uint8_t>(64, 0));
    const auto floats = [&](int offset) {
        return file.add("accessors", {{"bufferView", bytes},
                                      {"byteOffset", offset},
                                      {"componentType", 5126},
                                      {"type", "VEC3"},
                                      {"count", 2}});
    };
    const int first = floats(0), second = floats(24);
    file.add_mesh({{"attributes", {{"POSITION", first}, {"NORMAL", second}}}});
    EXPECT_TRUE(has(refused_glb(file), "share bufferView 0, so it must have a byteStride"));
    file.json["accessors"][0]["componentType"] = 5123;
    file.json["accessors"][0]["byteOffset"] = 2;
    file.json["meshes"][0]["primitives"][0]["attributes"] = {{"_MINE", 0}};
    EXPECT_TRUE(has(refused_glb(file), "_MINE: accessor 0 has an attribute that is not aligned"));
}

TEST(GltfLimits, SmallFilesThatAskForGigabytes) {
    TinyGltf zeros;
    zeros.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1'000'000'000}});
    EXPECT_TRUE(has(refused_glb(zeros), "/accessors/0: asks for 11444 MiB"));
    zeros.json["accessors"][0]["count"] = uint64_t(1) << 53;
    EXPECT_TRUE(has(refused_glb(zeros), "/accessors/0: asks for "));

    TinyGltf undefined;  // the first buffer of a text file may be left undefined
    undefined.bin = {1};
    undefined.json["buffers"] = {{{"byteLength", 1}}, {{"byteLength", uint64_t(1) << 40}}};
    undefined.json["bufferViews"] = {{{"buffer", 1}, {"byteLength", uint64_t(1) << 40}}};
    undefined.add("accessors", {{"bufferView", 0},
                                {"componentType", 5126},
                                {"type", "SCALAR"},
                                {"count", uint64_t(1) << 38}});
    EXPECT_TRUE(has(refused_glb(undefined), "/accessors/0: asks for 1048576 MiB"));

    TinyGltf shared;
    const int positions = shared.add_positions(std::vector<float>(300'000, 0.f));
    for (int i = 0; i < 1000; ++i) shared.add_mesh({{"attributes", {{"POSITION", positions}}}});
    EXPECT_TRUE(has(refused_glb(shared), "/primitives/0: asks for "));

    TinyGltf images;
    const int view = images.add_view(std::vector<uint8_t>(1'000'000, 1));
    for (int i = 0; i < 1000; ++i) images.add("images", {{"bufferView", view}});
    EXPECT_TRUE(has(refused_glb(images), ": asks for "));
}

}  // namespace
}  // namespace petzval
