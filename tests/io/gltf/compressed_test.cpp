// SPDX-License-Identifier: Apache-2.0
// Compressed files are read as if they had never been compressed: KHR_meshopt_compression,
// EXT_meshopt_compression and KHR_draco_mesh_compression.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/meshes/encoders.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using nlohmann::literals::operator""_json;
using test::Grid;
using Bytes = std::vector<uint8_t>;

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// A grid as a plain file. Accessors: 0 positions, 1 normals, 2 texture coordinates, 3 colours, 4
/// indices; bufferViews likewise.
TinyGltf plain(const Grid& grid) {
    TinyGltf file;
    json primitive;
    primitive["attributes"]["POSITION"] = file.add_positions(grid.positions);
    primitive["attributes"]["NORMAL"] = file.add_accessor("VEC3", grid.normals);
    primitive["attributes"]["TEXCOORD_0"] = file.add_accessor("VEC2", grid.uv);
    primitive["attributes"]["COLOR_0"] =
        file.add_accessor("VEC4", grid.colours, {{"normalized", true}});
    primitive["indices"] = file.add_accessor("SCALAR", grid.indices);
    file.add_root({{"mesh", file.add_mesh(primitive)}});
    return file;
}

/// Replaces the data of a bufferView by a stream, and its buffer by 1, which has no data.
void compress(TinyGltf& file, size_t view, const Bytes& stream, json meshopt) {
    file.bin.resize((file.bin.size() + 3) / 4 * 4);
    meshopt.update({{"buffer", 0}, {"byteOffset", file.bin.size()}, {"byteLength", stream.size()}});
    file.bin.insert(file.bin.end(), stream.begin(), stream.end());
    json& at = file.json["bufferViews"][view];
    at["buffer"] = 1;
    at["byteOffset"] = 1000 * view;
    at["extensions"][kMeshopt] = std::move(meshopt);
    file.json["buffers"] = {{{"byteLength", file.bin.size()}}, {{"byteLength", 1 << 20}}};
    file.json["buffers"][1]["extensions"][kMeshopt]["fallback"] = true;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {kMeshopt};
}

TinyGltf meshopt(const Grid& grid) {
    TinyGltf file = plain(grid);
    const size_t points = grid.points();
    file.bin.clear();
    const auto add = [&](size_t view, const auto& values, size_t stride) {
        compress(file, view, test::encode_attributes(test::bytes_of(values), stride),
                 {{"byteStride", stride}, {"count", points}, {"mode", "ATTRIBUTES"}});
    };
    add(0, grid.positions, 12);
    add(1, grid.normals, 12);
    add(2, grid.uv, 8);
    add(3, grid.colours, 4);
    compress(file, 4, test::encode_indices(grid.indices, points),
             {{"byteStride", 4}, {"count", grid.indices.size()}, {"mode", "INDICES"}});
    return file;
}

/// A grid whose vertices and indices are in a Draco stream only: bufferView 0.
TinyGltf draco(const Grid& grid, const Bytes& stream) {
    TinyGltf file = plain(grid);
    file.bin.clear();
    file.json["bufferViews"] = json::array();
    file.add_view(stream);
    for (json& accessor : file.json["accessors"]) accessor.erase("bufferView");
    file.json["meshes"][0]["primitives"][0]["extensions"][kDraco] =
        R"({"bufferView": 0, "attributes":
            {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3}})"_json;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {kDraco};
    return file;
}

Bytes sequential(const Grid& grid) {
    return test::DracoGrid(grid).encode(draco::MESH_SEQUENTIAL_ENCODING);
}

void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.uv[0], b.uv[0]);
    EXPECT_EQ(a.colours.size(), b.colours.size());
    for (size_t i = 0; i < std::min(a.colours.size(), b.colours.size()); ++i)
        for (int k = 0; k < 4; ++k) EXPECT_EQ(a.colours[i][k], b.colours[i][k]);
    EXPECT_EQ(a.triangles, b.triangles);
}

TEST(GltfMeshopt, IsReadAsIfItWereNotCompressed) {
    const Grid grid(30);
    const GltfFile file = load(meshopt(grid));
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
    EXPECT_TRUE(renders(file, kMeshopt));
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    EXPECT_EQ(file.scene.meshes[0].triangles.size(), 29u * 29u * 2u);
    expect_same(file.scene.meshes[0], load_mesh(plain(grid)));
}

