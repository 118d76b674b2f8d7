// SPDX-License-Identifier: Apache-2.0
// Tangents for normal maps: direction, sign, seams, and agreement with those of a real file.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/gltf/meshes/bake.h"
#include "io/gltf/meshes/tangents.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/tiny_png.h"

namespace petzval::io {
namespace {

/// A mesh with tangents, its vertices split where that needs it.
Mesh with_tangents(const Mesh& mesh) {
    SourceMesh source(mesh);
    split_for_tangents(source, {});
    add_tangents(source.mesh, {});
    return source.mesh;
}

void expect_near_vector(const V4f& a, const V4f& b) {
    EXPECT_LT((a - b).length(), 1e-6f) << a << " is not " << b;
}

/// The unit square in the plane z = 0, seen from +z, with the texture upright on it: u to
/// the right, v down.
Mesh textured_square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, V3f(0, 0, 1));
    mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TEST(GltfTangents, UprightTexture) {
    Mesh mesh = textured_square();
    add_tangents(mesh, {});
    ASSERT_EQ(mesh.tangents.size(), 4u);
    // bitangent = w * cross(normal, tangent) = +y: where green points, against v.
    for (const V4f& tangent : mesh.tangents) expect_near_vector(tangent, {1, 0, 0, 1});
}

TEST(GltfTangents, TurnedAndMirroredTextures) {
    Mesh turned = textured_square();
    turned.uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};  // u up, v to the right
    add_tangents(turned, {});
    for (const V4f& tangent : turned.tangents) expect_near_vector(tangent, {0, 1, 0, 1});

    Mesh mirrored = textured_square();
    for (V2f& uv : mirrored.uv[0]) uv.x = -uv.x;
    add_tangents(mirrored, {});
    for (const V4f& tangent : mirrored.tangents) expect_near_vector(tangent, {-1, 0, 0, -1});
}

TEST(GltfTangents, FollowTheTextureTransformAndTheSetOfTheNormalMap) {
    Mesh mesh = textured_square();
    mesh.uv[1] = mesh.uv[0];
    mesh.uv[0].assign(4, V2f(0.f));
    TextureSlot map;
    map.uv_set = 1;
    map.u_row = {0, -3, 0};  // u of the map grows against v: up
    map.v_row = {3, 0, 0};
    add_tangents(mesh, map);
    for (const V4f& tangent : mesh.tangents) expect_near_vector(tangent, {0, 1, 0, 1});
}

TEST(GltfTangents, LieAcrossTheNormal) {
    Mesh mesh = textured_square();
    const V3f tilted = V3f(1, 0, 1).normalized();
    mesh.normals.assign(4, tilted);
    add_tangents(mesh, {});
    const float h = std::sqrt(0.5f);
    for (const V4f& tangent : mesh.tangents) expect_near_vector(tangent, {h, 0, -h, 1});
}

TEST(GltfTangents, AreAveragedByAngle) {
    // Two faces at vertex 0: one of 90 degrees with u along x, one of 45 degrees with u along y.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(5, V3f(0, 0, 1));
    mesh.uv[0] = {{0, 0}, {1, 0}, {0, -1}, {1, -1}, {1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}};
    add_tangents(mesh, {});
    expect_near_vector(mesh.tangents[0], {2 / std::sqrt(5.f), 1 / std::sqrt(5.f), 0, 1});
    expect_near_vector(mesh.tangents[1], {1, 0, 0, 1});
    expect_near_vector(mesh.tangents[3], {0, 1, 0, 1});
}

TEST(GltfTangents, AVertexBetweenMirroredFacesIsSplit) {
    Mesh mesh = textured_square();
    mesh.colours.assign(4, V4f(0.5f));
    mesh.uv[0][3] = {2, 1};  // the second face's u runs the other way about
    mesh = with_tangents(mesh);
    ASSERT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.colours.size(), 6u);
    EXPECT_EQ(mesh.uv[0].size(), 6u);
    const auto &first = mesh.triangles[0], &second = mesh.triangles[1];
    for (uint32_t vertex : first) EXPECT_EQ(mesh.tangents[vertex].w, 1.f);
    for (uint32_t vertex : second) EXPECT_EQ(mesh.tangents[vertex].w, -1.f);
    EXPECT_NE(first[0], second[0]);
    EXPECT_EQ(mesh.positions[first[0]], mesh.positions[second[0]]);
    EXPECT_EQ(mesh.uv[0][first[2]], mesh.uv[0][second[1]]);
}

TEST(GltfTangents, EqualVerticesShareTheirTangent) {
    Mesh shared = textured_square(), repeated = textured_square();
    shared.uv[0][3] = repeated.uv[0][3] = {0, -1};  // the faces' own tangents differ
    repeated.triangles = {{0, 1, 2}, {4, 5, 3}};
    for (const size_t vertex : {0, 2}) {
        repeated.positions.push_back(repeated.positions[vertex]);
        repeated.normals.push_back(repeated.normals[vertex]);
        repeated.uv[0].push_back(repeated.uv[0][vertex]);
    }
    add_tangents(shared, {});
    add_tangents(repeated, {});
    EXPECT_EQ(repeated.tangents[4], repeated.tangents[0]);
    EXPECT_EQ(repeated.tangents[5], repeated.tangents[2]);
    EXPECT_EQ(shared.tangents[0], repeated.tangents[0]);
    EXPECT_NE(shared.tangents[0], shared.tangents[1]);
}

