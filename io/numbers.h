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

}  // namespace petzval