/// The file with the extension under its other name.
TinyGltf as_khr(TinyGltf file) {
    std::string text = file.json.dump();
    for (size_t at; (at = text.find(kMeshopt)) != std::string::npos;)
        text.replace(at, std::string_view(kMeshopt).size(), "KHR_meshopt_compression");
    file.json = json::parse(text);
    return file;
}

TEST(GltfMeshopt, HasTwoNames) {
    const Grid grid(30);
    TinyGltf file = as_khr(meshopt(grid));
    file.json["buffers"][1]["uri"] = "absent.bin";  // a fallback under this name too
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings[0];
    EXPECT_TRUE(renders(loaded, "KHR_meshopt_compression"));
    expect_same(loaded.scene.meshes.at(0), load_mesh(plain(grid)));
    file.json["bufferViews"][0]["extensions"]["KHR_meshopt_compression"]["filter"] = "COLOR";
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }),
                    "/bufferViews/0/extensions/KHR_meshopt_compression: byteStride of"));
}

// A grid of 9 by 9 points, with the heights, normals and colours of the formulas below, as gltfpack
// 1.3 (npm) writes it with -cz: shorts, octahedral normals and YCoCg colours in streams of
// version 1.
TEST(GltfMeshopt, ReadsWhatGltfpackWrites) {
    const GltfFile file = load_gltf(PETZVAL_TEST_DATA "/gltfpack/grid_cz.glb");
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    const Mesh& mesh = file.scene.meshes[0];
    EXPECT_EQ(mesh.triangles.size(), 128u);
    ASSERT_EQ(mesh.positions.size(), 81u);
    ASSERT_EQ(mesh.colours.size(), 81u);
    std::set<std::pair<long, long>> places;
    for (size_t i = 0; i < 81; ++i) {
        const V3f p = mesh.positions[i];
        const float slope = -0.9f * std::cos(9 * p.x + 5 * p.y);
        EXPECT_NEAR(p.z, 0.1f * std::sin(9 * p.x + 5 * p.y), 5e-4f);  // 14 bits, slopes up to 1
        EXPECT_LT((unit(V3f(slope, slope * 5 / 9, 1)) - unit(mesh.normals[i])).length(), 0.03f);
        for (int k = 0; k < 4; ++k) {
            const float expected[] = {p.x, p.y, 0.5f, 1};
            EXPECT_NEAR(mesh.colours[i][k], expected[k], 1.6f / 255) << i << " " << k;
        }
        places.insert({std::lround(p.x * 8), std::lround(p.y * 8)});
    }
    EXPECT_EQ(places.size(), 81u);
}

TEST(GltfMeshopt, InterleavedViews) {
    const Grid grid(9);
    TinyGltf file = plain(grid);
    std::vector<float> both;
    for (size_t i = 0; i < grid.points(); ++i) {
        both.insert(both.end(), &grid.positions[3 * i], &grid.positions[3 * i] + 3);
        both.insert(both.end(), &grid.normals[3 * i], &grid.normals[3 * i] + 3);
    }
    compress(file, 0, test::encode_attributes(test::bytes_of(both), 24),
             {{"byteStride", 24}, {"count", grid.points()}, {"mode", "ATTRIBUTES"}});
    file.json["bufferViews"][0].update({{"byteLength", 24 * grid.points()}, {"byteStride", 24}});
    file.json["accessors"][1].update({{"bufferView", 0}, {"byteOffset", 12}});
    expect_same(load_mesh(file), load_mesh(plain(grid)));
}

TEST(GltfMeshopt, OctahedralNormals) {
    const Grid grid(9);
    TinyGltf file = plain(grid);
    std::vector<float> four;
    for (size_t i = 0; i < grid.points(); ++i) {
        four.insert(four.end(), &grid.normals[3 * i], &grid.normals[3 * i] + 3);
        four.push_back(0);
    }
    Bytes normals(4 * grid.points());
    meshopt_encodeFilterOct(normals.data(), grid.points(), 4, 8, four.data());
    compress(file, 1, test::encode_attributes(normals, 4),
             {{"byteStride", 4},
              {"count", grid.points()},
              {"mode", "ATTRIBUTES"},
              {"filter", "OCTAHEDRAL"}});
    file.json["bufferViews"][1].update({{"byteLength", normals.size()}, {"byteStride", 4}});
    file.json["accessors"][1].update({{"componentType", 5120}, {"normalized", true}});
    file.json["extensionsUsed"].push_back("KHR_mesh_quantization");
    const Mesh mesh = load_mesh(file), exact = load_mesh(plain(grid));
    ASSERT_EQ(mesh.normals.size(), exact.normals.size());
    for (size_t i = 0; i < mesh.normals.size(); ++i)
        EXPECT_LT((mesh.normals[i] - exact.normals[i]).length(), 0.02f);
}

