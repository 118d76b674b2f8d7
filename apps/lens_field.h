// SPDX-License-Identifier: Apache-2.0
// Where the light of an analysis comes from, and where the film stands.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/lens_request.h"
#include "apps/parse.h"
#include "camera/beam.h"

namespace petzval {

struct SpectralLine {
    const char* name;
    double nm;
    const char* colour;
};
inline constexpr std::array<SpectralLine, 3> kSpectralLines{
    {{"F", kLineF_nm, "#2060d0"}, {"d", kLineD_nm, "#d09000"}, {"C", kLineC_nm, "#c02020"}}};

struct FieldRequest {
    LensRequest request;
    std::string fields;      ///< degrees with commas between them
    std::string focus;       ///< metres
    std::string film_shift;  ///< mm, or best
    std::string section = "y";
};
/// The lens, --focus, --film-shift, --section; and --field.
void add_field_request(CLI::App&, FieldRequest&, bool with_fields = true);

struct FieldSetup {
    std::vector<double> fields_deg;
    double distance_mm = 0;  ///< infinite by default
    double film_mm = 0;
    Section section = Section::Y;
};
/// shares: of the half field, where --field does not say. Throws CLI::ValidationError, or
/// ArgumentError where the lens has no such thing.
[[nodiscard]] FieldSetup set_up(const Lens&, const FieldRequest&,
                                const std::vector<double>& shares);

/// Throws ArgumentError where no ray of that field passes the middle of the stop.
[[nodiscard]] Beam aim(const Lens&, const FieldSetup&, double field_deg, double nm);

}  // namespace petzval
