// SPDX-License-Identifier: Apache-2.0
// Every row of the schema is mended and checked: none is left out on the way.
#include "io/gltf/schema/schema.h"

#include <gtest/gtest.h>

#include "io/base/error.h"
#include "io/gltf/schema/extensions.h"
#include "io/gltf/validate/source.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// A thing of each table, as a file may have it.
struct SmallFeature {
    std::string path;
    json stored;
    std::span<const GltfProperty> rows;
};

std::vector<SmallFeature> features() {
    const json view = {{"yfov", 1}, {"znear", 1}, {"zfar", 2}, {"xmag", 1}, {"ymag", 1}};
    const json light = {{"type", "spot"}, {"spot", json::object()}};
    const auto camera = [&](const char* type) { return json{{"type", type}, {type, view}}; };
    return {{"/materials/0", json::object(), schema::kMaterialRows},
            {"/cameras/0", camera("perspective"), rows_at(schema::kCameraRows, "perspective")},
            {"/cameras/0", camera("orthographic"), rows_at(schema::kCameraRows, "orthographic")},
            {"/extensions/KHR_lights_punctual/lights/0", light, schema::kLightRows},
            {"/nodes/0", json::object(), schema::kNodeRows},
            {"/materials/0/normalTexture", {{"index", 0}}, schema::kSlotRows}};
}

/// What is said of a file in which one property of a thing is this.
struct Said {
    std::string path, refused, warnings;
};

Said say(const SmallFeature& feature, const GltfProperty& row, const json& value) {
    const TempFolder folder;
    TinyGltf file;
    file.json["images"] = {{{"uri", "data:image/png;base64,AA=="}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json[json::json_pointer(feature.path)] = feature.stored;
    const std::string place(row.place), in = feature.path + (place.empty() ? "" : "/" + place);
    if (place.ends_with("Texture")) file.json[json::json_pointer(in)]["index"] = 0;
    Said said{in + "/" + row.key, "", ""};
    file.json[json::json_pointer(said.path)] = value;
    const auto path = file.save_glb(folder.path / "a.glb");
    try {
        for (const std::string& line : read_gltf_source(path).warnings.lines())
            said.warnings += line + "\n";
    } catch (const InputError& fault) {
        said.refused = fault.what();
    }
    return said;
}

bool is_number(const GltfProperty& row) {
    return row.width() > 0;
}
/// Whether the checks see what is wrong with it, and not mending, or none.
bool is_kept(const GltfProperty& row) {
    return row.mending == Mending::Keep || row.range.low < 0;
}

TEST(GltfSchemaChecks, RefuseAValueOfAnotherType) {
    for (const SmallFeature& feature : features())
        for (const GltfProperty& row : feature.rows) {
            const bool mended = row.place == "perspective" || row.place == "orthographic" ||
                                row.key == std::string("range");  // as a whole: planes, ranges
            if (row.kind == PropertyKind::Weights || row.kind >= PropertyKind::Data || mended)
                continue;
            const json wrong = row.kind == PropertyKind::Word ? json(7) : json("seven");
            const Said said = say(feature, row, wrong);
            EXPECT_TRUE(has(said.refused, said.path + ": must be ")) << said.path << said.refused;
        }
}

TEST(GltfSchemaChecks, RefuseOrMendAListOfAnotherLength) {
    for (const SmallFeature& feature : features())
        for (const GltfProperty& row : feature.rows) {
            if (!is_number(row) || row.width() < 2) continue;
            const Said said = say(feature, row, json(std::vector<double>(row.width() + 2, 1.)));
            if (is_kept(row))
                EXPECT_TRUE(has(said.refused, said.path + ": must hold")) << said.path;
            else
                EXPECT_TRUE(has(said.warnings, said.path + ": holds")) << said.path;
        }
}

TEST(GltfSchemaChecks, RefuseOrMendANumberOutsideItsRange) {
    for (const SmallFeature& feature : features())
        for (const GltfProperty& row : feature.rows) {
            if (!is_number(row) || row.range.low < 0 || row.width() == 0) continue;
            if (feature.path == "/cameras/0" || row.key == std::string("range") ||
                row.key == std::string("innerConeAngle"))
                continue;  // mended together
            const json low =
                row.width() == 1 ? json(-3) : json(std::vector<double>(row.width(), -3.));
            const Said said = say(feature, row, low);
            const std::string& where = is_kept(row) ? said.refused : said.warnings;
            EXPECT_TRUE(has(where, said.path)) << said.path << said.refused << said.warnings;
        }
}

TEST(GltfSchemaChecks, RefuseWhatNoFloatHolds) {
    for (const SmallFeature& feature : features())
        for (const GltfProperty& row : feature.rows) {
            if (!is_number(row) || row.width() == 0 || row.key == std::string("range")) continue;
            const json high =
                row.width() == 1 ? json(1e39) : json(std::vector<double>(row.width(), 1e39));
            const Said said = say(feature, row, high);
            EXPECT_TRUE(has(said.refused + said.warnings, feature.path)) << said.path;
        }
}

TEST(GltfSchemaChecks, KnowTheExtensionOfEachRow) {
    for (const SmallFeature& feature : features())
        for (const GltfProperty& row : feature.rows) {
            constexpr std::string_view in = "extensions/";
            if (!row.place.starts_with(in)) continue;
            const std::string_view rest = row.place.substr(in.size());
            const std::string_view name = rest.substr(0, rest.find('/'));
            EXPECT_TRUE(find_gltf_extension(name)) << name;
        }
}

}  // namespace
}  // namespace petzval::io
