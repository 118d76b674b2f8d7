// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: the same as a node for each place, and what is said of broken ones.
#include <gtest/gtest.h>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
const std::filesystem::path kInstancesOpen = PETZVAL_SHARED "/scenes/open";

struct Place {
    std::array<float, 3> translation;
    std::array<float, 4> rotation;
    std::array<float, 3> scale;
};

// Turned, mirrored, stretched.
const std::vector<Place> kPlaces = {{{1, 2, 3}, {0, 0, 0, 1}, {1, 1, 1}},
                                    {{-4, 0.1f, 7}, {0.5f, 0.5f, -0.5f, 0.5f}, {2, 0.3f, 1}},
                                    {{0, 0, -1}, {0, 0.6f, 0, 0.8f}, {-1, 1, 2}},
                                    {{5, 5, 5}, {0.1f, 0.2f, 0.3f, 0.9f}, {3, 3, 3}}};

template <size_t N>
std::vector<float> values(std::array<float, N> Place::*part) {
    std::vector<float> out;
    for (const Place& place : kPlaces)
        out.insert(out.end(), (place.*part).begin(), (place.*part).end());
    return out;
}

/// A triangle in a node that is turned and mirrored itself; more: of the node.
TinyGltf file_with_instances(json more) {
    TinyGltf file;
    const int normals = file.add_accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.add_triangle({{"attributes", {{"NORMAL", normals}}}});
    more.update(R"({"translation": [10, 0, -3], "rotation": [0, 0.6, 0, 0.8],
                    "scale": [1, -2, 1]})"_json);
    file.add_root(std::move(more));
    file.json["extensionsUsed"] = {kInstancing};
    return file;
}

/// Adds these attributes to the node.
void instance(TinyGltf& file, const json& attributes) {
    file.json["nodes"][0]["mesh"] = 0;
    file.json["nodes"][0]["extensions"][kInstancing]["attributes"] = attributes;
}

TinyGltf instanced() {
    TinyGltf file = file_with_instances(json::object());
    const int t = file.add_accessor("VEC3", values(&Place::translation));
    const int r = file.add_accessor("VEC4", values(&Place::rotation));
    const int s = file.add_accessor("VEC3", values(&Place::scale));
    instance(file, {{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}});
    return file;
}

void expect_same_instances(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (size_t i = 0; i < a.instances.size(); ++i) {
        const Instance &one = a.instances[i], &other = b.instances[i];
        EXPECT_EQ(one.mesh, other.mesh);
        EXPECT_EQ(one.identity, other.identity);
        EXPECT_EQ(one.flips, other.flips);
        EXPECT_EQ(one.to_world, other.to_world) << i;
        EXPECT_EQ(one.to_local, other.to_local) << i;
    }
}

TEST(GltfInstancing, IsANodeForEachPlace) {
    TinyGltf nodes = file_with_instances({{"children", json::array()}});
    for (const Place& place : kPlaces)
        nodes.json["nodes"][0]["children"].push_back(
            nodes.add("nodes", {{"mesh", 0},
                                {"translation", place.translation},
                                {"rotation", place.rotation},
                                {"scale", place.scale}}));
    const GltfFile many = load(instanced());
    EXPECT_EQ(many.scene.meshes.size(), 1u);
    EXPECT_EQ(many.scene.instances.size(), kPlaces.size());
    EXPECT_TRUE(many.warnings.empty());
    EXPECT_TRUE(renders(many, kInstancing));
    expect_same_instances(many.scene, load(nodes).scene);
}

TEST(GltfInstancing, AMeshHasOneGeometryForAllItsNodes) {
    TinyGltf file = instanced();
    file.add_root({{"mesh", 0}});
    const Scene scene = load(file).scene;
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances.size(), kPlaces.size() + 1);
}

TEST(GltfInstancing, EachAttributeMayBeAbsent) {
    TinyGltf file = file_with_instances(json::object());
    instance(file, {{"SCALE", file.add_accessor<float>("VEC3", {1, 1, 1, 2, 2, 2})}});
    file.json["nodes"][0].erase("rotation");
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(V3f(1, 1, 0) * scene.instances[1].to_world, V3f(12, -4, -3));
}

TEST(GltfInstancing, RotationsMayBeShort) {
    TinyGltf file = file_with_instances(json::object());
    const int r =
        file.add_accessor<int8_t>("VEC4", {0, 0, 0, 127, 0, 0, 90, 90}, {{"normalized", true}});
    instance(file, {{"ROTATION", r}});
    file.json["nodes"][0].erase("rotation");
    const auto expect_turned = [](const GltfFile& loaded) {  // a quarter turn about z
        ASSERT_EQ(loaded.scene.instances.size(), 2u);
        EXPECT_LT((V3f(1, 0, 0) * loaded.scene.instances[1].to_world - V3f(10, -2, -3)).length(),
                  1e-5f);
    };
    expect_turned(load(file));
    file.json["accessors"][size_t(r)].erase("normalized");
    const GltfFile unsaid = load(file);
    expect_turned(unsaid);
    EXPECT_TRUE(contains_line(unsaid.warnings, "normalized: must be true for ROTATION"));
}

