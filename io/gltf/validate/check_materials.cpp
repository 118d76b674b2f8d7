// SPDX-License-Identifier: Apache-2.0
// Materials: types and ranges as in glTF 2.0, sections 5.19 and following, and in the texts of the
// extensions.
#include "io/gltf/mend/material_properties.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"
#include "io/gltf/validate/files.h"

namespace petzval {
namespace {

void check_texture_info(const JsonCursor& info, size_t textures) {
    (void)info.required_index("index", textures, "texture");
    if (info.has("texCoord")) (void)info.integer("texCoord");
    const auto transform = info.extension("KHR_texture_transform");
    if (!transform) return;
    (void)transform->numbers("offset", 2);
    (void)transform->numbers("scale", 2);
    (void)transform->number_or("rotation", 0);
    if (transform->has("texCoord")) (void)transform->integer("texCoord");
}

/// Every texture slot of an object is called "...Texture".
std::vector<JsonCursor> texture_infos(const JsonCursor& owner) {
    std::vector<JsonCursor> infos;
    for (const auto& [key, unused] : owner.value().items())
        if (key.ends_with("Texture")) infos.push_back(owner.object(key.c_str()));
    return infos;
}

void check_pbr(const JsonCursor& pbr) {
    (void)pbr.numbers("baseColorFactor", 4, kUnit);
    (void)pbr.number_or("metallicFactor", 1, kUnit);
    (void)pbr.number_or("roughnessFactor", 1, kUnit);
}

void check_core(const JsonCursor& material) {
    if (const auto pbr = material.find_object("pbrMetallicRoughness")) check_pbr(*pbr);
    if (const auto normal = material.find_object("normalTexture"))
        (void)normal->number_or("scale", 1);
    if (const auto occlusion = material.find_object("occlusionTexture"))
        (void)occlusion->number_or("strength", 1, kUnit);
    (void)material.numbers("emissiveFactor", 3, kNotNegative);
    (void)material.text_or("alphaMode", "OPAQUE");
    (void)material.number_or("alphaCutoff", 0.5, kNotNegative);
    material.check_bool("doubleSided");
}

void check_material_extensions(const JsonCursor& material) {
    for (const auto& [name, key, count, range] : kMaterialProperties) {
        const auto extension = material.extension(name);
        if (!extension) continue;
        if (count == 1)
            (void)extension->number_or(key, 0, range);
        else
            (void)extension->numbers(key, count, range);
    }
    const auto volume = material.extension("KHR_materials_volume");
    if (volume && volume->number_or("attenuationDistance", 1, kNotNegative) == 0)
        volume->fail("attenuationDistance", "must be more than 0");
    const auto ior = material.extension("KHR_materials_ior");
    const double value = ior ? ior->number_or("ior", 1.5, kNotNegative) : 1.5;
    if (value > 0 && value < 1) ior->fail("ior", "must be 0 or at least 1, but is {}", value);
    if (const auto anisotropy = material.extension("KHR_materials_anisotropy"))
        (void)anisotropy->number_or("anisotropyRotation", 0);
    if (const auto coat = material.extension("KHR_materials_clearcoat"))
        if (const auto map = coat->find_object("clearcoatNormalTexture"))
            (void)map->number_or("scale", 1);
}

/// The objects of a material that have texture slots: itself, the core model, its extensions.
std::vector<JsonCursor> texture_owners(const JsonCursor& material) {
    std::vector<JsonCursor> owners = {material};
    if (const auto pbr = material.find_object("pbrMetallicRoughness")) owners.push_back(*pbr);
    const auto extensions = material.find_object("extensions");
    if (!extensions) return owners;
    for (const auto& [name, unused] : extensions->value().items())
        owners.push_back(extensions->object(name.c_str()));
    return owners;
}

}  // namespace

void check_materials(GltfCheck& check) {
    const size_t textures = check.count("textures");
    for (const JsonCursor& material : check.root.objects("materials")) {
        check_core(material);
        check_material_extensions(material);
        if (const auto extras = check_material_extras(material))
            fetch_reflectance(check.source, *extras, check.budget);
        for (const JsonCursor& owner : texture_owners(material))
            for (const JsonCursor& info : texture_infos(owner)) check_texture_info(info, textures);
    }
}

}  // namespace petzval
