// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials.h"

#include <tiny_gltf.h>

#include "io/base/json_parse.h"

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
                             PictureBudget& pictures)
    : gltf_(gltf),
      scene_(scene),
      tally_(tally),
      textures_(gltf, scene.images, tally, pictures),
      spectral_(scene, tally),
      json_(JsonCursor(gltf.source.json, gltf.file).objects("materials")),
      used_(gltf.typed.materials.size() + 1) {}

uint32_t GltfMaterials::use(int material) {
    const size_t index = material < 0 ? used_.size() - 1 : static_cast<size_t>(material);
    std::optional<uint32_t>& used = used_.at(index);
    if (!used) {
        scene_.materials.push_back(material < 0 ? Material{} : read(index));
        used = static_cast<uint32_t>(scene_.materials.size() - 1);
    }
    return *used;
}

Material GltfMaterials::read(size_t index) {
    const JsonCursor& json = json_.at(index);
    Material material = core_factors(gltf_.typed.materials.at(index));
    if (const auto pbr = json.find_object("pbrMetallicRoughness"))
        material.base_color_texture = textures_.slot(*pbr, "baseColorTexture", Encoding::Srgb);
    material.unlit = json.extension("KHR_materials_unlit").has_value();
    if (material.unlit) {  // only its base colour is ever seen
        material.emissive = Rgb(0.f);
    } else {
        read_surface(json, material);
        read_specular(json, material);
        read_glass(json, material);
    }
    spectral_.apply(json, material);
    count(json, material);
    return material;
}

void GltfMaterials::read_surface(const JsonCursor& json, Material& material) {
    if (const auto pbr = json.find_object("pbrMetallicRoughness"))
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
        material.attenuation_distance_m = number_or(*volume, "attenuationDistance", kInfinity);
    }
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
