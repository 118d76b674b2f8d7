// SPDX-License-Identifier: Apache-2.0
// Lenses of assets/lenses, with the indices for which tests/data/oracle has figures.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "camera/lens/prescription.h"

namespace petzval::test {

[[nodiscard]] inline nlohmann::json read_json(const std::string& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

/// The figures for a lens, by the name of its file.
[[nodiscard]] inline nlohmann::json read_oracle(const std::string& name) {
    return read_json(PETZVAL_TEST_DATA "/oracle/" + name + ".json");
}

inline const char* const kOracleLenses[] = {
    "canon-14mm-f2.8-asph",      "cooke-triplet-50mm-f5",     "double-gauss-100mm-f2",
    "kodak-petzval-100mm-f2",    "minolta-fisheye-16mm-f2.8", "nikkor-retrofocus-28mm-f2.8",
    "schneider-anamorphic-31mm", "takumar-50mm-f1.2"};

/// Of different shapes: spheres, aspheres, cylinders, and a field beyond 90 degrees.
inline const char* const kLensKinds[] = {"double-gauss-100mm-f2", "canon-14mm-f2.8-asph",
                                         "schneider-anamorphic-31mm", "minolta-fisheye-16mm-f2.8"};

/// Glasses are tables of the oracle's indices at the lines F, d and C.
[[nodiscard]] inline Prescription read_lens(const std::string& name) {
    const auto file = read_json(PETZVAL_ASSETS "/lenses/" + name + ".json");
    const auto lines = read_oracle(name).at("refractive_indices");
    Prescription lens;
    lens.name = name;
    for (const auto& item : file.at("surfaces")) {
        LensSurface surface;
        if (!item.at("radius").is_null())
            surface.curvature_1_mm = 1 / item.at("radius").get<double>();
        surface.conic = item.value("conic", 0.);
        if (item.contains("asphere"))
            for (const auto& [power, coefficient] : item.at("asphere").items())
                surface.asphere.push_back({std::stod(power), coefficient.get<double>()});
        const auto cylinder = item.value("cylinder", std::string());
        if (cylinder == "x") surface.profile = Profile::CylinderX;
        if (cylinder == "y") surface.profile = Profile::CylinderY;
        surface.thickness_mm = item.at("thickness");
        surface.semi_diameter_mm = item.at("semi_diameter");
        surface.stop = item.value("stop", false);
        lens.surfaces.push_back(std::move(surface));
        if (item.at("medium").is_null()) continue;
        IndexTable table;
        for (const auto& [nm, indices] : lines.items())
            table.points.push_back({std::stod(nm), indices.at(lens.surfaces.size())});
        lens.surfaces.back().glass = Glass{"as given", std::move(table)};
    }
    return lens;
}

}  // namespace petzval::test
