// SPDX-License-Identifier: Apache-2.0
// The one material model of glTF 2.0, with the extensions that Petzval honours.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/scene/beam.h"
#include "core/scene/texture.h"
#include "core/spectrum/bands.h"
#include "core/spectrum/glass.h"

namespace petzval {

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// Why a material that refracts is no closed volume: its surface has a border, faces inwards, holds
/// nothing, or may have holes in its coverage.
enum class VolumeFault : uint8_t { None, Open, InsideOut, Flat, Holes };

/// Smallest GGX width, the square of glTF's roughness: below it a lobe is a mirror, as floats no
/// longer resolve it.
inline constexpr float kSmallestAlpha = 1e-3f;

/// Factors and textures as in the file; names follow the glTF specification.
struct Material {
    std::string name;
    Rgb base_color{1.f};
    float alpha = 1.f;
    TextureSlot base_color_texture;  ///< rgb: base colour, a: coverage
    float metallic = 1.f, roughness = 1.f;
    TextureSlot metallic_roughness_texture;  ///< g: roughness, b: metallic
    TextureSlot normal_texture;
    float normal_scale = 1.f;
    Rgb emissive{0.f};  ///< nits, KHR_materials_emissive_strength included
    TextureSlot emissive_texture;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unseen = false;  ///< camera rays go on behind it
    bool unlit = false;   ///< KHR_materials_unlit: shows its base colour, as nits

    /// KHR_materials_pbrSpecularGlossiness: base_color is its diffuse colour, specular_color its
    /// specular one (ior is 0, metallic 0), 1 - roughness its glossiness; the glossiness of its
    /// texture is the alpha of specular_color_texture.
    bool specular_glossiness = false;

    float ior = 1.5f;              ///< KHR_materials_ior; 0 means a specular weight of 1
    std::optional<Glass> glass;    ///< set where the index depends on wavelength; ior is its nd
    int32_t metal = -1;            ///< measured, index into Scene::metals: replaces the base colour
    int32_t reflectance = -1;      ///< measured, index into Scene::reflectances: likewise
    int32_t illuminant = -1;       ///< white of its emission, index into Scene::illuminants
    std::optional<Beam> beam;      ///< directions that `emissive` is sent in; none: all
    float specular = 1.f;          ///< KHR_materials_specular
    TextureSlot specular_texture;  ///< a
    Rgb specular_color{1.f};
    TextureSlot specular_color_texture;  ///< rgb

    float transmission = 0.f;          ///< KHR_materials_transmission
    TextureSlot transmission_texture;  ///< r
    bool has_volume = false;  ///< KHR_materials_volume with a thickness above 0, or extras say so
    bool meant_thin = false;  ///< extras say that it has no volume
    Rgb attenuation_color{1.f};
    float attenuation_distance_m = kInfinity;

    float coat = 0.f;          ///< KHR_materials_clearcoat: clearcoatFactor
    TextureSlot coat_texture;  ///< r
    float coat_roughness = 0.f;
    TextureSlot coat_roughness_texture;  ///< g
    TextureSlot coat_normal_texture;
    float coat_normal_scale = 1.f;
    Rgb sheen_color{0.f};             ///< KHR_materials_sheen
    TextureSlot sheen_color_texture;  ///< rgb
    float sheen_roughness = 0.f;
    TextureSlot sheen_roughness_texture;  ///< a
    float anisotropy = 0.f;               ///< KHR_materials_anisotropy: anisotropyStrength
    float anisotropy_rotation_rad = 0.f;  ///< from the tangent towards the bitangent
    TextureSlot anisotropy_texture;       ///< rg: direction, b: strength
    float iridescence = 0.f;              ///< KHR_materials_iridescence: iridescenceFactor
    TextureSlot iridescence_texture;      ///< r
    float film_ior = 1.3f, film_thinnest_nm = 100.f, film_thickest_nm = 400.f;
    TextureSlot film_thickness_texture;        ///< g: from the thinnest to the thickest
    float diffuse_transmission = 0.f;          ///< KHR_materials_diffuse_transmission
    TextureSlot diffuse_transmission_texture;  ///< a
    Rgb diffuse_transmission_color{1.f};
    TextureSlot diffuse_transmission_color_texture;  ///< rgb

