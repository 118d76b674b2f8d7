// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_spectral.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/glasses.h"
#include "io/json_parse.h"
#include "io/spectra.h"

namespace petzval {
namespace {

/// Keeps the square of an index, and what is computed with it, far from a float's end.
constexpr double kGreatestIndex = 1e3;

using Keys = std::vector<std::string_view>;

/// Other people's extras may be of any type.
std::optional<JsonCursor> petzval_extras(const JsonCursor& owner) {
    const auto extras = owner.value().find("extras");
    if (extras == owner.value().end() || !extras->is_object()) return std::nullopt;
    return owner.object("extras").find_object("petzval");
}

void check_extras(const JsonCursor& owner, const char* what, const Keys& known) {
    const auto extras = petzval_extras(owner);
    if (!extras) return;
    for (const auto& [key, unused] : extras->value().items()) {
        if (std::find(known.begin(), known.end(), key) == known.end())
            extras->fail(key, fmt::format("is not known; in a {}'s extras.petzval there may be {}",
                                          what, fmt::join(known, ", ")));
        (void)extras->text(key.c_str());
    }
}

/// KHR_materials_dispersion: Cauchy's formula, but never an index below 1. Only dispersion above
/// 26 gets there, so that all others keep the formula, which is faster than a table.
Glass khronos_glass(double nd, double dispersion) {
    Glass glass{"KHR_materials_dispersion", cauchy_through(nd, 20 / dispersion)};
    if (glass.index(kLast_nm) >= 1) return glass;
    IndexTable table;
    for (double nm = kFirst_nm; nm <= kLast_nm; ++nm)
        table.points.push_back({nm, std::clamp(glass.index(nm), 1., kGreatestIndex)});
    glass.formula = std::move(table);
    return glass;
}

void read_dispersion(const JsonCursor& json, Material& material, GltfTally& tally) {
    const auto extension = json.extension("KHR_materials_dispersion");
    const double dispersion = extension ? extension->number_or("dispersion", 0) : 0;
    if (dispersion == 0) return;
    if (!material.refracts()) {
        ++tally.idle_dispersions;
        return;
    }
    if (material.ior <= 1) return;  // nothing bends, at any wavelength
    material.glass = khronos_glass(material.ior, dispersion);
    tally.honoured.insert("dispersion");
}

Glass named_glass(const JsonCursor& extras) {
    const std::string name = extras.text("glass");
    if (auto glass = find_glass(name)) return *std::move(glass);
    const auto near = glasses_near(name);
    const std::string hint = near.empty() ? "write it as maker:NAME"
                                          : fmt::format("near it are {}", fmt::join(near, ", "));
    extras.fail("glass", fmt::format("there is no glass \"{}\"; {}", printable(name), hint));
}

void read_glass(const JsonCursor& json, const JsonCursor& extras, Material& material,
                GltfTally& tally) {
    const auto warn = [&](const std::string& message) {
        tally.warnings.push_back(extras.path_of("glass") + ": " + message);
    };
    material.glass = named_glass(extras);
    material.ior = static_cast<float>(material.glass->index(kLineD_nm));
    tally.honoured.insert("named glass " + material.glass->name);
    for (const char* overridden : {"KHR_materials_ior", "KHR_materials_dispersion"})
        if (json.extension(overridden))
            warn(fmt::format("stands in place of the material's {}", overridden));
    if (material.refracts())
        tally.honoured.insert("dispersion");
    else
        warn(
            "disperses nothing, as the material does not refract light: it needs "
            "transmissionFactor and thicknessFactor above 0, and metallicFactor below 1");
}

/// Place of a thing with this name, which is added where it is not yet there.
template <class Thing>
int32_t place_of(std::vector<Thing>& things, Thing thing) {
    const auto at = std::find_if(things.begin(), things.end(),
                                 [&](const Thing& other) { return other.name == thing.name; });
    const auto place = static_cast<int32_t>(at - things.begin());
    if (at == things.end()) things.push_back(std::move(thing));
    return place;
}

void read_metal(const JsonCursor& extras, Material& material, Scene& scene, GltfTally& tally) {
    const std::string name = extras.text("metal");
    const auto metal = find_metal(name);
    if (!metal)
        extras.fail("metal", fmt::format("there is no metal \"{}\"; there are {}", printable(name),
                                         metal_names()));
    const Rgb colour = colour_of(*metal);
    for (int i = 0; i < 3; ++i) material.base_color.v[i] = std::clamp(colour[i], 0.f, 1.f);
    // The texture of a cutout has its holes too.
    if (!material.cutout()) material.base_color_texture = TextureSlot();
    material.metal = place_of(scene.metals, *metal);
    tally.honoured.insert("measured metal " + metal->name);
    if (material.metallic == 0)
        tally.warnings.push_back(extras.path_of("metal") +
                                 ": is not seen, as the material's metallicFactor is 0");
}

}  // namespace

void check_material_extras(const JsonCursor& material) {
    check_extras(material, "material", {"glass", "metal", "illuminant"});
    const auto extras = petzval_extras(material);
    if (extras && extras->has("glass") && extras->has("metal"))
        extras->fail("names a glass and a metal; a material is one of them");
}

void check_light_extras(const JsonCursor& light) {
    check_extras(light, "light", {"illuminant"});
}

void read_spectral(const JsonCursor& json, Material& material, Scene& scene, GltfTally& tally) {
    const auto extras = petzval_extras(json);
    if (material.unlit) {  // its base colour is all there is to see
        tally.idle_dispersions += json.extension("KHR_materials_dispersion").has_value();
        if (extras)
            tally.warnings.push_back(extras->path() + ": an unlit material has no use for it");
        return;
    }
    if (extras && extras->has("glass"))
        read_glass(json, *extras, material, tally);
    else
        read_dispersion(json, material, tally);
    if (extras && extras->has("metal")) read_metal(*extras, material, scene, tally);
    if (material.emits())
        material.illuminant = read_illuminant(json, scene, tally);
    else if (extras && extras->has("illuminant"))
        tally.warnings.push_back(extras->path_of("illuminant") +
                                 ": is not seen, as the material emits no light");
}

int32_t read_illuminant(const JsonCursor& owner, Scene& scene, GltfTally& tally) {
    const auto extras = petzval_extras(owner);
    if (!extras || !extras->has("illuminant")) return -1;
    const std::string name = extras->text("illuminant");
    const auto illuminant = find_light_spectrum(name);
    if (!illuminant)
        extras->fail("illuminant", fmt::format("there is no illuminant \"{}\"; there are {}",
                                               printable(name), illuminant_names()));
    tally.honoured.insert("illuminant " + illuminant->name);
    return place_of(scene.illuminants, *illuminant);
}

}  // namespace petzval
