// SPDX-License-Identifier: Apache-2.0
// Lenses of assets/lenses: with the indices for which tests/data/oracle has figures, or any of
// them; for tests that know no io.
#pragma once

#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
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

/// The surfaces of a lens file; glass_of(medium, surface) makes what follows a surface, from 0.
template <class GlassOf>
[[nodiscard]] camera::Prescription surfaces_of(const nlohmann::json& file,
                                               const GlassOf& glass_of) {
    camera::Prescription lens;
    lens.name = file.at("name");
    for (const auto& item : file.at("surfaces")) {
        camera::LensSurface surface;
        if (!item.at("radius").is_null())
            surface.curvature_1_mm = 1 / item.at("radius").template get<double>();
        surface.conic = item.value("conic", 0.);
        if (item.contains("asphere"))
            for (const auto& [power, coefficient] : item.at("asphere").items())
                surface.asphere.push_back({std::stod(power), coefficient.template get<double>()});
        const auto cylinder = item.value("cylinder", std::string());
        if (cylinder == "x") surface.profile = camera::Profile::CylinderX;
        if (cylinder == "y") surface.profile = camera::Profile::CylinderY;
        surface.thickness_mm = item.at("thickness");
        surface.semi_diameter_mm = item.at("semi_diameter");
        surface.stop = item.value("stop", false);
        if (!item.at("medium").is_null())
            surface.glass = glass_of(item.at("medium"), lens.surfaces.size());
        lens.surfaces.push_back(std::move(surface));
    }
    return lens;
}

[[nodiscard]] inline nlohmann::json read_lens_file(const std::string& name) {
    return read_json(PETZVAL_ASSETS "/lenses/" + name + ".json");
}

/// Surfaces only. Glasses are tables of the oracle's indices at the lines F, d and C.
[[nodiscard]] inline camera::Prescription read_lens(const std::string& name) {
    const auto lines = read_oracle(name).at("refractive_indices");
    return surfaces_of(read_lens_file(name), [&](const nlohmann::json&, size_t surface) {
        IndexTable table;
        for (const auto& [nm, indices] : lines.items())
            table.points.push_back({std::stod(nm), indices.at(surface + 1)});
        return Glass{"as given", std::move(table)};
    });
}

/// Fluorite, whose name the lenses of assets/lenses use and used_glasses.csv has not: Hikari's
/// figures.
[[nodiscard]] inline Glass fluorite() {
    return {"hikari:NICF-A", Sellmeier{{{0.581797965, 0.002477442},
                                        {0.373232342, 0.01032026},
                                        {0.083677196, 0.010323473},
                                        {2.36293749, 738.225998}}}};
}

/// A glass of tests/data/used_glasses.csv by its name, "maker:glass": its table of lines.
[[nodiscard]] inline Glass read_used_glass(std::string name) {
    if (name == "hikari:NICF-A") return fluorite();
    std::string key = name;
    for (char& c : key) c = c == ':' ? '_' : static_cast<char>(std::toupper(c));
    std::ifstream file(PETZVAL_TEST_DATA "/used_glasses.csv");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(key + ",")) continue;
        std::istringstream cells(line.substr(key.size() + 1));
        const auto next = [&cells] {
            std::string cell;
            std::getline(cells, cell, ',');
            return std::stod(cell);
        };
        const double nd = next(), nf = next(), nc = next(), ng = next();
        return {std::move(name),
                IndexTable{{{kLineG_nm, ng}, {kLineF_nm, nf}, {kLineD_nm, nd}, {kLineC_nm, nc}}}};
    }
    throw std::invalid_argument("no glass " + name + " in used_glasses.csv");
}

/// Any lens of assets/lenses with what its file states, exact at the lines g, F, d and C.
[[nodiscard]] inline camera::Prescription read_any_lens(const std::string& name) {
    const auto file = read_lens_file(name);
    camera::Prescription lens = surfaces_of(file, [](const nlohmann::json& medium, size_t) {
        if (medium.contains("glass")) return read_used_glass(medium.at("glass"));
        return Glass{"as given", glass_like(medium.at("nd"), medium.at("vd"))};
    });
    lens.stated_focal_length_mm = file.at("focal_length").get<double>();
    lens.stated_fnumber = file.at("fnumber").get<double>();
    lens.stated_field_half_deg = file.at("field_half_angle_deg").get<double>();
    lens.image_circle_mm = file.at("image_circle");
    if (file.contains("focus_group")) lens.focus_group = file.at("focus_group");
    return lens;
}

}  // namespace petzval::test
