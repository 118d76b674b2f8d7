// SPDX-License-Identifier: Apache-2.0
// What read_gltf_source accepts, and what it hands on.
#include "io/gltf/validate/source.h"
#include "io/file/read_file.h"

#include <gtest/gtest.h>

#include "io/gltf/validate/accessor.h"
#include "io/gltf/validate/files.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using Bytes = std::vector<uint8_t>;

const Bytes png = {0x89, 'P', 'N', 'G', 1, 2, 3, 4, 5};  // not decoded here

class Source : public testing::Test {
  protected:
    GltfSource read(const TinyGltf& tiny) {
        return read_gltf_source(tiny.save_gltf(folder.path / "a.gltf"));
    }
    std::string refused(const TinyGltf& tiny) {
        return refusal([&] { (void)read(tiny); });
    }
    Bytes text_file(const char* name, const std::string& text) {
        const Bytes bytes(text.begin(), text.end());
        save_bytes(folder.path / name, bytes);
        return bytes;
    }

    TempFolder folder;
    TinyGltf file;
};

TEST_F(Source, SameContentFromTextAndBinary) {
    file.add_root({{"mesh", file.add_triangle()}});
    file.add_image(png);
    const auto text = read_gltf_source(file.save_gltf(folder.path / "a.gltf"));
    const auto binary = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    for (const GltfSource* source : {&text, &binary}) {
        ASSERT_EQ(source->buffers.size(), 1u);
        EXPECT_EQ(source->buffers[0], file.bin);
        ASSERT_EQ(source->images.size(), 1u);
        EXPECT_EQ(source->images[0], png);
        EXPECT_EQ(source->json["meshes"], file.json["meshes"]);
        EXPECT_TRUE(source->warnings.empty());
    }
    EXPECT_EQ(binary.path, folder.path / "a.glb");
}

TEST_F(Source, SaysWhatLiesInPlaceOfAScene) {
    const auto of_bytes = [&](const Bytes& bytes) {
        save_bytes(folder.path / "a.glb", bytes);
        return refusal([&] { (void)read_gltf_source(folder.path / "a.glb"); });
    };
    const std::string name = (folder.path / "a.glb").string();
    const std::string no_gltf =
        "no glTF: a .glb begins with the letters glTF, a .gltf with {; export the scene again";
    EXPECT_EQ(of_bytes({}), name + ": is empty");
    EXPECT_EQ(of_bytes({'h', 'i', '\n'}), name + ": is a text file, and " + no_gltf);
    EXPECT_EQ(of_bytes({' ', '\n'}), name + ": is a text file, and " + no_gltf);
    EXPECT_EQ(of_bytes({'P', 'K', 3, 4}), name + ": is " + no_gltf);
    EXPECT_EQ(of_bytes({0xEF, 0xBB, 0xBF, ' ', '{', 'x'}),
              name + ": line 1, column 3: is not valid JSON from here on");
}

TEST_F(Source, ReadsSideFilesBesideTheScene) {
    std::filesystem::create_directory(folder.path / "sub folder");
    const Bytes buffer = text_file("sub folder/b.bin", "12345");
    const Bytes image = text_file("p.png", "image");
    file.json["buffers"] = {{{"uri", "sub%20folder/b.bin"}, {"byteLength", 4}}};
    file.json["images"] = {{{"uri", "sub%20folder/../p.png"}}};
    const auto source = read(file);
    EXPECT_EQ(source.buffers[0], buffer);
    EXPECT_EQ(source.images[0], image);
}

