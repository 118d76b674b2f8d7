// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "core/math.h"

namespace petzval {

/// "x,y,z", as options take it: as few digits as give the same floats when they are read again.
[[nodiscard]] inline std::string with_commas(const V3f& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

}  // namespace petzval