TEST(GltfTangents, FlatMeshesGetOneForEachFace) {
    Mesh mesh = textured_square();
    mesh.normals.clear();
    mesh.positions[3] = {0, 1, -1};
    mesh.positions[0] = {0, 0, -1};
    mesh = with_tangents(mesh);
    ASSERT_EQ(mesh.positions.size(), 6u);
    EXPECT_TRUE(mesh.normals.empty());
    const float h = std::sqrt(0.5f);
    for (const V4f& tangent : mesh.tangents) expect_near_vector(tangent, {h, 0, h, 1});
}

TEST(GltfTangents, UselessTextureCoordinatesStillGiveAFrame) {
    Mesh mesh = textured_square();
    mesh.uv[0].assign(4, V2f(0.5f));
    add_tangents(mesh, {});
    for (const V4f& t : mesh.tangents) {
        EXPECT_NEAR(V3f(t.x, t.y, t.z).length(), 1, 1e-6);
        EXPECT_NEAR(t.z, 0, 1e-6);
    }
    Mesh none = textured_square();
    none.uv[0].clear();
    add_tangents(none, {});
    EXPECT_TRUE(none.tangents.empty());
}

TEST(GltfTangents, RepairMakesThemUnit) {
    Mesh mesh = textured_square();
    mesh.tangents = {{2, 0, 0, 0.5f}, {0, 0, 0, -1}, {0, 0, 3, 1}, {0, 1, 0, -7}};
    repair_tangents(mesh);
    EXPECT_EQ(mesh.tangents[0], V4f(1, 0, 0, 1));
    EXPECT_NEAR(mesh.tangents[1].z, 0, 1e-6);
    EXPECT_NEAR(mesh.tangents[2].z, 0, 1e-6);
    EXPECT_EQ(mesh.tangents[3], V4f(0, 1, 0, -1));
}

TEST(GltfBake, MirroredTangentsKeepTheirBitangent) {
    Mesh mesh = textured_square();
    add_tangents(mesh, {});
    bake(mesh, M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    expect_near_vector(mesh.tangents[0], {-1, 0, 0, -1});
    const V4f& t = mesh.tangents[0];
    const V3f bitangent = mesh.normals[0].cross(V3f(t.x, t.y, t.z)) * t.w;
    EXPECT_LT((bitangent - V3f(0, 1, 0)).length(), 1e-6f);
}

/// A square with a normal map, its own tangents along y.
TinyGltf normal_mapped() {
    TinyGltf file;
    file.add("textures", {{"source", file.add_image(tiny_png(1, 1, {128, 128, 255, 255}))}});
    file.add("materials", {{"normalTexture", {{"index", 0}}}});
    const int uv = file.add_accessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
    const int normals = file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int tangents = file.add_accessor<float>("VEC4", {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1});
    file.add_triangle(
        {{"material", 0},
         {"attributes", {{"TEXCOORD_0", uv}, {"NORMAL", normals}, {"TANGENT", tangents}}}});
    file.add_root({{"mesh", 0}});
    return file;
}

TEST(GltfTangents, TheFilesOwnAreUsedWhereThereIsANormalMap) {
    TinyGltf file = normal_mapped();
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    EXPECT_EQ(load_mesh(file).tangents[0], V4f(0, 1, 0, 1));

    primitive["attributes"].erase("TANGENT");
    expect_near_vector(load_mesh(file).tangents.at(0), {1, 0, 0, 1});

    file = normal_mapped();
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
    const Mesh flat = load_mesh(file);  // tangents without normals do not count
    EXPECT_TRUE(flat.normals.empty());
    expect_near_vector(flat.tangents.at(0), {1, 0, 0, 1});

    file = normal_mapped();
    file.json["materials"][0].erase("normalTexture");
    EXPECT_TRUE(load_mesh(file).tangents.empty());
}

TEST(GltfTangents, AgreeWithThoseOfARealFile) {
    const std::filesystem::path path =
        PETZVAL_SHARED "/scenes/open/flight-helmet/FlightHelmet.gltf";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const GltfFile loaded = load_gltf(path);
    ASSERT_FALSE(contains_line(loaded.honoured, "tangents computed"));  // they come with the file
    size_t vertices = 0, close = 0, same_side = 0;
    for (const Mesh& stored : loaded.scene.meshes) {
        Mesh mesh = stored;
        mesh.tangents.clear();
        add_tangents(mesh, loaded.scene.materials[mesh.material].normal_texture);
        for (size_t i = 0; i < stored.positions.size(); ++i) {
            const V4f &a = stored.tangents[i], &b = mesh.tangents[i];
            ++vertices;
            close += V3f(a.x, a.y, a.z).dot(V3f(b.x, b.y, b.z)) > 0.966f;  // 15 degrees
            same_side += a.w == b.w;
        }
    }
    RecordProperty("vertices", int(vertices));
    EXPECT_GT(double(close), 0.98 * double(vertices));
    EXPECT_GT(double(same_side), 0.999 * double(vertices));
}

}  // namespace
}  // namespace petzval::io
