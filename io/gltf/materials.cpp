// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials.h"

#include <tiny_gltf.h>

#include <cmath>
#include <numbers>

#include "io/base/json_parse.h"
#include "io/gltf/validate/extras.h"

namespace petzval {
namespace {

Rgb to_rgb(const std::vector<double>& c) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

Rgb rgb_or(const JsonCursor& json, const char* key, Rgb otherwise) {
    const auto values = json.numbers(key, 3);
    return values.empty() ? otherwise : to_rgb(values);
}

float number_or(const JsonCursor& json, const char* key, float otherwise) {
    return static_cast<float>(json.number_or(key, otherwise));
}

AlphaMode to_alpha_mode(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::Mask;
    return mode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
}

/// Factors of the core specification.
Material core_factors(const tinygltf::Material& from) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    Material material;
    material.name = printable(from.name);
    material.base_color = to_rgb(pbr.baseColorFactor);
    material.alpha = static_cast<float>(pbr.baseColorFactor[3]);
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.emissive = to_rgb(from.emissiveFactor);
    material.normal_scale = static_cast<float>(from.normalTexture.scale);
    material.alpha_mode = to_alpha_mode(from.alphaMode);
    material.alpha_cutoff = static_cast<float>(from.alphaCutoff);
    material.double_sided = from.doubleSided;
    return material;
}

}  // namespace

GltfMaterials::GltfMaterials(const GltfModel& gltf, Scene& scene, GltfTally& tally,
                             PictureBudget& pictures, DecodedImages& decoded)
    : gltf_(gltf),
      scene_(scene),
      tally_(tally),
      textures_(gltf, scene.images, tally, pictures, decoded),
      spectral_(scene, tally),
      json_(JsonCursor(gltf.source.json, gltf.file).objects("materials")),
      used_(gltf.typed.materials.size() + 1) {}

uint32_t GltfMaterials::use(int material) {
    const size_t index = material < 0 ? used_.size() - 1 : static_cast<size_t>(material);
    std::optional<uint32_t>& used = used_.at(index);
    if (!used) {
        scene_.materials.push_back(material < 0 ? Material{} : read(index));
        more_sets_.push_back(textures_.take_more_sets());
        used = static_cast<uint32_t>(scene_.materials.size() - 1);
    }
    return *used;
}

Material GltfMaterials::read(size_t index) {
    const JsonCursor& json = json_.at(index);
    Material material = core_factors(gltf_.typed.materials.at(index));
    material.unlit = json.extension("KHR_materials_unlit").has_value();
    const auto glossy = json.extension("KHR_materials_pbrSpecularGlossiness");
    material.specular_glossiness = glossy && !material.unlit;
    if (material.specular_glossiness)
        read_specular_glossiness(*glossy, material);
    else if (const auto pbr = json.find_object("pbrMetallicRoughness"))
        material.base_color_texture = textures_.slot(*pbr, "baseColorTexture", Encoding::Srgb);
    if (material.unlit) {  // only its base colour is ever seen
        material.emissive = Rgb(0.f);
    } else {
        read_surface(json, material);
        if (!material.specular_glossiness) {  // which excludes all of these
            read_specular(json, material);
            read_glass(json, material);
            read_coat(json, material);
            read_sheen(json, material);
            read_anisotropy(json, material);
            read_iridescence(json, material);
            read_diffuse_transmission(json, material);
        }
    }
    spectral_.apply(json, gltf_.source.reflectances, material);
    count(json, material);
    return material;
}

void GltfMaterials::read_specular_glossiness(const JsonCursor& json, Material& material) {
    const auto diffuse = json.numbers("diffuseFactor", 4);
    material.base_color = diffuse.empty() ? Rgb(1.f) : to_rgb(diffuse);
    material.alpha = diffuse.empty() ? 1.f : static_cast<float>(diffuse[3]);
    material.base_color_texture = textures_.slot(json, "diffuseTexture", Encoding::Srgb);
    material.ior = 0.f;  // so that the specular colour is the reflectance at normal incidence
    material.specular_color = rgb_or(json, "specularFactor", Rgb(1.f));
    material.specular_color_texture =
        textures_.slot(json, "specularGlossinessTexture", Encoding::Srgb);
    material.metallic = 0.f;
    material.roughness = 1.f - number_or(json, "glossinessFactor", 1.f);
}

void GltfMaterials::read_surface(const JsonCursor& json, Material& material) {
    const auto pbr = json.find_object("pbrMetallicRoughness");
    if (pbr && !material.specular_glossiness)
        material.metallic_roughness_texture =
            textures_.slot(*pbr, "metallicRoughnessTexture", Encoding::Linear);
    material.normal_texture = textures_.slot(json, "normalTexture", Encoding::Linear);
    if (const auto strength = json.extension("KHR_materials_emissive_strength"))
        material.emissive = material.emissive * number_or(*strength, "emissiveStrength", 1.f);
    if (material.emits())  // the texture only scales the factor
        material.emissive_texture = textures_.slot(json, "emissiveTexture", Encoding::Srgb);
}

void GltfMaterials::read_specular(const JsonCursor& json, Material& material) {
    if (const auto ior = json.extension("KHR_materials_ior"))
        material.ior = number_or(*ior, "ior", 1.5f);
    if (const auto specular = json.extension("KHR_materials_specular")) {
        material.specular = number_or(*specular, "specularFactor", 1.f);
        material.specular_texture = textures_.slot(*specular, "specularTexture", Encoding::Linear);
        material.specular_color = rgb_or(*specular, "specularColorFactor", Rgb(1.f));
        material.specular_color_texture =
            textures_.slot(*specular, "specularColorTexture", Encoding::Srgb);
    }
}

