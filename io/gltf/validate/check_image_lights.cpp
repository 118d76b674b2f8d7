// SPDX-License-Identifier: Apache-2.0
// EXT_lights_image_based.
#include <fmt/format.h>

#include <cmath>

#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr double kGreatest = 1e20;

void check_coefficients(const JsonCursor& light) {
    const json& rows = light.value()["irradianceCoefficients"];
    const auto is_number = [](const json& value) {
        return value.is_number() && std::fabs(value.get<double>()) <= kGreatest;
    };
    bool good = rows.is_array() && rows.size() == 9;
    for (size_t i = 0; good && i < 9; ++i) {
        good = rows[i].is_array() && rows[i].size() == 3;
        for (size_t c = 0; good && c < 3; ++c) good = is_number(rows[i][c]);
    }
    if (!good) light.fail("irradianceCoefficients", "must be 9 arrays of 3 numbers");
}

void check_cube(const GltfCheck& check, const JsonCursor& light) {
    const json& levels = light.value()["specularImages"];
    const size_t images = check.count("images");
    if (!levels.is_array() || levels.empty())
        light.fail("specularImages", "must be an array of levels");
    for (size_t level = 0; level < levels.size(); ++level) {
        if (!levels[level].is_array() || levels[level].size() != 6)
            light.fail("specularImages", "level {} must name 6 images", level);
        for (const json& image : levels[level])
            if (!image.is_number_unsigned() || image.get<uint64_t>() >= images)
                light.fail("specularImages", "level {} names an image that is not there", level);
    }
}

}  // namespace

void check_image_lights(GltfCheck& check) {
    const auto extension = check.root.extension("EXT_lights_image_based");
    const auto lights = extension ? extension->objects("lights") : std::vector<JsonCursor>();
    for (const JsonCursor& light : lights) {
        (void)light.text_or("name", "");
        check_properties(light, schema::kImageLightRows);
        light.require("irradianceCoefficients");
        light.require("specularImages");
        check_coefficients(light);
        check_cube(check, light);
    }
    for (const JsonCursor& scene : check.root.objects("scenes"))
        if (const auto light = scene.extension("EXT_lights_image_based"))
            (void)light->required_index("light", lights.size(), "light");
}

}  // namespace petzval::io
