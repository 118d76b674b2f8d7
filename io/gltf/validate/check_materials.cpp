// SPDX-License-Identifier: Apache-2.0
// Materials: types and ranges as in glTF 2.0, sections 5.19 and following, and in the texts of the
// extensions.
#include <fmt/format.h>

#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"

namespace petzval {
namespace {

constexpr Range unit = {0, 1};
constexpr Range not_negative = {0, std::numeric_limits<float>::max()};

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
    (void)pbr.numbers("baseColorFactor", 4, unit);
    (void)pbr.number_or("metallicFactor", 1, unit);
    (void)pbr.number_or("roughnessFactor", 1, unit);
}

void check_core(const JsonCursor& material) {
    if (const auto pbr = material.find_object("pbrMetallicRoughness")) check_pbr(*pbr);
    if (const auto normal = material.find_object("normalTexture"))
        (void)normal->number_or("scale", 1);
    if (const auto occlusion = material.find_object("occlusionTexture"))
        (void)occlusion->number_or("strength", 1, unit);
    (void)material.numbers("emissiveFactor", 3, not_negative);
    (void)material.text_or("alphaMode", "OPAQUE");
    (void)material.number_or("alphaCutoff", 0.5, not_negative);
    material.check_bool("doubleSided");
}

void check_volume(const JsonCursor& volume) {
    (void)volume.number_or("thicknessFactor", 0, not_negative);
    (void)volume.numbers("attenuationColor", 3, unit);
    if (volume.has("attenuationDistance") &&
        volume.number("attenuationDistance", not_negative) == 0)
        volume.fail("attenuationDistance", "must be more than 0");
}

void check_coat(const JsonCursor& coat) {
    (void)coat.number_or("clearcoatFactor", 0, unit);
    (void)coat.number_or("clearcoatRoughnessFactor", 0, unit);
    if (const auto map = coat.find_object("clearcoatNormalTexture"))
        (void)map->number_or("scale", 1);
}

void check_film(const JsonCursor& film) {
    (void)film.number_or("iridescenceFactor", 0, unit);
    const double ior = film.number_or("iridescenceIor", 1.3, not_negative);
    if (ior < 1) film.fail("iridescenceIor", fmt::format("must be at least 1, but is {}", ior));
    (void)film.number_or("iridescenceThicknessMinimum", 100, not_negative);
    (void)film.number_or("iridescenceThicknessMaximum", 400, not_negative);
}

void check_layers(const JsonCursor& material) {
    if (const auto coat = material.extension("KHR_materials_clearcoat")) check_coat(*coat);
    if (const auto film = material.extension("KHR_materials_iridescence")) check_film(*film);
    if (const auto sheen = material.extension("KHR_materials_sheen")) {
        (void)sheen->numbers("sheenColorFactor", 3, unit);
        (void)sheen->number_or("sheenRoughnessFactor", 0, unit);
    }
    if (const auto anisotropy = material.extension("KHR_materials_anisotropy")) {
        (void)anisotropy->number_or("anisotropyStrength", 0, unit);
        (void)anisotropy->number_or("anisotropyRotation", 0);
    }
    if (const auto leaf = material.extension("KHR_materials_diffuse_transmission")) {
        (void)leaf->number_or("diffuseTransmissionFactor", 0, unit);
        (void)leaf->numbers("diffuseTransmissionColorFactor", 3, unit);
    }
}

void check_material_extensions(const JsonCursor& material) {
    if (const auto dispersion = material.extension("KHR_materials_dispersion"))
        (void)dispersion->number_or("dispersion", 0, not_negative);
    if (const auto strength = material.extension("KHR_materials_emissive_strength"))
        (void)strength->number_or("emissiveStrength", 1, not_negative);
    if (const auto transmission = material.extension("KHR_materials_transmission"))
        (void)transmission->number_or("transmissionFactor", 0, unit);
    if (const auto specular = material.extension("KHR_materials_specular")) {
        (void)specular->number_or("specularFactor", 1, unit);
        (void)specular->numbers("specularColorFactor", 3, not_negative);
    }
    if (const auto glossy = material.extension("KHR_materials_pbrSpecularGlossiness")) {
        (void)glossy->numbers("diffuseFactor", 4, unit);
        (void)glossy->numbers("specularFactor", 3, unit);
        (void)glossy->number_or("glossinessFactor", 1, unit);
    }
    if (const auto volume = material.extension("KHR_materials_volume")) check_volume(*volume);
    const auto ior = material.extension("KHR_materials_ior");
    const double value = ior ? ior->number_or("ior", 1.5, not_negative) : 1.5;
    if (value > 0 && value < 1)
        ior->fail("ior", fmt::format("must be 0 or at least 1, but is {}", value));
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
        check_layers(material);
        check_material_extras(material);
        for (const JsonCursor& owner : texture_owners(material))
            for (const JsonCursor& info : texture_infos(owner)) check_texture_info(info, textures);
    }
}

}  // namespace petzval
