// SPDX-License-Identifier: Apache-2.0
// KHR_materials_variants: which material a primitive gets.
#include <gtest/gtest.h>

#include "io/base/error.h"
#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Two triangles of the materials 0 and 1, and the variants "red", "blue\n" and "red". The first is
/// of material 2 in red, and of 3 in blue; the second of 3 in red.
TinyGltf chair() {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_materials_variants"};
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "red"}}, {{"name", "blue\n"}}, {{"name", "red"}}};
    for (const char* name : {"a", "b", "c", "d"}) file.add("materials", {{"name", name}});
    const auto mapped = [](json mappings) {
        return json{{"KHR_materials_variants", {{"mappings", std::move(mappings)}}}};
    };
    const auto mapping = [](int material, json variants) {
        return json{{"material", material}, {"variants", std::move(variants)}};
    };
    file.add_triangle(
        {{"material", 0},
         {"extensions", mapped({mapping(2, json::array({0})), mapping(3, json::array({2, 1}))})}});
    file.add_triangle(
        {{"material", 1}, {"extensions", mapped(json::array({mapping(3, json::array({0}))}))}});
    for (int mesh : {0, 1}) file.add_root({{"mesh", mesh}});
    return file;
}

GltfFile load_variant(const TinyGltf& file, std::optional<std::string> variant) {
    const TempFolder folder;
    PictureBudget pictures;
    GltfChoices choices;
    choices.variant = std::move(variant);
    return load_gltf(file.save_glb(folder.path / "v.glb"), FileScope::Anywhere, pictures, choices);
}

std::string materials_of(const TinyGltf& file, std::optional<std::string> variant) {
    const Scene scene = load_variant(file, std::move(variant)).scene;
    std::string names;
    for (const Mesh& mesh : scene.meshes) names += scene.materials.at(mesh.material).name;
    return names;
}

TEST(GltfVariants, MapMaterialsByNameOrNumber) {
    const TinyGltf file = chair();
    EXPECT_EQ(materials_of(file, std::nullopt), "ab");
    EXPECT_EQ(materials_of(file, "red"), "cd");
    EXPECT_EQ(materials_of(file, "0"), "cd");
    EXPECT_EQ(materials_of(file, "blue\n"), "db");
    EXPECT_EQ(materials_of(file, "blue\\u000a"), "db");
    EXPECT_EQ(materials_of(file, "2"), "db");
    EXPECT_EQ(load(file).holds.variants, (std::vector<std::string>{"red", "blue\n", "red"}));
}

TEST(GltfVariants, ANameGoesBeforeANumber) {
    TinyGltf file = chair();
    file.json["extensions"]["KHR_materials_variants"]["variants"][1]["name"] = "0";
    EXPECT_EQ(materials_of(file, "0"), "db");
}

TEST(GltfVariants, UnknownOnesAreRefusedWithTheList) {
    const auto error = [](const TinyGltf& file, const char* variant) {
        return refusal([&] { (void)load_variant(file, variant); });
    };
    EXPECT_TRUE(
        error(chair(), "reed")
            .ends_with("no variant \"reed\"; it has 0 \"red\", 1 \"blue\\u000a\", 2 \"red\"; "
                       "did you mean red or red?"))
        << error(chair(), "reed");
    for (const char* number : {"3", "-1", "0x1", "99999999999999999999"})
        EXPECT_NE(error(chair(), number), "") << number;
    TinyGltf plain;
    plain.add_root({{"mesh", plain.add_triangle()}});
    EXPECT_TRUE(error(plain, "0").ends_with("no variant \"0\"; the file has no variants"));
}

TEST(GltfVariants, WhatIsWrongInThemLeavesTheMaterialsThatPrimitivesHave) {
    const auto broken = [](const char* change, const char* warning) {
        TinyGltf file = chair();
        file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] =
            json::parse(change);
        EXPECT_EQ(materials_of(file, "red"), "ad") << change;
        EXPECT_EQ(load(file).warnings.size(), *warning ? 1 : 0) << change;
        if (*warning) {
            EXPECT_TRUE(contains_line(load(file).warnings, warning)) << change;
        }
    };
    broken("{}", "");
    broken(R"({"mappings": []})", "");
    broken(R"({"mappings": [{"variants": [0]}]})", "/mappings/0: maps no variant to a material");
    broken(R"({"mappings": [{"material": 2}]})", "/mappings/0: maps no variant to a material");
    broken(R"({"mappings": [{"material": 2, "variants": [3]}]})",
           "/mappings/0: maps a variant that is not there");
    broken(R"({"mappings": [{"material": 2, "variants": [-1]}]})",
           "/mappings/0: maps a variant that is not there");
}

TEST(GltfVariants, MaterialsThatAreNotThereAreRefused) {
    for (const char* mapping :
         {R"({"material": 4, "variants": [0]})", R"({"material": "2", "variants": [0]})",
          R"({"material": 2, "variants": 0})", R"({"material": 2, "variants": ["red"]})", "[]"}) {
        TinyGltf file = chair();
        file.json["meshes"][1]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
            {"mappings", json::array({json::parse(mapping)})}};
        const std::string error = refusal([&] { (void)load(file); });
        EXPECT_NE(error.find("/meshes/1/primitives/0/extensions/KHR_materials_variants/mappings/0"),
                  error.npos)
            << mapping << error;
    }
}

}  // namespace
}  // namespace petzval::io
