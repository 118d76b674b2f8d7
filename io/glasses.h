// SPDX-License-Identifier: Apache-2.0
// The glass catalogue in assets/glass.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/dispersion.h"

namespace petzval {

/// "maker:NAME", as "schott:N-SF11"; case does not matter. Nothing where there is none.
[[nodiscard]] std::optional<Glass> find_glass(const std::string& maker_and_name);

/// Up to five "maker:NAME" of the catalogue that look most like a text, the nearest first.
[[nodiscard]] std::vector<std::string> glasses_near(const std::string& text);

}  // namespace petzval
