// SPDX-License-Identifier: Apache-2.0
// What only shows when several parts of a file, or the bytes behind it, are looked at together.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/full_gltf.h"

namespace petzval::io {
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

TEST(GltfLimits, IndicesBeyondTheVertices) {
    for (const auto& [index, expected] : {std::pair<uint16_t, const char*>{3, "beyond the 3 vert"},
                                          {0xFFFF, "restarts the primitive"}}) {
        TinyGltf file;
        const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
        const int indices = file.add_accessor<uint16_t>("SCALAR", {0, index, 2});
        file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
        EXPECT_TRUE(has(refused_glb(file), expected));
        EXPECT_TRUE(
            has(refused_glb(file), "/meshes/0/primitives/0/indices: index 1 of accessor 1"));
    }
}

TEST(GltfLimits, JointsBeyondTheSkin) {
    TinyGltf file = full_gltf();
    const size_t at = file.json["bufferViews"][3]["byteOffset"];
    file.bin[at + 5] = 1;
    EXPECT_TRUE(
        has(refused_glb(file), "/nodes/1/skin: mesh 0 names a joint beyond the 1 of skin 0"));
    // Exporters leave rubbish where the weight is 0.
    const size_t weights = file.json["bufferViews"][4]["byteOffset"];
    std::fill_n(file.bin.begin() + ptrdiff_t(weights + 5 * sizeof(float)), sizeof(float), 0);
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
    const TempFolder folder;
    TinyGltf webp = full_gltf();
    webp.json["extensionsUsed"].push_back("EXT_texture_webp");
    webp.json["textures"][0] = R"({"extensions": {"EXT_texture_webp": {"source": 0}}})"_json;
    const GltfSource read = read_gltf_source(webp.save_glb(folder.path / "webp.glb"));
    EXPECT_EQ(read.json["textures"][0]["source"], 0);
    EXPECT_TRUE(read.warnings.empty());
    TinyGltf basis = full_gltf();
    basis.json["extensionsUsed"].push_back("KHR_texture_basisu");
    basis.json["textures"][0]["extensions"] = R"({"KHR_texture_basisu": {"source": 0}})"_json;
    const auto& warnings = read_gltf_source(basis.save_glb(folder.path / "basis.glb")).warnings;
    ASSERT_EQ(warnings.lines().size(), 1u);
    EXPECT_TRUE(
        has(warnings.lines()[0], "KHR_texture_basisu is ignored: textures show the images"));
    basis.json["textures"][0].erase("source");
    EXPECT_TRUE(has(refused_glb(basis),
                    "/textures/0: its image is only in KHR_texture_basisu, which is not supported; "
                    "convert its KTX2 images to PNG with the script in docs/guide/textures.md"));
    basis.json["extensionsRequired"] = {"KHR_texture_basisu"};
    EXPECT_TRUE(has(refused_glb(basis),
                    "/extensionsRequired: the file requires the extension "
                    "KHR_texture_basisu, which is not supported; convert"));
    TinyGltf avif = full_gltf();
    avif.json["extensionsUsed"].push_back("EXT_texture_avif");
    avif.json["textures"][0] = R"({"extensions": {"EXT_texture_avif": {"source": 0}}})"_json;
    EXPECT_TRUE(has(refused_glb(avif),
                    "/textures/0: its image is only in EXT_texture_avif, which is not supported; "
                    "convert its AVIF images to PNG: npx @gltf-transform/cli png IN OUT --formats "
                    "avif"));
    TinyGltf dds = full_gltf();
    dds.json["extensionsUsed"].push_back("MSFT_texture_dds");
    dds.json["textures"][0] = R"({"extensions": {"MSFT_texture_dds": {"source": 0}}})"_json;
    EXPECT_TRUE(has(refused_glb(dds), "which is not supported; export it with PNG, JPEG or Web"));
}

TEST(GltfLimits, SmallFilesThatAskForGigabytes) {
    TinyGltf zeros;
    zeros.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1'000'000'000}});
    zeros.add_mesh({{"attributes", {{"POSITION", 0}}}});
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
    undefined.add_mesh({{"attributes", {{"_MINE", 0}}}});
    EXPECT_TRUE(has(refused_glb(undefined), "/accessors/0: asks for 1048576 MiB"));

    TinyGltf shared;
    const int positions = shared.add_positions(std::vector<float>(300'000, 0.f));
    for (int i = 0; i < 1000; ++i) shared.add_mesh({{"attributes", {{"POSITION", positions}}}});
    EXPECT_TRUE(has(refused_glb(shared), "/primitives/0: asks for "));

    TinyGltf images;
    const int view = images.add_view(std::vector<uint8_t>(1'000'000, 1));
    for (int i = 0; i < 1000; ++i) {
        images.add("images", {{"bufferView", view}});
        images.add("textures", {{"source", i}});
    }
    EXPECT_TRUE(has(refused_glb(images), ": asks for "));
}

}  // namespace
}  // namespace petzval::io