TEST_F(Source, NamesAMissingSideFile) {
    file.json["images"] = {{{"uri", "absent%20.png"}}};
    EXPECT_EQ(read(file).warnings.lines(),
              std::vector<std::string>{"/images/0/uri: there is no file \"absent .png\"; the "
                                       "texture is left out"});
    file.json["buffers"] = {{{"uri", "absent%20.bin"}, {"byteLength", 1}}};
    EXPECT_EQ(refused(file), (folder.path / "a.gltf").string() +
                                 ": /buffers/0/uri: \"absent .bin\": no such file");
    file.json = {{"asset", {{"version", "2.0"}}}, {"buffers", {{{"uri", "."}, {"byteLength", 1}}}}};
    EXPECT_TRUE(has(refused(file), "/buffers/0/uri: \".\": is a folder"));
    EXPECT_TRUE(has(refusal([&] { (void)read_gltf_source(folder.path / "none.glb"); }),
                    "none.glb: no such file"));
}

// FNV-1a of "a" and of "foobar", from RFC 9923's test vectors.
TEST_F(Source, HashIsFnv1aOfAllFiles) {
    EXPECT_EQ(fnv1a({}), 0xCBF29CE484222325u);
    EXPECT_EQ(fnv1a(Bytes{'a'}), 0xAF63DC4C8601EC8Cu);
    EXPECT_EQ(fnv1a(Bytes{'f', 'o', 'o', 'b', 'a', 'r'}), 0x85944171F73967E8u);

    file.json["images"] = {{{"uri", "p.png"}}};
    text_file("p.png", "one");
    const uint64_t one = read(file).hash;
    EXPECT_EQ(read(file).hash, one);
    text_file("p.png", "two");
    EXPECT_NE(read(file).hash, one);
}

TEST_F(Source, UndefinedBufferIsEmptyAndSaysSo) {
    file.json["buffers"] = {{{"byteLength", 64}}};
    file.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 64}}};
    file.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    file.json["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}}};
    const auto source = read(file);
    EXPECT_TRUE(source.buffers[0].empty());
    EXPECT_TRUE(source.images[0].empty());
    ASSERT_EQ(source.warnings.lines().size(), 2u);
    EXPECT_EQ(source.warnings.lines()[0], "/buffers/0: has no data; reads as zeros");
}

TEST_F(Source, HasTheSameAccessorsAtEveryMoment) {
    (void)file.add_root({{"mesh", file.add_triangle()}});
    GltfSource source = read(file);
    const size_t count = file.json["accessors"].size();
    EXPECT_EQ(source.accessors.size(), count);
    pose_source(source, {});
    EXPECT_EQ(source.accessors.size(), count);
}

TEST_F(Source, BinaryChunkBelongsToTheFirstBufferOnly) {
    file.bin = {1, 2, 3, 4};
    file.json["buffers"] = {{{"byteLength", 3}}, {{"byteLength", 9}}};
    const auto source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    EXPECT_EQ(source.buffers[0], (Bytes{1, 2, 3}));
    EXPECT_TRUE(source.buffers[1].empty());
}

TEST_F(Source, OddButLegalFilesAreAccepted) {
    const auto accepts = [&](const json& more) {
        TinyGltf odd;
        odd.json.update(more);
        EXPECT_NO_THROW((void)read(odd)) << more;
    };
    accepts(json::object());
    accepts({{"asset", {{"version", "2.7"}}}});
    accepts({{"scenes", json::array()}, {"materials", json::array()}});
    accepts({{"scenes", {json::object()}}, {"unknown", 3}, {"extras", {1, 2}}});
    accepts({{"nodes", {{{"extras", nullptr}, {"scale", {0, 0, 0}}}}}});
    accepts({{"samplers", {{{"wrapS", 1}}}}, {"cameras", {{{"type", "fisheye"}}}}});
    accepts({{"textures", {json::object()}}, {"materials", {json::object()}}});
    accepts({{"materials", {{{"extras", {{"extensions", 1}}}}}}});
}

TEST_F(Source, IndicesWithoutABufferViewAreZeros) {
    const int mesh = file.add_triangle();
    file.json["accessors"][1].erase("bufferView");
    file.add_root({{"mesh", mesh}});
    EXPECT_NO_THROW((void)read(file));
}

