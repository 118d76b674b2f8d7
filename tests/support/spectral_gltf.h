// SPDX-License-Identifier: Apache-2.0
// glTF files whose materials and lights have KHR_materials_dispersion or extras.petzval.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/support/load_tiny_gltf.h"
#include "tests/support/refusal.h"

namespace petzval::test {

/// A triangle for each material.
inline TinyGltf file_with_materials(std::vector<nlohmann::json> materials) {
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_materials_dispersion",   "KHR_materials_ior",
                                   "KHR_materials_transmission", "KHR_materials_volume",
                                   "KHR_materials_unlit",        "KHR_lights_punctual"};
    for (nlohmann::json& material : materials) {
        const int index = file.add("materials", std::move(material));
        file.add_root({{"mesh", file.add_triangle({{"material", index}})}});
    }
    return file;
}

/// A material that light is refracted into, called "prism".
inline nlohmann::json prism(nlohmann::json extensions = nlohmann::json::object(),
                            nlohmann::json extras = nullptr) {
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    nlohmann::json material = {{"name", "prism"},
                               {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                               {"extensions", extensions}};
    if (!extras.is_null()) material["extras"]["petzval"] = extras;
    return material;
}

inline nlohmann::json dispersing(double dispersion, double ior = 1.5) {
    return {{"KHR_materials_dispersion", {{"dispersion", dispersion}}},
            {"KHR_materials_ior", {{"ior", ior}}}};
}

/// A material called "thing" with these extras.
inline nlohmann::json thing(nlohmann::json extras) {
    return {{"name", "thing"}, {"extras", {{"petzval", std::move(extras)}}}};
}

inline nlohmann::json lamp(nlohmann::json extras, const char* type = "point") {
    nlohmann::json light = {{"type", type}, {"extras", {{"petzval", std::move(extras)}}}};
    if (std::string(type) == "spot") light["spot"] = nlohmann::json::object();
    return light;
}

/// A node for each light.
inline TinyGltf lit(std::vector<nlohmann::json> lights) {
    TinyGltf file = file_with_materials({});
    for (size_t i = 0; i < lights.size(); ++i)
        file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
    return file;
}

inline Material spectral_material_of(nlohmann::json material) {
    return load(file_with_materials({std::move(material)})).scene.materials.at(0);
}

inline std::string refused(const TinyGltf& file) {
    return refusal([&] { (void)load(file); });
}
inline std::string refused(nlohmann::json material) {
    return refused(file_with_materials({std::move(material)}));
}

}  // namespace petzval::test
