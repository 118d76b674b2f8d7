// SPDX-License-Identifier: Apache-2.0
// Measured spectra: those that ship in assets/spectra, and a user's own as CSV. First column:
// wavelength in nm, strictly rising; then one column, or three, of values >= 0. Names that ship may
// be in any case, and go before files of that name; each call reads the files anew.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/spectrum/illuminant.h"
#include "core/spectrum/metal.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval::io {

/// Colour matching functions of CIE 1931, 2 degrees: xbar, ybar, zbar.
[[nodiscard]] std::array<SpectrumTable, 3> standard_observer();
/// Reflectances of linear sRGB's red, green and blue.
[[nodiscard]] std::array<SpectrumTable, 3> rgb_basis();
/// Training reflectances for sensor fits: 24 measured patches of a colour chart.
[[nodiscard]] std::vector<SpectrumTable> training_reflectances();

/// Illuminant "d65", "a", "f11", or a CSV file of one column, whatever it is called: relative
/// power, at most 1, 0 beyond its ends, somewhere above 0. Throws InputError; for a name that is
/// neither it is an ArgumentError that lists the names there are.
[[nodiscard]] SpectrumTable find_illuminant(const std::string& name_or_file);
/// Sensor response "cie1931" or a CSV file of three columns: sensitivities of R, G and B up to one
/// factor, at most 1, 0 beyond their ends; each somewhere above 0. Throws as find_illuminant does.
[[nodiscard]] std::array<SpectrumTable, 3> find_response(const std::string& name_or_file);

/// An illuminant that ships, by name, for a light of the scene. Nothing where there is none.
/// Its 1 nit is one of the tables' sums: kLuminousEfficacy_lm_per_w * sum of ybar * per_nit = 1.
[[nodiscard]] std::optional<Illuminant> find_light_spectrum(const std::string& name);
/// A metal that ships: "ag", "al", "au", "cu", whatever the case. Nothing where there is none.
[[nodiscard]] std::optional<Metal> find_metal(const std::string& name);
/// Linear sRGB of a metal's reflectance at normal incidence under D65; may lie outside [0, 1].
[[nodiscard]] Rgb colour_of(const Metal&);

/// A reflectance that ships, "colorchecker:dark_skin" say, whatever the case. Nothing where there
/// is none.
[[nodiscard]] std::optional<MeasuredReflectance> find_reflectance(const std::string& name);
/// Reflectance of a CSV file, whose bytes these are: one column from 0 to 1, held beyond its ends.
/// Throws InputError with the line.
[[nodiscard]] MeasuredReflectance read_reflectance(const std::filesystem::path&,
                                                   const std::vector<uint8_t>& bytes,
                                                   const std::string& name);

/// Names of the illuminants and metals that ship, for messages: "d65, a, f11" and "ag, al, au, cu".
[[nodiscard]] std::string illuminant_names();
[[nodiscard]] std::string metal_names();
/// Names of the reflectances that ship.
[[nodiscard]] std::vector<std::string> reflectance_names();

}  // namespace petzval::io
