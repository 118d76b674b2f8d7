// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/schema/schema.h"

#include <gtest/gtest.h>

#include <set>

namespace petzval::io {
namespace {

/// A table, and the path of a thing of it.
struct Table {
    std::string thing;
    std::span<const GltfProperty> rows;
};

std::vector<Table> tables() {
    return {{"/materials/7", schema::kMaterialRows},
            {"/cameras/7", schema::kCameraRows},
            {"/extensions/KHR_lights_punctual/lights/7", schema::kLightRows},
            {"/extensions/EXT_lights_image_based/lights/7", schema::kImageLightRows},
            {"/nodes/7", schema::kNodeRows},
            {"/meshes/7", schema::kMeshRows},
            {"/materials/7/extensions/X_y/anyTexture", schema::kSlotRows}};
}

std::string path_of(const Table& table, const GltfProperty& row) {
    const std::string place(row.place);
    return table.thing + (place.empty() ? "/" : "/" + place + "/") + row.key;
}

TEST(GltfSchema, PropertiesOfAPlaceStandTogetherAndOnce) {
    for (const Table& table : tables()) {
        std::set<std::string_view> places;
        std::set<std::string> paths;
        for (size_t i = 0; i < table.rows.size(); ++i) {
            const GltfProperty& row = table.rows[i];
            const bool is_first = i == 0 || table.rows[i - 1].place != row.place;
            EXPECT_EQ(places.insert(row.place).second, is_first) << path_of(table, row);
            EXPECT_TRUE(paths.insert(path_of(table, row)).second) << path_of(table, row);
        }
    }
}

TEST(GltfSchema, DefaultsAreNumbersThatMayStand) {
    for (const Table& table : tables())
        for (const GltfProperty& row : table.rows) {
            EXPECT_GE(row.preset, row.range.low) << path_of(table, row);
            EXPECT_TRUE(row.preset <= row.range.high || std::isinf(row.preset))
                << path_of(table, row);
        }
}

TEST(GltfSchema, PointersLeadToWhatMayMove) {
    size_t moving = 0;
    for (const Table& table : tables())
        for (const GltfProperty& row : table.rows) {
            moving += row.animated();
            EXPECT_EQ(animated_property(path_of(table, row)), row.animated() ? &row : nullptr)
                << path_of(table, row);
        }
    EXPECT_GE(moving, 53u);
}

TEST(GltfSchema, PointersToOneWeightLeadToANumber) {
    for (const char* thing : {"/nodes/3", "/meshes/0"}) {
        const GltfProperty* const all = animated_property(std::string(thing) + "/weights");
        const GltfProperty* const one = animated_property(std::string(thing) + "/weights/12");
        ASSERT_TRUE(all && one);
        EXPECT_EQ(all->kind, PropertyKind::Weights);
        EXPECT_EQ(one->kind, PropertyKind::Number);
    }
    EXPECT_FALSE(animated_property("/cameras/0/weights/1"));
    EXPECT_FALSE(animated_property("/nodes/0/weights/one"));
}

TEST(GltfSchema, OtherPointersLeadNowhere) {
    for (const char* pointer : {"",
                                "/",
                                "//",
                                "/materials",
                                "/materials/0",
                                "/materials/0/",
                                "materials/0/alphaCutoff",
                                "/materials/x/alphaCutoff",
                                "/materials/-1/alphaCutoff",
                                "/materials/0/doubleSided",
                                "/materials/0/alphaMode",
                                "/materials/0/baseColorFactor",
                                "/materials/0/alphaCutoff/0",
                                "/materials/0/normalTexture",
                                "/materials/0/emissiveTexture/scale",
                                "/nodes/0/matrix",
                                "/nodes/0/camera",
                                "/cameras/0/yfov",
                                "/scenes/0/name",
                                "/extensions/EXT_lights_image_based/lights/0/color"})
        EXPECT_FALSE(animated_property(pointer)) << pointer;
}

TEST(GltfSchema, NamesAreKeysOrEndsOfPaths) {
    EXPECT_EQ(MaterialRow("ior").row.place, "extensions/KHR_materials_ior");
    EXPECT_EQ(MaterialRow("KHR_materials_specular/specularFactor").row.width(), 1u);
    EXPECT_EQ(MaterialRow("KHR_materials_pbrSpecularGlossiness/specularFactor").row.width(), 3u);
    EXPECT_EQ(MaterialRow("normalTexture/scale").row.place, "normalTexture");
    for (const char* name : {"io", "r", "/ior", "materials_ior/ior", "ior/ior"})
        EXPECT_FALSE(is_named(MaterialRow("ior").row, name)) << name;
    EXPECT_FALSE(is_named(MaterialRow("alphaCutoff").row, "xalphaCutoff"));
}

TEST(GltfSchema, WhatIsAbsentHasItsDefault) {
    const nlohmann::json json = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}}},
        {"extensions", {{"KHR_materials_ior", {{"ior", 2.5}}}}}};
    const std::string file = "a.gltf";
    const JsonCursor material(json, file);
    EXPECT_EQ(number_of(material, MaterialRow("ior").row), 2.5);
    EXPECT_EQ(number_of(material, MaterialRow("alphaCutoff").row), 0.5);
    EXPECT_EQ(number_of(material, MaterialRow("iridescenceIor").row), 1.3);
    EXPECT_EQ(number_of(material, CameraRow("aspectRatio").row), 0);  // none
    EXPECT_EQ(presets_of(rows_at(schema::kNodeRows, "")[1]), (std::array{1., 1., 1., 1.}));
    EXPECT_EQ(presets_of(rows_at(schema::kNodeRows, "")[2]), (std::array{0., 0., 0., 1.}));
    EXPECT_EQ(numbers_of(material, MaterialRow("baseColorFactor").row),
              (std::array{0.1, 0.2, 0.3, 0.4}));
    EXPECT_EQ(numbers_of(material, MaterialRow("diffuseFactor").row), (std::array{1., 1., 1., 1.}));
}

}  // namespace
}  // namespace petzval::io
