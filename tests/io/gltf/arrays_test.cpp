// SPDX-License-Identifier: Apache-2.0
// Accessors of every kind arrive as the numbers that they stand for.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"

namespace petzval::io {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;
const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// A triangle without indices, with one more attribute (-1: none).
TinyGltf triangle_with(const char* name, int (*add)(TinyGltf&)) {
    TinyGltf file;
    const int positions = file.add_positions(kTriangle);
    file.add_root(
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}, {name, add(file)}}}})}});
    return file;
}

template <class Index>
void expect_indices() {
    TinyGltf file;
    const int positions = file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const int indices = file.add_accessor<Index>("SCALAR", {0, 1, 2, 2, 1, 3});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}},
                                           {"indices", indices}})}});
    EXPECT_EQ(load_mesh(file).triangles, (Triangles{{0, 1, 2}, {2, 1, 3}}));
}

TEST(GltfArrays, IndicesOfEveryType) {
    expect_indices<uint8_t>();
    expect_indices<uint16_t>();
    expect_indices<uint32_t>();
}

TEST(GltfArrays, PositionsWithoutIndices) {
    TinyGltf file;
    file.add_root(
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", file.add_positions(kTriangle)}}}})}});
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uv[0].empty());
    EXPECT_TRUE(mesh.colours.empty());
}

TEST(GltfArrays, TextureCoordinatesAsFloatsAndNormalisedIntegers) {
    const std::vector<V2f> floats =
        load_mesh(triangle_with("TEXCOORD_0", [](TinyGltf& f) {
            return f.add_accessor<float>("VEC2", {-0.5f, 0.25f, 1.5f, 0, 3, -2});
        })).uv[0];
    EXPECT_EQ(floats, (std::vector<V2f>{{-0.5f, 0.25f}, {1.5f, 0}, {3, -2}}));

    const std::vector<V2f> bytes =
        load_mesh(triangle_with("TEXCOORD_0", [](TinyGltf& f) {
            const int view = f.add_view_of<uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 1, 254, 0, 0},
                                                    {{"byteStride", 4}});
            return f.add("accessors", {{"bufferView", view},
                                       {"componentType", 5121},
                                       {"normalized", true},
                                       {"type", "VEC2"},
                                       {"count", 3}});
        })).uv[0];
    EXPECT_EQ(bytes,
              (std::vector<V2f>{{0, 1}, {51 / 255.f, 102 / 255.f}, {1 / 255.f, 254 / 255.f}}));

    const std::vector<V2f> shorts =
        load_mesh(triangle_with("TEXCOORD_0", [](TinyGltf& f) {
            return f.add_accessor<uint16_t>("VEC2", {0, 65535, 1, 2, 32768, 3},
                                            {{"normalized", true}});
        })).uv[0];
    EXPECT_EQ(shorts, (std::vector<V2f>{
                          {0, 1}, {1 / 65535.f, 2 / 65535.f}, {32768 / 65535.f, 3 / 65535.f}}));
}

TEST(GltfArrays, ColoursOfThreeAndFourComponents) {
    const auto rgb =
        load_mesh(triangle_with("COLOR_0", [](TinyGltf& f) {
            return f.add_accessor<float>("VEC3", {0.1f, 0.2f, 0.3f, 1, 1, 1, 0, 0.5f, 1});
        })).colours;
    EXPECT_EQ(rgb, (std::vector<V4f>{{0.1f, 0.2f, 0.3f, 1}, {1, 1, 1, 1}, {0, 0.5f, 1, 1}}));

    const auto rgba8 =
        load_mesh(triangle_with("COLOR_0", [](TinyGltf& f) {
            return f.add_accessor<uint8_t>("VEC4", {0, 51, 102, 255, 255, 0, 0, 128, 1, 2, 3, 4},
                                           {{"normalized", true}});
        })).colours;
    EXPECT_EQ(rgba8[0], V4f(0, 51 / 255.f, 102 / 255.f, 1));
    EXPECT_EQ(rgba8[1], V4f(1, 0, 0, 128 / 255.f));

    const auto rgba16 =
        load_mesh(triangle_with("COLOR_0", [](TinyGltf& f) {
            return f.add_accessor<uint16_t>("VEC4", {0, 65535, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10},
                                            {{"normalized", true}});
        })).colours;
    EXPECT_EQ(rgba16[0], V4f(0, 1, 1 / 65535.f, 2 / 65535.f));
}

TEST(GltfArrays, QuantisedPositionsAndNormals) {
    TinyGltf file;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int positions_view = file.add_view_of<int16_t>(
        {-3, 0, 7, 0, 20000, 0, 7, 0, -3, 500, 7, 0}, {{"byteStride", 8}});
    const int positions = file.add("accessors", {{"bufferView", positions_view},
                                                 {"componentType", 5122},
                                                 {"type", "VEC3"},
                                                 {"count", 3},
                                                 {"min", {-3, 0, 7}},
                                                 {"max", {20000, 500, 7}}});
    const int normals_view =
        file.add_view_of<int8_t>({0, 0, 127, 0, -128, 0, 0, 0, 0, -127, 0, 0}, {{"byteStride", 4}});
    const int normals = file.add("accessors", {{"bufferView", normals_view},
                                               {"componentType", 5120},
                                               {"normalized", true},
                                               {"type", "VEC3"},
                                               {"count", 3}});
    file.add_root({{"mesh", file.add_mesh({{"attributes",
                                            {{"POSITION", positions}, {"NORMAL", normals}}}})}});
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{-3, 0, 7}, {20000, 0, 7}, {-3, 500, 7}}));
    EXPECT_EQ(mesh.normals, (std::vector<V3f>{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}));
}

