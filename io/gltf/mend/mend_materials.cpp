// SPDX-License-Identifier: Apache-2.0
// Materials, textures, samplers and images.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "io/base/ascii.h"
#include "io/base/json_parse.h"
#include "io/gltf/mend/material_properties.h"
#include "io/gltf/mend/mend.h"

namespace petzval {
namespace {

using nlohmann::json;

/// Fills up a list of numbers that is one short, and cuts off those that are too many.
void mend_length(const JsonEditor& owner, const char* key, size_t count, double last) {
    json* numbers = owner.array(key);
    if (!numbers || numbers->size() == count || numbers->size() + 1 < count) return;
    owner.warn(key, fmt::format("holds {} numbers; it must hold {}", numbers->size(), count));
    while (numbers->size() > count) numbers->erase(numbers->end() - 1);
    if (numbers->size() < count) numbers->push_back(last);
}

void mend_alpha_mode(const JsonEditor& material) {
    json* mode = material.find("alphaMode");
    if (!mode || !mode->is_string()) return;
    const std::string text = mode->get<std::string>();
    for (const char* known : {"OPAQUE", "MASK", "BLEND"}) {
        if (text == known) return;
        if (lower(text) != lower(known)) continue;
        material.warn("alphaMode", fmt::format("is \"{}\"; {} is taken", printable(text), known));
        *mode = known;
        return;
    }
    material.warn("alphaMode",
                  fmt::format("is \"{}\", which is unknown; OPAQUE is taken", printable(text)));
    *mode = "OPAQUE";
}

void mend_bool(const JsonEditor& owner, const char* key) {
    json* value = owner.find(key);
    if (!value || !value->is_number() || (*value != 0 && *value != 1)) return;
    owner.warn(key, "is a number; 0 is taken as false, 1 as true");
    *value = *value == 1;
}

/// Light may be as bright as the file says, although the factor should end at 1: nobody writes 5
/// who means 1.
void mend_emission(const JsonEditor& material) {
    mend_length(material, "emissiveFactor", 3, 0);
    material.clamp_each("emissiveFactor", kNotNegative);
    json* factor = material.array("emissiveFactor");
    if (!factor) return;
    const bool brighter = std::any_of(factor->begin(), factor->end(), [](const json& c) {
        return c.is_number() && c.get<double>() > 1.002;
    });
    if (brighter)
        material.warn("emissiveFactor",
                      "is above 1; it is taken as it stands, "
                      "KHR_materials_emissive_strength should say so");
    else
        material.clamp_each("emissiveFactor", kUnit);
}

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

void mend_distance(const JsonEditor& volume) {
    const json* distance = volume.find("attenuationDistance");
    if (distance && distance->is_number() && distance->get<double>() <= 0)
        volume.drop("attenuationDistance",
                    fmt::format("is {}; nothing is absorbed", distance->get<double>()));
}

void mend_ior(const JsonEditor& extension) {
    const json* ior = extension.find("ior");
    if (ior && ior->is_number() && *ior != 0) extension.clamp("ior", {1, kNotNegative.high});
}

void mend_extensions(const JsonEditor& material) {
    for (const auto& [name, key, count, range] : kMaterialProperties) {
        const auto extension = material.extension(name);
        if (!extension) continue;
        if (count == 1) {
            extension->clamp(key, range);
        } else {
            mend_length(*extension, key, count, 1);
            extension->clamp_each(key, range);
        }
    }
    if (const auto volume = material.extension("KHR_materials_volume")) mend_distance(*volume);
    if (const auto ior = material.extension("KHR_materials_ior")) mend_ior(*ior);
    json* extensions = material.find("extensions");
    if (!extensions || !extensions->is_object()) return;
    for (const auto& [name, unused] : extensions->items())
        if (const auto extension = material.extension(name.c_str())) mend_slots(*extension);
}

void mend_material(const JsonEditor& material) {
    if (const auto pbr = material.object("pbrMetallicRoughness")) {
        mend_length(*pbr, "baseColorFactor", 4, 1);
        pbr->clamp_each("baseColorFactor", kUnit);
        pbr->clamp("metallicFactor", kUnit);
        pbr->clamp("roughnessFactor", kUnit);
        mend_slots(*pbr);
    }
    mend_slots(material);
    if (const auto occlusion = material.object("occlusionTexture"))
        occlusion->clamp("strength", kUnit);
    mend_emission(material);
    mend_alpha_mode(material);
    material.clamp("alphaCutoff", kNotNegative);
    mend_bool(material, "doubleSided");
    mend_extensions(material);
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

}  // namespace petzval
