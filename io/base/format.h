// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

namespace petzval {

/// Three numbers of a V3f or an Rgb as options take them: as few digits as give the same when they
/// are read again.
[[nodiscard]] std::string with_commas(const auto& v) {
    return fmt::format("{},{},{}", v[0], v[1], v[2]);
}

/// A share as a person reads it: "0.43 %", "62 %".
[[nodiscard]] inline std::string percent(double share) {
    return share < 0.1 ? fmt::format("{:.2g} %", 100 * share)
                       : fmt::format("{:.0f} %", 100 * share);
}

}  // namespace petzval