TEST(GltfMeshopt, PlainDataGoBefore) {
    const Grid grid(5);
    TinyGltf file = plain(grid);
    const size_t size = file.bin.size();
    compress(file, 0, {1, 2, 3, 4},
             {{"byteStride", 12}, {"count", grid.points()}, {"mode", "ATTRIBUTES"}});
    json& view = file.json["bufferViews"][0];
    view["buffer"] = 0;
    view["byteOffset"] = 0;
    file.json["buffers"] = {{{"byteLength", size + 4}}};
    expect_same(load_mesh(file), load_mesh(plain(grid)));
}

TEST(GltfMeshopt, FallbacksAreNotRead) {
    const Grid grid(5);
    TinyGltf file = meshopt(grid);
    file.json["buffers"][1]["uri"] = "absent.bin";
    EXPECT_EQ(load_mesh(file).triangles.size(), 32u);
    file.json["buffers"][1]["extensions"][kMeshopt]["fallback"] = false;
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }), "/buffers/1/uri: \"absent.bin\": no such"));
}

TEST(GltfMeshopt, WhatNothingNeedsIsNotDecoded) {
    TinyGltf file = meshopt(Grid(5));
    json view = file.json["bufferViews"][0];
    view["extensions"][kMeshopt]["mode"] = "ANOTHER";
    file.json["bufferViews"].push_back(view);
    EXPECT_EQ(load_mesh(file).triangles.size(), 32u);
}

/// A change of a file at a JSON pointer, and part of the message with which it is refused.
struct Broken {
    const char* pointer;
    json value;
    const char* message;
};

void expect_refused(const TinyGltf& sound, const std::vector<Broken>& cases) {
    EXPECT_NO_THROW((void)load(sound));
    for (const Broken& broken : cases) {
        SCOPED_TRACE(std::string(broken.pointer) + " = " + broken.value.dump());
        TinyGltf file = sound;
        file.json[json::json_pointer(broken.pointer)] = broken.value;
        EXPECT_TRUE(has(refusal([&] { (void)load(file); }), broken.message));
    }
}

TEST(GltfMeshopt, RefusesWhatIsBroken) {
    const std::string at = std::string("/bufferViews/0/extensions/") + kMeshopt;
    const auto below = [&](const char* key) { return at + "/" + key; };
    const std::string mode = below("mode"), filter = below("filter"), count = below("count"),
                      stride = below("byteStride"), buffer = below("buffer"),
                      length = below("byteLength"), offset = below("byteOffset");
    expect_refused(meshopt(Grid(9)),
                   {{mode.c_str(), "VERTICES", "/mode: is \"VERTICES\", which is unknown"},
                    {mode.c_str(), "TRIANGLES", "byteStride of indices must be 2 or 4"},
                    {mode.c_str(), 3, "/mode: must be"},
                    {filter.c_str(), "COLOUR", "/filter: is \"COLOUR\", which is unknown"},
                    {filter.c_str(), "OCTAHEDRAL", "must be 4 or 8"},
                    {count.c_str(), 1'000'000, "too short for its count"},
                    {count.c_str(), uint64_t(1) << 53, "too short for its count"},
                    {count.c_str(), 80, "cannot be decoded"},
                    {count.c_str(), -1, "/count: must be"},
                    {stride.c_str(), 0, "byteStride of attributes must be"},
                    {stride.c_str(), 16, "cannot be decoded"},
                    {buffer.c_str(), 7, "/buffer: "},
                    {buffer.c_str(), 1, "do not lie in its buffer"},
                    {length.c_str(), 1'000'000, "do not lie in its buffer"},
                    {length.c_str(), 0, "has no data"},
                    {offset.c_str(), uint64_t(1) << 53, "do not lie in its buffer"},
                    {"/bufferViews/0/buffer", 9, "/bufferViews/0/buffer: "}});
}