void GltfMaterials::read_glass(const JsonCursor& json, Material& material) {
    if (const auto transmission = json.extension("KHR_materials_transmission")) {
        material.transmission = number_or(*transmission, "transmissionFactor", 0.f);
        if (material.transmission > 0.f)
            material.transmission_texture =
                textures_.slot(*transmission, "transmissionTexture", Encoding::Linear);
    }
    if (const auto volume = json.extension("KHR_materials_volume")) {
        material.has_volume = number_or(*volume, "thicknessFactor", 0.f) > 0.f;
        material.attenuation_color = rgb_or(*volume, "attenuationColor", Rgb(1.f));
        const Rgb& colour = material.attenuation_color;
        // White takes nothing at any distance; rounding would make a little of it.
        if (colour[0] < 1 || colour[1] < 1 || colour[2] < 1)
            material.attenuation_distance_m = number_or(*volume, "attenuationDistance", kInfinity);
    }
    if (const auto solid = is_solid(json)) {
        material.has_volume = *solid;
        material.meant_thin = !*solid;
    }
}

void GltfMaterials::read_coat(const JsonCursor& json, Material& material) {
    const auto coat = json.extension("KHR_materials_clearcoat");
    if (!coat) return;
    material.coat = number_or(*coat, "clearcoatFactor", 0.f);
    if (!(material.coat > 0.f)) return;
    material.coat_texture = textures_.slot(*coat, "clearcoatTexture", Encoding::Linear);
    material.coat_roughness = number_or(*coat, "clearcoatRoughnessFactor", 0.f);
    material.coat_roughness_texture =
        textures_.slot(*coat, "clearcoatRoughnessTexture", Encoding::Linear);
    material.coat_normal_texture =
        textures_.slot(*coat, "clearcoatNormalTexture", Encoding::Linear);
    if (const auto map = coat->find_object("clearcoatNormalTexture"))
        material.coat_normal_scale = number_or(*map, "scale", 1.f);
    tally_.honoured.insert("clear coats");
}

void GltfMaterials::read_sheen(const JsonCursor& json, Material& material) {
    const auto sheen = json.extension("KHR_materials_sheen");
    if (!sheen) return;
    material.sheen_color = rgb_or(*sheen, "sheenColorFactor", Rgb(0.f));
    if (!material.has_sheen()) return;
    material.sheen_color_texture = textures_.slot(*sheen, "sheenColorTexture", Encoding::Srgb);
    material.sheen_roughness = number_or(*sheen, "sheenRoughnessFactor", 0.f);
    material.sheen_roughness_texture =
        textures_.slot(*sheen, "sheenRoughnessTexture", Encoding::Linear);
    tally_.honoured.insert("sheen");
}

void GltfMaterials::read_anisotropy(const JsonCursor& json, Material& material) {
    const auto anisotropy = json.extension("KHR_materials_anisotropy");
    if (!anisotropy) return;
    material.anisotropy = number_or(*anisotropy, "anisotropyStrength", 0.f);
    if (!(material.anisotropy > 0.f)) return;
    material.anisotropy_rotation_rad = static_cast<float>(
        std::remainder(anisotropy->number_or("anisotropyRotation", 0), 2 * std::numbers::pi));
    material.anisotropy_texture =
        textures_.slot(*anisotropy, "anisotropyTexture", Encoding::Linear);
    tally_.honoured.insert("anisotropic highlights");
}

void GltfMaterials::read_iridescence(const JsonCursor& json, Material& material) {
    const auto film = json.extension("KHR_materials_iridescence");
    if (!film) return;
    material.iridescence = number_or(*film, "iridescenceFactor", 0.f);
    if (!(material.iridescence > 0.f)) return;
    material.iridescence_texture = textures_.slot(*film, "iridescenceTexture", Encoding::Linear);
    material.film_ior = number_or(*film, "iridescenceIor", 1.3f);
    material.film_thinnest_nm = number_or(*film, "iridescenceThicknessMinimum", 100.f);
    material.film_thickest_nm = number_or(*film, "iridescenceThicknessMaximum", 400.f);
    material.film_thickness_texture =
        textures_.slot(*film, "iridescenceThicknessTexture", Encoding::Linear);
    tally_.honoured.insert("iridescence of thin films");
}

void GltfMaterials::read_diffuse_transmission(const JsonCursor& json, Material& material) {
    const auto leaf = json.extension("KHR_materials_diffuse_transmission");
    if (!leaf) return;
    material.diffuse_transmission = number_or(*leaf, "diffuseTransmissionFactor", 0.f);
    if (!(material.diffuse_transmission > 0.f)) return;
    material.diffuse_transmission_texture =
        textures_.slot(*leaf, "diffuseTransmissionTexture", Encoding::Linear);
    material.diffuse_transmission_color = rgb_or(*leaf, "diffuseTransmissionColorFactor", Rgb(1.f));
    material.diffuse_transmission_color_texture =
        textures_.slot(*leaf, "diffuseTransmissionColorTexture", Encoding::Srgb);
    tally_.honoured.insert("diffuse transmission");
}

void GltfMaterials::count(const JsonCursor& json, const Material& material) {
    tally_.occlusion_textures += json.has("occlusionTexture");
    const auto note = [&](bool present, const char* feature) {
        if (present) tally_.honoured.insert(feature);
    };
    note(material.normal_texture.present(), "normal maps");
    note(material.emits(), "emissive materials");
    note(material.alpha_mode == AlphaMode::Mask, "alpha MASK");
    note(material.alpha_mode == AlphaMode::Blend, "alpha BLEND");
    note(material.double_sided, "double-sided materials");
}

}  // namespace petzval
