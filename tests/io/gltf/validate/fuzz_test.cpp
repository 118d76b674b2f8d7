// SPDX-License-Identifier: Apache-2.0
// Small correct files with a few bytes changed: each is accepted or refused with an InputError;
// run under the address and undefined-behaviour sanitizers this finds what the checks let through.
#include <gtest/gtest.h>

#include <random>

#include "io/base/error.h"
#include "io/gltf/validate/source.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

TinyGltf sample_file() {
    TinyGltf file;
    file.add("materials", {{"normalTexture", {{"index", 0}, {"texCoord", 0}}},
                           {"extensions", {{"KHR_materials_dispersion", {{"dispersion", 1}}}}},
                           {"extras", {{"petzval", {{"metal", "au"}, {"illuminant", "a"}}}}}});
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_materials_dispersion",
                                   "KHR_node_visibility"};
    file.add("textures", {{"source", file.add_image(Bytes{1, 2, 3})}});
    const int mesh = file.add_triangle({{"material", 0}});
    file.json["meshes"][size_t(mesh)]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    const int at = file.add_view_of<uint8_t>({1, 2});
    const int values = file.add_view_of<float>({1, 2, 3, 4, 5, 6});
    file.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", at}, {"componentType", 5121}}},
        {"values", {{"bufferView", values}}}};
    const int t = file.add_accessor<float>("VEC3", {0, 0, 0, 1, 2, 3});
    const int r =
        file.add_accessor<int8_t>("VEC4", {0, 0, 0, 127, 0, 127, 0, 0}, {{"normalized", true}});
    const int child = file.add("nodes", {{"mesh", mesh}, {"scale", {1, 2, 3}}});
    file.json["nodes"][size_t(child)]["extensions"] = {
        {"KHR_node_visibility", {{"visible", true}}},
        {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", t}, {"ROTATION", r}}}}}};
    file.add_root({{"children", {child}}});
    return file;
}

/// Changes one to four bytes: to a digit, a neighbour's value, a bit flipped, or anything.
void mutate(Bytes& bytes, std::mt19937& random) {
    const auto below = [&](size_t n) { return random() % n; };
    for (size_t i = 0, n = 1 + below(4); i < n; ++i) {
        uint8_t& byte = bytes[below(bytes.size())];
        switch (below(4)) {
            case 0:
                byte = uint8_t('0' + below(10));
                break;
            case 1:
                byte = bytes[below(bytes.size())];
                break;
            case 2:
                byte = uint8_t(byte ^ 1u << below(8));
                break;
            default:
                byte = uint8_t(random());
        }
    }
    if (below(16) == 0) bytes.resize(1 + below(bytes.size()));
}

struct Count {
    int accepted = 0, refused = 0;
};

Count fuzz(const Bytes& original, int times) {
    const TempFolder folder;
    std::mt19937 random(20240117);
    Count count;
    for (int i = 0; i < times; ++i) {
        Bytes bytes = original;
        mutate(bytes, random);
        const fs::path path = save_bytes(folder.path / std::to_string(i), bytes);
        try {
            (void)read_gltf_source(path);
            ++count.accepted;
        } catch (const InputError&) {
            ++count.refused;
        }
        fs::remove(path);
    }
    return count;
}

Bytes bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(GltfFuzz, ChangedContainersAreAcceptedOrRefused) {
    const TempFolder folder;
    const Count count = fuzz(bytes_of(sample_file().save_glb(folder.path / "a.glb")), 3000);
    EXPECT_GT(count.accepted, 100);
    EXPECT_GT(count.refused, 1000);
}

TEST(GltfFuzz, ChangedTextIsAcceptedOrRefused) {
    const TempFolder folder;
    const Count count = fuzz(bytes_of(sample_file().save_gltf(folder.path / "a.gltf")), 3000);
    EXPECT_GT(count.accepted, 100);
    EXPECT_GT(count.refused, 1000);
}

/// Every value of the JSON replaced by every kind of other value.
TEST(GltfFuzz, ValuesOfAnyTypeAnywhere) {
    const TinyGltf original = sample_file();
    const TempFolder folder;
    const nlohmann::json odd = nlohmann::json::parse(
        R"([null, true, -1, 0, 7, 0.5, 4294967296, 9007199254740993, 1e300, "", "x", [], [[]],
            [0], {}, {"a": 1}])");
    int count = 0, accepted = 0;
    const nlohmann::json flat = original.json.flatten();
    for (const auto& [place, unused] : flat.items()) {
        for (nlohmann::json::json_pointer at(place); !at.empty(); at = at.parent_pointer())
            for (const auto& value : odd) {
                TinyGltf changed = original;
                changed.json[at] = value;
                const fs::path path = changed.save_glb(folder.path / std::to_string(++count));
                try {
                    (void)read_gltf_source(path);
                    ++accepted;
                } catch (const InputError&) {
                }
                fs::remove(path);
            }
    }
    EXPECT_GT(count, 1000);
    EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace petzval::io