    /// Rank among closed volumes, by rank_volumes: where several overlap, the highest is there. 0:
    /// no volume, or its surface is not closed.
    uint32_t priority = 0;
    bool overlaps_itself = false;  ///< a point may lie in several closed volumes of it
    VolumeFault volume_fault = VolumeFault::None;
    bool thin_body = false;  ///< it is thin glass, not meant_thin, and part of a mesh is closed

    /// Whether coverage must be asked for at each hit.
    [[nodiscard]] bool cutout() const { return alpha_mode != AlphaMode::Opaque; }
    /// Whether paths weigh its coverage, in place of drawing whether they meet it: of BLEND, all
    /// but what light goes through by other rules.
    [[nodiscard]] bool weighed() const {
        return alpha_mode == AlphaMode::Blend && !refracts() && !may_be_pane();
    }
    [[nodiscard]] bool emits() const {
        return emissive[0] > 0 || emissive[1] > 0 || emissive[2] > 0;
    }
    [[nodiscard]] bool has_sheen() const {
        return sheen_color[0] > 0 || sheen_color[1] > 0 || sheen_color[2] > 0;
    }
    /// Whether it has any of the layers and lobes that most materials lack.
    [[nodiscard]] bool layered() const {
        return coat > 0 || has_sheen() || anisotropy > 0 || iridescence > 0 ||
               diffuse_transmission > 0;
    }
    /// Whether a ray may go on behind it.
    [[nodiscard]] bool lets_light_through() const {
        return transmission > 0 || diffuse_transmission > 0;
    }
    /// Slot along whose coordinates tangents run where the file has none.
    [[nodiscard]] const TextureSlot& tangent_slot() const {
        if (normal_texture.present()) return normal_texture;
        return coat_normal_texture.present() ? coat_normal_texture : anisotropy_texture;
    }
    [[nodiscard]] bool needs_tangents() const {
        return normal_texture.present() || coat_normal_texture.present() || anisotropy > 0;
    }
    /// All slots.
    [[nodiscard]] std::array<const TextureSlot*, 17> textures() const {
        return {&base_color_texture,
                &metallic_roughness_texture,
                &normal_texture,
                &emissive_texture,
                &specular_texture,
                &specular_color_texture,
                &transmission_texture,
                &coat_texture,
                &coat_roughness_texture,
                &coat_normal_texture,
                &sheen_color_texture,
                &sheen_roughness_texture,
                &anisotropy_texture,
                &iridescence_texture,
                &film_thickness_texture,
                &diffuse_transmission_texture,
                &diffuse_transmission_color_texture};
    }
    /// Whether it may be a pane somewhere: thin, smooth glass, through which light goes straight.
    [[nodiscard]] bool may_be_pane() const {
        return transmission > 0 && !has_volume && !unlit &&
               (roughness * roughness < kSmallestAlpha || metallic_roughness_texture.present());
    }
    /// Whether it transmits light somewhere and refracts none, as a pane or a soap bubble.
    [[nodiscard]] bool thin_glass() const {
        return transmission > 0 && !has_volume && !unlit &&
               (metallic < 1 || metallic_roughness_texture.present());
    }
    /// Whether light may be refracted into it.
    [[nodiscard]] bool refracts() const {
        return has_volume && lets_light_through() && !unlit &&
               (metallic < 1 || metallic_roughness_texture.present());
    }
};

/// Reflectance of a clear coat at normal incidence: KHR_materials_clearcoat sets an index of 1.5.
inline constexpr float kCoatF0 = 0.04f;
/// Share of the light from below that a clear coat lets through, at a cosine to the surface: what
/// Schlick's formula for an index of 1.5 leaves, whatever the coat's roughness.
[[nodiscard]] inline float past_coat(float weight, float cosine) {
    const float a = clamp_unit(1.f - cosine);
    return 1.f - weight * (kCoatF0 + (1.f - kCoatF0) * (a * a) * (a * a) * a);
}

}  // namespace petzval
