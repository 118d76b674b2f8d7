// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials/materials.h"

#include <cmath>
#include <numbers>
#include <variant>

#include "io/base/json_parse.h"
#include "io/gltf/validate/extras.h"

namespace petzval::io {
namespace {

/// Factors of the core specification that stay as they are.
constexpr MaterialField kFactors[] = {
    {"metallicFactor", &Material::metallic},          {"roughnessFactor", &Material::roughness},
    {"normalTexture/scale", &Material::normal_scale}, {"emissiveFactor", &Material::emissive},
    {"alphaCutoff", &Material::alpha_cutoff},
};

constexpr MaterialField kGlossy[] = {
    {"diffuseTexture", &Material::base_color_texture},
    {"KHR_materials_pbrSpecularGlossiness/specularFactor", &Material::specular_color},
    {"specularGlossinessTexture", &Material::specular_color_texture},
};

/// Layers and lobes of extensions. Images are decoded in this order.
constexpr MaterialField kLayers[] = {
    {"ior", &Material::ior},
    {"KHR_materials_specular/specularFactor", &Material::specular},
    {"specularTexture", &Material::specular_texture},
    {"specularColorFactor", &Material::specular_color},
    {"specularColorTexture", &Material::specular_color_texture},
    {"transmissionFactor", &Material::transmission, ""},
    {"transmissionTexture", &Material::transmission_texture},
    {"attenuationColor", &Material::attenuation_color},
    {"attenuationDistance", &Material::attenuation_distance_m},
    {"clearcoatFactor", &Material::coat, "clear coats"},
    {"clearcoatTexture", &Material::coat_texture},
    {"clearcoatRoughnessFactor", &Material::coat_roughness},
    {"clearcoatRoughnessTexture", &Material::coat_roughness_texture},
    {"clearcoatNormalTexture", &Material::coat_normal_texture},
    {"clearcoatNormalTexture/scale", &Material::coat_normal_scale},
    {"sheenColorFactor", &Material::sheen_color, "sheen"},
    {"sheenColorTexture", &Material::sheen_color_texture},
    {"sheenRoughnessFactor", &Material::sheen_roughness},
    {"sheenRoughnessTexture", &Material::sheen_roughness_texture},
    {"anisotropyStrength", &Material::anisotropy, "anisotropic highlights"},
    {"anisotropyTexture", &Material::anisotropy_texture},
    {"iridescenceFactor", &Material::iridescence, "iridescence of thin films"},
    {"iridescenceTexture", &Material::iridescence_texture},
    {"iridescenceIor", &Material::film_ior},
    {"iridescenceThicknessMinimum", &Material::film_thinnest_nm},
    {"iridescenceThicknessMaximum", &Material::film_thickest_nm},
    {"iridescenceThicknessTexture", &Material::film_thickness_texture},
    {"diffuseTransmissionFactor", &Material::diffuse_transmission, "diffuse transmission"},
    {"diffuseTransmissionTexture", &Material::diffuse_transmission_texture},
    {"diffuseTransmissionColorFactor", &Material::diffuse_transmission_color},
    {"diffuseTransmissionColorTexture", &Material::diffuse_transmission_color_texture},
};

Rgb to_rgb(const std::array<double, 4>& c) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

float number(const JsonCursor& json, MaterialRow name) {
    return static_cast<float>(number_of(json, name));
}

Rgb colour(const JsonCursor& json, MaterialRow name) {
    return to_rgb(numbers_of(json, name));
}

/// Colour and coverage.
void read_base(const JsonCursor& json, MaterialRow name, Material& material) {
    material.base_color = colour(json, name);
    material.alpha = static_cast<float>(numbers_of(json, name)[3]);
}

AlphaMode to_alpha_mode(const std::string& mode) {
    if (mode == "MASK") return AlphaMode::Mask;
    return mode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
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
      used_(json_.size() + 1) {}

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
    Material material;
    material.name = printable(json.text_or("name", ""));
    material.alpha_mode = to_alpha_mode(json.text_or("alphaMode", ""));
    material.double_sided = json.value().value("doubleSided", false);
    material.unlit = json.extension("KHR_materials_unlit").has_value();
    material.specular_glossiness =
        json.extension("KHR_materials_pbrSpecularGlossiness") && !material.unlit;
    read(json, kFactors, material);
    if (material.specular_glossiness) {
        read(json, kGlossy, material);
        read_base(json, "diffuseFactor", material);
        material.ior = 0.f;  // so that the specular colour is the reflectance at normal incidence
        material.metallic = 0.f;
        material.roughness = 1.f - number(json, "glossinessFactor");
    } else {
        read_base(json, "baseColorFactor", material);
        material.base_color_texture = slot(json, "baseColorTexture");
    }
    if (material.unlit)  // only its base colour is ever seen
        material.emissive = Rgb(0.f);
    else
        read_surface(json, material);
    spectral_.apply(json, gltf_.source.reflectances, material);
    count(json, material);
    return material;
}

TextureSlot GltfMaterials::slot(const JsonCursor& json, MaterialRow name) {
    return textures_.slot(json, name);
}

void GltfMaterials::read(const JsonCursor& json, std::span<const MaterialField> fields,
                         Material& material) {
    std::string_view idle = "none";  // place of a layer that is not there
    for (const auto& [name, member, layer] : fields) {
        const GltfProperty& property = name;
        if (property.place.starts_with(idle)) continue;
        bool there = true;
        if (const auto* factor = std::get_if<float Material::*>(&member))
            there = (material.** factor = static_cast<float>(number_of(json, property))) > 0;
        else if (const auto* rgb = std::get_if<Rgb Material::*>(&member))
            there = hmax((material.** rgb = to_rgb(numbers_of(json, property))).v) > 0;
        else
            material.*std::get<TextureSlot Material::*>(member) = textures_.slot(json, property);
        if (layer && !there) idle = property.place;
        if (layer && there && *layer) tally_.honoured.insert(layer);
    }
}

void GltfMaterials::read_surface(const JsonCursor& json, Material& material) {
    if (!material.specular_glossiness)
        material.metallic_roughness_texture = slot(json, "metallicRoughnessTexture");
    material.normal_texture = slot(json, "normalTexture");
    material.emissive = material.emissive * number(json, "emissiveStrength");
    if (material.emits())  // the texture only scales the factor
        material.emissive_texture = slot(json, "emissiveTexture");
    if (material.specular_glossiness) return;  // it excludes all layers
    read(json, kLayers, material);
    // White takes nothing at any distance; rounding would make a little of it.
    const Rgb& white = material.attenuation_color;
    if (!(white[0] < 1 || white[1] < 1 || white[2] < 1))
        material.attenuation_distance_m = kInfinity;
    const auto solid = is_solid(json);
    material.has_volume = solid.value_or(number(json, "thicknessFactor") > 0);
    material.meant_thin = !solid.value_or(true);
    if (material.anisotropy > 0)
        material.anisotropy_rotation_rad = static_cast<float>(std::remainder(
            number_of(json, MaterialRow("anisotropyRotation")), 2 * std::numbers::pi));
}

void GltfMaterials::count(const JsonCursor& json, const Material& material) {
    tally_.scattering_volumes += hmax(colour(json, "multiscatterColor").v) > 0;
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

}  // namespace petzval::io
