// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/document/variants.h"

#include <algorithm>

#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/base/named.h"

namespace petzval::io {
namespace {

constexpr const char* kMaterialVariants = "KHR_materials_variants";

}  // namespace

std::vector<std::string> variant_names(const GltfModel& gltf) {
    std::vector<std::string> names;
    if (const auto list = JsonCursor(gltf.source.json, gltf.file).extension(kMaterialVariants))
        for (const JsonCursor& variant : list->objects("variants"))
            names.push_back(variant.text_or("name", ""));
    return names;
}

GltfVariant::GltfVariant(const GltfModel& gltf, const std::optional<std::string>& wanted)
    : gltf_(gltf) {
    if (!wanted) return;
    const std::vector<std::string> names = variant_names(gltf);
    index_ = find_named(*wanted, names);
    if (!index_)
        throw ArgumentError(gltf.file, "",
                            no_such("variant", *wanted, names, "the file has no variants"));
}

int GltfVariant::material_of(int mesh, size_t primitive, int own) const {
    if (!index_) return own;
    const auto& json =
        gltf_.source.json["meshes"][static_cast<size_t>(mesh)]["primitives"][primitive];
    const auto extension = JsonCursor(json, gltf_.file).extension(kMaterialVariants);
    if (!extension) return own;
    for (const JsonCursor& mapping : extension->objects("mappings")) {
        if (!mapping.has("material") || !mapping.has("variants")) continue;
        const auto& variants = mapping.value()["variants"];
        if (std::find(variants.begin(), variants.end(), *index_) != variants.end())
            return static_cast<int>(mapping.integer("material"));
    }
    return own;
}

}  // namespace petzval::io
