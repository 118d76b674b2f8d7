// SPDX-License-Identifier: Apache-2.0
// Glasses by their names, for all files and options that name some.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/spectrum/glass.h"
#include "io/glass/agf.h"

namespace petzval::io {

/// A glass, or why there is none.
struct FoundGlass {
    std::optional<Glass> glass;
    std::string error;  ///< empty, or such as: there is no glass "X"; near are A, B
};

class LensGlasses {
  public:
    /// catalogs: searched before assets/glass; they must outlive this.
    explicit LensGlasses(std::span<const AgfCatalog> catalogs) : catalogs_(catalogs) {}

    /// Glass called "maker:NAME", as "schott:N-SF11", whatever the case. Nothing where there is
    /// none. Throws InputError for a glass of a catalogue that cannot be used.
    [[nodiscard]] std::optional<Glass> find(const std::string& maker_and_name);
    /// The glasses of that name of all makers.
    [[nodiscard]] std::vector<Glass> of_any_maker(const std::string& name);
    /// Glass as people name it: "maker:NAME", or a name that one maker alone has.
    [[nodiscard]] FoundGlass named(const std::string& text);

  private:
    void read_assets();

    std::span<const AgfCatalog> catalogs_;
    std::map<std::string, Glass> assets_;  ///< by maker:name in lower case; empty until needed
};

/// Model glass from nd and the Abbe number, called "ND/VD".
[[nodiscard]] Glass model_glass(double nd, double abbe);
/// A glass without dispersion, called "N".
[[nodiscard]] Glass constant_glass(double n);

}  // namespace petzval::io
