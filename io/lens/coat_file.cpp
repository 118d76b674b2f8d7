// SPDX-License-Identifier: Apache-2.0
#include "io/lens/coat_file.h"

#include <filesystem>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/base/nearest.h"
#include "io/file/text_lines.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {

camera::LayerStack read_layers(const JsonCursor& at) {
    allow_keys(at, {"layers"}, "a coating");
    at.require("layers");
    const std::vector<JsonCursor> items = at.objects("layers");
    if (items.size() > kMaxLayers)
        at.fail("layers", "holds {} layers; a coating may have {}", items.size(), kMaxLayers);
    camera::LayerStack layers;
    for (const JsonCursor& item : items) {
        allow_keys(item, {"thickness_nm", "index", "cauchy_um2", "extinction"}, "a layer");
        layers.push_back({item.number("thickness_nm", {0, 1e6}), item.number("index", {0.01, 10}),
                          item.number_or("cauchy_um2", 0, {-0.001, 1}),
                          item.number_or("extinction", 0, {0, 20})});
    }
    return layers;
}

std::optional<camera::Coating> coating_named(const std::string& name) {
    for (const auto& [known, coating] : camera::kCoatingNames)
        if (known == lower(name)) return coating;
    return std::nullopt;
}

camera::SurfaceCoat read_coat(const std::string& name_or_file) {
    if (const auto coating = coating_named(name_or_file)) return *coating;
    std::error_code none;
    if (!std::filesystem::exists(name_or_file, none)) {
        std::vector<std::string> names;
        for (const auto& [known, coating] : camera::kCoatingNames) names.emplace_back(known);
        throw ArgumentError(name_or_file, "",
                            "is neither a file nor a coating" +
                                did_you_mean_or("the coatings are", name_or_file, names));
    }
    const nlohmann::json json = parse_json(text_of_file(name_or_file), name_or_file);
    return read_layers({json, name_or_file});
}

std::string coating_names() {
    std::string out;
    for (const auto& [name, coating] : camera::kCoatingNames)
        out += (out.empty() ? "" : ", ") + std::string(name);
    return out;
}

}  // namespace petzval::io
