// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/base/machine.h"

namespace petzval::apps {

/// "needs 12.3 GiB of memory, and 7.8 can be had", where that is so. Memory is promised before it
/// is there, so that asking for too much would kill instead of fail.
[[nodiscard]] std::optional<std::string> memory_shortage(
    double needed_bytes, uint64_t there_bytes = io::usable_memory_bytes());

}  // namespace petzval::apps
