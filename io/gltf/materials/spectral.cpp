// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials/spectral.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/base/ascii.h"
#include "io/base/json_parse.h"
#include "io/glass/glass_lookup.h"
#include "io/gltf/validate/extras.h"
#include "io/spectra/spectra.h"

namespace petzval::io {
namespace {

/// Greatest index: its square, and what is computed with it, stays far from a float's end.
constexpr double kGreatestIndex = 1e3;

/// Glass of KHR_materials_dispersion: Cauchy's formula, but never an index below 1. Only dispersion
/// above 26 gets there, so that all others keep the formula, which is faster than a table.
Glass khronos_glass(double nd, double dispersion) {
    Glass glass{"KHR_materials_dispersion", cauchy_through(nd, 20 / dispersion)};
    if (glass.index(kLast_nm) >= 1) return glass;
    IndexTable table;
    for (double nm = kFirst_nm; nm <= kLast_nm; ++nm)
        table.points.push_back({nm, std::clamp(glass.index(nm), 1., kGreatestIndex)});
    glass.formula = std::move(table);
    return glass;
}

/// Index of the thing of this name, which is looked up and added where it is not yet there; nothing
/// where there is none.
template <class SmallFeature>
std::optional<int32_t> place_of(std::vector<SmallFeature>& features, const std::string& name,
                                std::optional<SmallFeature> look_up(const std::string&)) {
    const auto at =
        std::find_if(features.begin(), features.end(),
                     [&](const SmallFeature& feature) { return feature.name == lower(name); });
    const auto place = static_cast<int32_t>(at - features.begin());
    if (at != features.end()) return place;
    auto found = look_up(name);
    if (!found) return std::nullopt;
    features.push_back(*std::move(found));
    return place;
}

}  // namespace

GltfSpectral::GltfSpectral(Scene& scene, GltfTally& tally) : scene_(scene), tally_(tally) {}

void GltfSpectral::apply(const JsonCursor& json,
                         const std::map<std::string, MeasuredReflectance>& reflectances,
                         Material& material) {
    const auto extras = petzval_extras(json);
    if (material.unlit) {  // its base colour is all there is to see
        tally_.idle_dispersions += json.extension("KHR_materials_dispersion").has_value();
        if (extras)
            tally_.warnings.push_back(extras->path() + ": an unlit material has no use for it");
        return;
    }
    if (extras && extras->has("glass"))
        apply_glass(*extras, material);
    else
        apply_dispersion(json, material);
    if (is_solid(json).value_or(false) && !material.refracts()) {
        const bool named = extras->has("glass");
        tally_.warnings.push_back(fmt::format(
            "{}: {}, as the material does not refract light; that takes transmissionFactor above "
            "0, and metallicFactor below 1",
            extras->path_of(named ? "glass" : "solid"),
            named ? "disperses nothing" : "has no effect"));
    }
    if (extras && extras->has("metal")) apply_metal(*extras, material);
    if (extras && extras->has("reflectance"))
        apply_reflectance(*extras, reflectances.at(extras->text("reflectance")), material);
    if (material.emits())
        material.illuminant = illuminant(json);
    else if (extras && extras->has("illuminant"))
        tally_.warnings.push_back(extras->path_of("illuminant") +
                                  ": is not seen, as the material emits no light");
}

int32_t GltfSpectral::illuminant(const JsonCursor& owner) {
    const auto extras = petzval_extras(owner);
    if (!extras || !extras->has("illuminant")) return -1;
    const std::string name = extras->text("illuminant");
    const auto place = place_of(scene_.illuminants, name, find_light_spectrum);
    if (!place)
        extras->fail("illuminant", fmt::format("there is no illuminant \"{}\"; there are {}",
                                               printable(name), illuminant_names()));
    tally_.honoured.insert("illuminant " + scene_.illuminant(*place)->name);
    return *place;
}

void GltfSpectral::apply_dispersion(const JsonCursor& json, Material& material) {
    const auto extension = json.extension("KHR_materials_dispersion");
    const double dispersion = extension ? extension->number_or("dispersion", 0) : 0;
    if (dispersion == 0) return;
    if (!material.refracts()) {
        ++tally_.idle_dispersions;
        return;
    }
    if (material.ior <= 1) return;  // nothing bends, at any wavelength
    material.glass = khronos_glass(material.ior, dispersion);
    tally_.honoured.insert("dispersion of light");
}

void GltfSpectral::apply_glass(const JsonCursor& extras, Material& material) {
    material.glass = glass(extras);
    material.ior = static_cast<float>(material.glass->index(kLineD_nm));
    tally_.honoured.insert("named glass " + material.glass->name);
    if (material.refracts()) tally_.honoured.insert("dispersion of light");
}

const Glass& GltfSpectral::glass(const JsonCursor& extras) {
    const std::string name = extras.text("glass");
    if (const auto known = glasses_.find(name); known != glasses_.end()) return known->second;
    FoundGlass found = LensGlasses({}).named(name);
    if (!found.glass) extras.fail("glass", found.error);
    return glasses_.emplace(name, *std::move(found.glass)).first->second;
}

void GltfSpectral::apply_metal(const JsonCursor& extras, Material& material) {
    const std::string name = extras.text("metal");
    const auto place = place_of(scene_.metals, name, find_metal);
    if (!place)
        extras.fail("metal", fmt::format("there is no metal \"{}\"; there are {}", printable(name),
                                         metal_names()));
    const Metal& metal = scene_.metals[static_cast<size_t>(*place)];
    const auto [colour, is_new] = metal_colours_.try_emplace(*place);
    if (is_new) colour->second = Rgb(max(f4{}, min(splat(1.f), colour_of(metal).v)));
    material.metal = *place;
    material.base_color = colour->second;
    // The texture of a cutout has its holes too.
    if (!material.cutout()) material.base_color_texture = TextureSlot();
    tally_.honoured.insert("measured metal " + metal.name);
    if (material.metallic == 0)
        tally_.warnings.push_back(extras.path_of("metal") +
                                  ": is not seen, as the material's metallicFactor is 0");
}

void GltfSpectral::apply_reflectance(const JsonCursor& extras,
                                     const MeasuredReflectance& reflectance, Material& material) {
    if (material.base_color_texture.present() && !material.cutout())
        extras.fail("reflectance",
                    "is the material's colour, and so is its texture; leave out one of them");
    const auto [at, is_new] = reflectances_.try_emplace(
        reflectance.name, static_cast<int32_t>(scene_.reflectances.size()));
    if (is_new) scene_.reflectances.push_back(reflectance);
    material.reflectance = at->second;
    material.base_color = reflectance.rgb;
    tally_.honoured.insert("measured reflectance " + printable(reflectance.name));
}

}  // namespace petzval::io
