// SPDX-License-Identifier: Apache-2.0
// The glass catalogue in assets/glass.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/spectrum/glass.h"

namespace petzval {

/// Glass called "maker:NAME", as "schott:N-SF11"; case does not matter. Nothing where there is
/// none. Reads the catalogue, 1 to 2 ms. Throws InputError where the program is not whole, as all
/// of these do.
[[nodiscard]] std::optional<Glass> find_glass(const std::string& maker_and_name);

/// All glasses of the catalogue, in the order of the file. Takes a few ms.
[[nodiscard]] std::vector<Glass> glass_catalog();

/// Up to five "maker:NAME" of the catalogue that look most like a text, the nearest first. The
/// maker may be missing or wrong.
[[nodiscard]] std::vector<std::string> glasses_near(const std::string& text);

}  // namespace petzval
