// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

namespace petzval::io {

/// Text "x,y,z" of a V3f or an Rgb, as options take it: with the fewest digits that read back the
/// same.
[[nodiscard]] std::string with_commas(const auto& v) {
    return fmt::format("{},{},{}", v[0], v[1], v[2]);
}

/// Percentage for a person to read: "0.43 %", "62 %".
[[nodiscard]] inline std::string percent(double share) {
    return share < 0.1 ? fmt::format("{:.2g} %", 100 * share)
                       : fmt::format("{:.0f} %", 100 * share);
}

}  // namespace petzval::io
