// SPDX-License-Identifier: Apache-2.0
// Glass catalogues as makers of glass give them out: AGF, the format of Zemax.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/spectrum/glass.h"

namespace petzval::io {

/// One catalogue. Its glasses are those of a maker whose name is the file's, without the ending.
class AgfCatalog {
  public:
    /// Reads the file. Throws InputError where it cannot be read, is no text or has no glass.
    explicit AgfCatalog(const std::filesystem::path&);
    /// Reads the text of a file of that name. Throws likewise.
    AgfCatalog(std::string_view text, const std::filesystem::path& file);

    [[nodiscard]] const std::string& maker() const { return maker_; }  ///< lower case
    [[nodiscard]] size_t size() const { return entries_.size(); }
    [[nodiscard]] const std::string& name_of(size_t i) const { return entries_[i].name; }

    /// Glass of that name, whatever the case; the result is called "maker:NAME". Nothing where
    /// there is none. Its absorption is that of the lines IT. Throws InputError with its line where
    /// its formula is one that Petzval does not have, or is not whole, or does not give an index
    /// from 1 to 5 from 360 to 830 nm.
    [[nodiscard]] std::optional<Glass> find(const std::string& name) const;

  private:
    struct Entry {
        std::string name;
        int line = 0;
        double formula = 0;
        std::vector<double> coefficients{};  ///< NaN where the file has something else
        double first_um = 0, last_um = 0;
        std::vector<std::array<double, 2>> absorption_per_mm{};
    };
    [[nodiscard]] Glass glass_of(const Entry&) const;

    std::string file_, maker_;
    std::vector<Entry> entries_;
};

/// Absorption, 1/mm, of an internal transmittance of a thickness above 0; one below 1e-6 counts as
/// that.
[[nodiscard]] double absorption_of(double transmittance, double thickness_mm);

/// Whether the index is from 1 to 5 at every nm from 360 to 830.
[[nodiscard]] bool has_index_of_glass(const Glass&);

}  // namespace petzval::io