// Indices are checked once they are decoded.
TEST(GltfMeshopt, RefusesIndicesBeyondTheVertices) {
    Grid grid(5);
    grid.indices[7] = 25;
    EXPECT_TRUE(has(refusal([&] { (void)load(meshopt(grid)); }), "beyond the 25 vertices"));
}

// 64 bytes from each: the codec's best. Twice the same stream would be 384 MiB from 3 MiB.
TEST(GltfMeshopt, RefusesToFillTheMemory) {
    constexpr size_t stride = 32, block = 256, blocks = 24 << 10, count = block * blocks;
    Bytes stream(1 + blocks * stride * 4 + 32, 0);
    stream[0] = 0xa0;
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    file.json["bufferViews"].push_back(file.json["bufferViews"][0]);
    for (size_t view : {0, 1}) {
        compress(file, view, view == 0 ? stream : Bytes(),
                 {{"byteStride", stride}, {"count", count}, {"mode", "ATTRIBUTES"}});
        file.json["bufferViews"][view]["byteLength"] = count * stride;
    }
    file.json["bufferViews"][1]["extensions"] = file.json["bufferViews"][0]["extensions"];
    file.json["accessors"].push_back(file.json["accessors"][0]);
    file.json["accessors"][1]["bufferView"] = 1;
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_NO_THROW((void)load(file));
    file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 1}}}});
    EXPECT_TRUE(has(refusal([&] { (void)load(file); }),
                    "/bufferViews/1/extensions/EXT_meshopt_compression: would be decoded to 384"));
}

TEST(GltfDraco, SequentialIsReadAsIfItWereNotCompressed) {
    const Grid grid(30);
    const GltfFile file = load(draco(grid, sequential(grid)));
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
    EXPECT_TRUE(renders(file, kDraco));
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    EXPECT_EQ(file.scene.meshes[0].triangles.size(), 29u * 29u * 2u);
    expect_same(file.scene.meshes[0], load_mesh(plain(grid)));
}