TEST_F(Source, NamesEachExtensionThatIsIgnoredOnceWithWhatThatDoes) {
    file.json["extensionsUsed"] = {"KHR_materials_volume_scatter", "KHR_materials_ior", "X_y",
                                   "KHR_xmp_json_ld", "NV_materials_mdl"};
    const json scatter = {{"extensions", {{"KHR_materials_volume_scatter", json::object()}}}};
    file.json["materials"] = {scatter, scatter};
    const auto source = read(file);
    EXPECT_EQ(source.warnings.lines(),
              (std::vector<std::string>{
                  "/extensionsUsed: KHR_materials_volume_scatter is ignored: wax, skin and milk "
                  "are clear inside: no light scatters there",
                  "/extensionsUsed: X_y is not supported and is ignored"}));
    ASSERT_EQ(source.extensions.size(), 5u);
    EXPECT_EQ(source.extensions[0].use, ExtensionUse::Rendered);
    EXPECT_EQ(source.extensions[1].objects, 2u);
    EXPECT_EQ(source.extensions[1].use, ExtensionUse::Ignored);
    EXPECT_EQ(source.extensions[2].use, ExtensionUse::Harmless);
    EXPECT_EQ(source.extensions[3].objects, 0u);                 // declared by habit
    EXPECT_EQ(source.extensions[4].use, ExtensionUse::Ignored);  // unknown
}

TEST_F(Source, RefusesARequiredExtensionOnlyWhereThePictureWouldMeanNothing) {
    const auto require = [&](const char* name) {
        file.json["extensionsUsed"] = file.json["extensionsRequired"] = {name};
        const auto source = read(file);
        EXPECT_TRUE(source.extensions.at(0).required);
        return source.warnings.lines();
    };
    EXPECT_TRUE(require("KHR_interactivity").empty());
    EXPECT_EQ(require("NV_materials_mdl").size(), 1u);
    EXPECT_THROW(require("KHR_gaussian_splatting"), InputError);
    EXPECT_THROW(require("X_y"), InputError);
}

TEST_F(Source, SharedVerticesAreNoExtravagance) {
    const int mesh = file.add_triangle();
    auto& primitives = file.json["meshes"][size_t(mesh)]["primitives"];
    for (int i = 0; i < 200; ++i) primitives.push_back(primitives[0]);
    EXPECT_NO_THROW((void)read(file));
}

TEST(Accessor, SizesFollowTheSpecification) {
    EXPECT_EQ(element_size("SCALAR", 5121, true), 1u);
    EXPECT_EQ(element_size("VEC3", 5123, true), 6u);
    EXPECT_EQ(element_size("VEC4", 5126, true), 16u);
    // Columns start at multiples of four bytes (glTF 2.0, section 3.6.2.4).
    EXPECT_EQ(element_size("MAT2", 5121, true), 8u);
    EXPECT_EQ(element_size("MAT2", 5121, false), 6u);
    EXPECT_EQ(element_size("MAT3", 5121, true), 12u);
    EXPECT_EQ(element_size("MAT3", 5123, true), 24u);
    EXPECT_EQ(element_size("MAT3", 5123, false), 22u);
    EXPECT_EQ(element_size("MAT4", 5126, true), 64u);
}

TEST(Accessor, SparseElementsReplaceTheOthers) {
    const Bytes base = {1, 0xFF, 2, 0xFF, 3}, indices = {0, 2}, values = {8, 9};
    GltfAccessor accessor;
    accessor.component_type = 5121;
    accessor.type = "SCALAR";
    accessor.components = 1;
    accessor.count = 3;
    accessor.stride = 2;
    accessor.bytes = base;
    EXPECT_EQ(read_all<uint32_t>(accessor), (std::vector<uint32_t>{1, 2, 3}));
    accessor.sparse = GltfSparse{2, 5121, indices, values};
    EXPECT_EQ(read_all<uint32_t>(accessor), (std::vector<uint32_t>{8, 2, 9}));
    accessor.bytes = {};
    EXPECT_EQ(read_all<uint32_t>(accessor), (std::vector<uint32_t>{8, 0, 9}));
}

}  // namespace
}  // namespace petzval::io
