// SPDX-License-Identifier: Apache-2.0
// Lens prescriptions: those that ship in assets/lenses, and a user's own. docs/guide/lenses.md
// describes the formats.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/lens/prescription.h"
#include "io/glass/agf.h"

namespace petzval::io {

struct LensFile {
    camera::Prescription lens;          ///< image_circle_mm is 0 where the file does not say
    std::vector<std::string> warnings;  ///< one line each: what the file does not say as needed
};

/// Reads a lens: one that ships, by its name in any case, or else a file: our JSON (.json), pbrt's
/// lens description (.dat) or Zemax's sequential lens (.zmx). catalogs: glasses that go before
/// those of assets/glass. The result fits Lens: one stop, a plane in one medium; at most
/// kMaxSurfaces surfaces and kMaxMedia - 1 glasses. Throws InputError with the line or the JSON
/// path; for a name that is neither, an ArgumentError that lists the names there are.
[[nodiscard]] LensFile load_lens(const std::string& name_or_file,
                                 std::span<const AgfCatalog> catalogs = {});

/// Reads a lens from the text of our JSON; name: of the file, for messages. Throws InputError
/// likewise.
[[nodiscard]] LensFile parse_lens(std::string_view json, const std::string& name);

/// Text of the file of a lens that ships. Throws ArgumentError for another name.
[[nodiscard]] std::string text_of_shipped(const std::string& name);

inline constexpr size_t kMaxSurfaces = 250;

/// Facts of a lens for a list of lenses.
struct LensSummary {
    std::string name, title, patent, grade;
    double focal_length_mm = 0, fnumber = 0, field_half_deg = 0;
    double image_circle_mm = 0;
    int year = 0;  ///< of the design
};

/// The lenses that ship, by name. Throws InputError where the program is not whole.
[[nodiscard]] std::vector<LensSummary> list_lenses();

}  // namespace petzval::io