TEST(GltfInstancing, OnePlaceIsStoredInTheWorld) {
    TinyGltf file = file_with_instances(json::object());
    instance(file, {{"TRANSLATION", file.add_accessor<float>("VEC3", {1, 0, 0})}});
    file.json["nodes"][0].erase("rotation");
    const Scene scene = load(file).scene;
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_TRUE(scene.instances[0].identity);
    EXPECT_EQ(scene.meshes[0].positions[0], V3f(11, 0, -3));
}

TEST(GltfInstancing, PlacesWhereNothingCanBeAreSkipped) {
    TinyGltf file = file_with_instances(json::object());
    const float nan = std::nanf(""), infinity = INFINITY;
    const int t = file.add_accessor<float>("VEC3", {0, 0, 0, nan, 0, 0, 0, infinity, 0, 1, 0, 0});
    const int s = file.add_accessor<float>("VEC3", {1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0});
    instance(file, {{"TRANSLATION", t}, {"SCALE", s}});
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_TRUE(contains_line(loaded.warnings, "3 instances scaled to nothing, or nowhere"));
}

TEST(GltfInstancing, AttributesOfTheFilesOwnAreNamed) {
    TinyGltf file = instanced();
    file.json["nodes"][0]["extensions"][kInstancing]["attributes"]["_ID"] = 99;
    const GltfFile loaded = load(file);
    EXPECT_EQ(loaded.scene.instances.size(), kPlaces.size());
    EXPECT_TRUE(contains_line(loaded.warnings, "_ID is an attribute of the file's own"));
    TinyGltf bare = file_with_instances(json::object());
    instance(bare, {{"_ID", 0}});
    const GltfFile once = load(bare);
    EXPECT_EQ(once.scene.instances.size(), 1u);
    EXPECT_TRUE(contains_line(once.warnings, "the node is shown once"));
}

TEST(GltfInstancing, NoInstancesShowNothing) {
    TinyGltf file = instanced();
    for (int k = 0; k < 3; ++k) file.json["accessors"][size_t(k + 3)]["count"] = 0;
    const GltfFile loaded = load(file);
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_TRUE(contains_line(loaded.warnings, "the node shows nothing"));
}

TEST(GltfInstancing, BrokenOnesAreRefusedByPlace) {
    const std::string place = std::string("/nodes/0/extensions/") + kInstancing + "/attributes/";
    TinyGltf counts = instanced();
    counts.json["accessors"][5]["count"] = 3;
    EXPECT_TRUE(has(refusal([&] { (void)load(counts); }), place + "SCALE: has 3 elements"));
    TinyGltf format = instanced();
    format.json["accessors"][3]["componentType"] = 5123;
    format.json["accessors"][3]["normalized"] = true;
    EXPECT_TRUE(has(refusal([&] { (void)load(format); }), place + "TRANSLATION: is VEC3 of"));
    TinyGltf index = instanced();
    index.json["nodes"][0]["extensions"][kInstancing]["attributes"]["SCALE"] = 6;
    EXPECT_TRUE(has(refusal([&] { (void)load(index); }), place + "SCALE"));
}

TEST(GltfInstancing, ASmallFileMustNotFillTheMemory) {
    TinyGltf zeros =
        file_with_instances(json::object());  // instances that take nothing in the file
    instance(zeros, {{"TRANSLATION", zeros.add("accessors", {{"componentType", 5126},
                                                             {"type", "VEC3"},
                                                             {"count", 2'000'000}})}});
    EXPECT_TRUE(has(refusal([&] { (void)load(zeros); }), "/nodes/0: asks for"));
    TinyGltf shared = file_with_instances(json::object());  // the same ones again and again
    const int t = shared.add_accessor("VEC3", std::vector<float>(300'000, 1.f));
    instance(shared, {{"TRANSLATION", t}});
    const json node = shared.json["nodes"][0];
    for (int i = 0; i < 20'000; ++i) shared.add_root(node);
    EXPECT_TRUE(has(refusal([&] { (void)load(shared); }), ": stands at 100000 places"));
}

TEST(GltfInstancing, AnInstancedFileIsTheExpandedOne) {
    const auto folder = kInstancesOpen / "grass-field";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
    const GltfFile many = load_gltf(folder / "grass-field-gpu-instancing.glb");
    EXPECT_EQ(many.scene.instances.size(), 3001u);
    EXPECT_TRUE(contains_line(many.contents, "4256 stored, 1155872 placed"));
    expect_same_instances(many.scene, load_gltf(folder / "grass-field.glb").scene);
}

}  // namespace
}  // namespace petzval::io