TEST(GltfDraco, EdgebreakerHasTheSameVertices) {
    const Grid grid(30);
    const Mesh exact = load_mesh(plain(grid));
    const Mesh mesh =
        load_mesh(draco(grid, test::DracoGrid(grid).encode(draco::MESH_EDGEBREAKER_ENCODING)));
    EXPECT_EQ(mesh.triangles.size(), exact.triangles.size());
    const auto vertices = [](const Mesh& of) {
        std::vector<std::array<float, 9>> all;
        for (size_t i = 0; i < of.positions.size(); ++i) {
            const V3f &p = of.positions[i], &n = of.normals[i];
            all.push_back(
                {p.x, p.y, p.z, n.x, n.y, n.z, of.uv[0][i].x, of.uv[0][i].y, of.colours[i][1]});
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    EXPECT_EQ(vertices(mesh), vertices(exact));
}

TEST(GltfDraco, AttributesBesideTheStream) {
    const Grid grid(9);
    TinyGltf file = draco(grid, sequential(grid));
    json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["extensions"][kDraco]["attributes"].erase("TEXCOORD_0");
    primitive["attributes"]["TEXCOORD_0"] = file.add_accessor("VEC2", grid.uv);
    expect_same(load_mesh(file), load_mesh(plain(grid)));
}

TEST(GltfDraco, PlainDataGoBefore) {
    const Grid grid(5);
    TinyGltf file = plain(grid);
    file.json["meshes"][0]["primitives"][0]["extensions"][kDraco] =
        R"({"bufferView": 0, "attributes": {"POSITION": 0}})"_json;
    expect_same(load_mesh(file), load_mesh(plain(grid)));
}

TEST(GltfDraco, PrimitivesMayShareAStream) {
    const Grid grid(5);
    TinyGltf file = draco(grid, sequential(grid));
    json& primitives = file.json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    const TempFolder folder;
    const GltfSource source = read_gltf_source(file.save_glb(folder.path / "a.glb"));
    EXPECT_EQ(source.buffers.size(), 1u + 5u);  // the stream, then four attributes and indices
    for (const Mesh& mesh : load(file).scene.meshes) expect_same(mesh, load_mesh(plain(grid)));
}

TEST(GltfDraco, StreamsMayShareAccessors) {
    const Grid grid(5);
    Grid shifted = grid;
    for (float& x : shifted.positions) x += 1;
    TinyGltf file = draco(grid, sequential(grid));
    json second = file.json["meshes"][0]["primitives"][0];
    second["extensions"][kDraco]["bufferView"] = file.add_view(sequential(shifted));
    file.json["meshes"][0]["primitives"].push_back(second);
    const GltfFile loaded = load(file);
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);
    expect_same(loaded.scene.meshes[0], load_mesh(plain(grid)));
    expect_same(loaded.scene.meshes[1], load_mesh(plain(shifted)));
}

TEST(GltfDraco, StripsAreStoredAsTriangles) {
    const Grid grid(5);
    TinyGltf file = draco(grid, sequential(grid));
    file.json["meshes"][0]["primitives"][0]["mode"] = 5;
    file.json["accessors"][4]["count"] = 48;
    expect_same(load_mesh(file), load_mesh(plain(grid)));
}

TEST(GltfDraco, RefusesWhatIsBroken) {
    const Grid grid(9);
    const std::string at = std::string("/meshes/0/primitives/0/extensions/") + kDraco;
    const std::string view = at + "/bufferView", attributes = at + "/attributes",
                      position = at + "/attributes/POSITION";
    TinyGltf sound = draco(grid, sequential(grid));
    sound.add_view(Bytes(20, 1));
    expect_refused(sound,
                   {{view.c_str(), 1, "KHR_draco_mesh_compression: its data are no Draco stream"},
                    {view.c_str(), 7, "/bufferView: "},
                    {attributes.c_str(), json::object(), "names no attribute"},
                    {position.c_str(), 9, "lacks the attribute 9"},
                    {position.c_str(), 2, "lacks the attribute 2 in the format of its accessor"},
                    {position.c_str(), uint64_t(1) << 32, "is no id of Draco's"},
                    {"/accessors/0/type", "MAT4", "is of a type that no vertex has"},
                    {"/accessors/0/componentType", 5124, "is of a type that no vertex has"},
                    {"/meshes/0/primitives/0/mode", 0, "goes with triangles and strips"},
                    {"/bufferViews/0/buffer", 9, "/bufferViews/0/buffer: "},
                    {"/bufferViews/0/byteLength", 60, "the file is damaged"}});
}

// Draco drops vertices that nothing names and splits others: exporters forget to count again.
TEST(GltfDraco, CountsOfAccessorsMayBeWrong) {
    const Grid grid(9);
    TinyGltf file = draco(grid, sequential(grid));
    for (const int count : {80, 1000}) {
        for (int i = 0; i < 5; ++i) file.json["accessors"][i]["count"] = count;
        const GltfFile loaded = load(file);
        EXPECT_TRUE(contains_line(loaded.warnings, "other numbers of triangles or vertices"));
        expect_same(loaded.scene.meshes.at(0), load_mesh(plain(grid)));
    }
}

// The encoder checks nothing: what it is given comes out again.
TEST(GltfDraco, RefusesIndicesBeyondTheVertices) {
    Grid grid(5);
    grid.indices[7] = 25;
    EXPECT_TRUE(
        has(refusal([&] { (void)load(draco(grid, sequential(grid))); }), "beyond the 25 vertices"));
}

// Many primitives that name one stream with other attributes each.
TEST(GltfDraco, RefusesToFillTheMemory) {
    const Grid grid(400);
    test::DracoBuilder builder(grid.points(), grid.indices);
    builder.add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, grid.positions);
    TinyGltf file = draco(grid, builder.encode(draco::MESH_SEQUENTIAL_ENCODING, 8));
    json& primitives = file.json["meshes"][0]["primitives"];
    primitives[0]["attributes"] = {{"POSITION", 0}};
    primitives[0]["extensions"][kDraco]["attributes"] = {{"POSITION", 0}};
    const json first = primitives[0], positions = file.json["accessors"][0];
    for (int i = 0; i < 70; ++i) {
        primitives.push_back(first);
        primitives.back()["attributes"]["POSITION"] = file.add("accessors", positions);
    }
    const std::string message = refusal([&] { (void)load(file); });
    EXPECT_TRUE(has(message, "would be decoded to") || has(message, "for so small a file"));
}

}  // namespace
}  // namespace petzval::io