TEST(GltfArrays, TheLeastSignedNumberIsMinusOneToo) {
    TinyGltf file = triangle_with("TEXCOORD_0", [](TinyGltf& f) {
        return f.add_accessor<int16_t>("VEC2", {-32768, -32767, 32767, 0, 1, -1},
                                       {{"normalized", true}});
    });
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(load_mesh(file).uv[0],
              (std::vector<V2f>{{-1, -1}, {1, 0}, {1 / 32767.f, -1 / 32767.f}}));
}

TEST(GltfArrays, InterleavedAttributes) {
    TinyGltf file;
    const int view = file.add_view_of<float>({0, 0, 0, 0.1f, 0.2f,  //
                                              1, 0, 0, 0.3f, 0.4f,  //
                                              0, 1, 0, 0.5f, 0.6f},
                                             {{"byteStride", 20}});
    const int positions = file.add("accessors", {{"bufferView", view},
                                                 {"componentType", 5126},
                                                 {"type", "VEC3"},
                                                 {"count", 3},
                                                 {"min", {0, 0, 0}},
                                                 {"max", {1, 1, 0}}});
    const int uv = file.add("accessors", {{"bufferView", view},
                                          {"byteOffset", 12},
                                          {"componentType", 5126},
                                          {"type", "VEC2"},
                                          {"count", 3}});
    file.add_root(
        {{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}})}});
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.positions, (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.uv[0], (std::vector<V2f>{{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}}));
}

nlohmann::json sparse(TinyGltf& file, const std::vector<uint8_t>& indices,
                      const std::vector<float>& values) {
    const int index_view = file.add_view_of(indices), value_view = file.add_view_of(values);
    return {{"count", indices.size()},
            {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
            {"values", {{"bufferView", value_view}}}};
}

TEST(GltfArrays, SparseValuesOverABufferView) {
    TinyGltf file;
    const int positions = file.add_positions(kTriangle);
    file.json["accessors"][size_t(positions)]["sparse"] = sparse(file, {1}, {5, 6, 7});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_EQ(load_mesh(file).positions, (std::vector<V3f>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}}));
}

TEST(GltfArrays, SparseValuesOverNothing) {
    TinyGltf file;
    const int positions = file.add("accessors", {{"componentType", 5126},
                                                 {"type", "VEC3"},
                                                 {"count", 3},
                                                 {"min", {0, 0, 0}},
                                                 {"max", {2, 3, 0}}});
    file.json["accessors"][size_t(positions)]["sparse"] = sparse(file, {0, 2}, {2, 0, 0, 0, 3, 0});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_EQ(load_mesh(file).positions, (std::vector<V3f>{{2, 0, 0}, {0, 0, 0}, {0, 3, 0}}));
}

TEST(GltfArrays, IndicesWithoutBufferViewAreZero) {
    TinyGltf file;
    const int positions = file.add_positions(kTriangle);
    const int indices =
        file.add("accessors", {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}},
                                           {"indices", indices}})}});
    const GltfFile loaded = load(file);  // one triangle of one vertex: nothing to see, no error
    EXPECT_TRUE(loaded.scene.meshes.empty());
    EXPECT_TRUE(contains_line(loaded.warnings, "1 triangle without area"));
}

TEST(GltfArrays, AnExternalBufferWithoutUriReadsAsZeros) {
    TinyGltf file;
    file.json["buffers"] = {{{"byteLength", 36}}};
    file.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
    const int positions = file.add("accessors", {{"bufferView", 0},
                                                 {"componentType", 5126},
                                                 {"type", "VEC3"},
                                                 {"count", 3},
                                                 {"min", {0, 0, 0}},
                                                 {"max", {0, 0, 0}}});
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
    const TempFolder folder;
    EXPECT_TRUE(load_gltf(file.save_gltf(folder.path / "t.gltf")).scene.meshes.empty());
}

// The checks and the loader read one array alike: what lies below a sparse element is not used.
TEST(GltfArrays, SparseVertexNumbersWithoutDataAreZeros) {
    TinyGltf file;
    const int positions = file.add_positions(kTriangle);
    const int indices = file.add_accessor<uint32_t>("SCALAR", {1, 2, 4'000'000'000});
    file.json["accessors"][size_t(indices)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", file.add_view_of<uint8_t>({2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", file.json["bufferViews"].size()}}}};
    file.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
    file.json["buffers"] = {{{"byteLength", file.bin.size()}}, {{"byteLength", 4}}};
    file.add_root({{"mesh", file.add_mesh({{"attributes", {{"POSITION", positions}}},
                                           {"indices", indices}})}});
    EXPECT_EQ(load_mesh(file).triangles, (Triangles{{1, 2, 0}}));
}

}  // namespace
}  // namespace petzval::io
