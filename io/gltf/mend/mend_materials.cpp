// SPDX-License-Identifier: Apache-2.0
// Materials, textures, samplers and images.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "io/base/json_parse.h"
#include "io/gltf/mend/mend.h"
#include "io/gltf/mend/mend_property.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// A slot without a texture is no slot.
void mend_slots(const JsonEditor& owner) {
    std::vector<std::string> empty;
    for (const auto& [key, info] : owner.value().items())
        if (key.ends_with("Texture") && info.is_object() &&
            (!info.contains("index") || info["index"] == -1))
            empty.push_back(key);
    for (const std::string& key : empty)
        owner.drop(key.c_str(), "names no texture; the slot is left without");
}

void mend_material(const JsonEditor& material) {
    at_place(material, "pbrMetallicRoughness", mend_slots);
    mend_slots(material);
    each_property(material, schema::kMaterialRows, mend_property);
    json* extensions = material.find("extensions");
    if (!extensions || !extensions->is_object()) return;
    for (const auto& [name, unused] : extensions->items())
        if (const auto extension = material.extension(name.c_str())) mend_slots(*extension);
}

void mend_sampler(const JsonEditor& sampler) {
    const auto keep = [&](const char* key, std::initializer_list<int> known, const char* taken) {
        const json* value = sampler.find(key);
        if (!value || std::find(known.begin(), known.end(), *value) != known.end()) return;
        sampler.drop(key, fmt::format("is {}, which is unknown; {} is taken",
                                      printable(value->dump()), taken));
    };
    for (const char* key : {"wrapS", "wrapT"}) keep(key, {10497, 33071, 33648}, "REPEAT");
    keep("magFilter", {9728, 9729}, "LINEAR");
    keep("minFilter", {9728, 9729, 9984, 9985, 9986, 9987}, "LINEAR");
}

/// The picture of EXT_texture_webp goes before the one for programs that do not know WebP.
void take_webp(const JsonEditor& texture) {
    const auto webp = texture.extension("EXT_texture_webp");
    if (webp && webp->find("source")) texture.value()["source"] = *webp->find("source");
}

}  // namespace

void mend_textures(const JsonEditor& root) {
    root.each("samplers", mend_sampler);
    root.each("textures", take_webp);
    root.each("images", [](const JsonEditor& image) {
        if (image.find("uri") && image.find("bufferView"))
            image.drop("uri", "stands beside a bufferView; the bufferView is taken");
        image.drop_unless(
            "mimeType", [](const json& type) { return type.is_string(); },
            "is no text; the bytes tell what the image is");
    });
}

void mend_materials(const JsonEditor& root) {
    root.each("materials", mend_material);
}

}  // namespace petzval::io
