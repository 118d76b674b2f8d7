// SPDX-License-Identifier: Apache-2.0
// Field and focus of an analysis: where its light comes from, and where the film stands.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/lens/request.h"
#include "apps/request/parse.h"
#include "camera/bench/spectral_lines.h"
#include "camera/lens/focus.h"
#include "camera/setup/lens_bench.h"

namespace petzval::apps {

struct FieldRequest {
    LensRequest request;
    std::string fields;  ///< degrees with commas between them
    std::string focus;   ///< metres
    std::optional<camera::FocusBy> focus_by;
    std::string film_shift;  ///< mm, or best
    std::string fstop;
    std::string section = "y";
};
/// Adds the options of a lens request, --focus, --focus-by, --film-shift, --section, --fstop; and
/// --field.
void add_field_request(CLI::App&, FieldRequest&, bool with_fields = true);

/// A lens stopped down and in focus, as far as asked; else as filed.
struct FieldSetup : camera::LensBench {
    std::vector<double> fields_deg;
    camera::Section section = camera::Section::Y;
};
/// Opens the lens. shares: fields as shares of the half field, where --field does not say. Throws
/// CLI::ValidationError, or ArgumentError where the lens has no such thing.
[[nodiscard]] FieldSetup set_up(const FieldRequest&, const std::vector<double>& shares);

/// Throws ArgumentError, which says why, for a lens that lets next to no light through to the
/// middle of the film.
void require_light(const camera::Lens&);

/// Ray bundle of a field at a wavelength. Throws ArgumentError where no ray of that field passes
/// the middle of the stop.
[[nodiscard]] camera::AimedBundle aim(const FieldSetup&, double field_deg, double nm);

}  // namespace petzval::apps
