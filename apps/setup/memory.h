// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace petzval {

/// "needs 12.3 GiB of memory, this machine has 7.8", where that is so. Memory is promised before it
/// is there, so that asking for too much would kill instead of fail.
[[nodiscard]] std::optional<std::string> memory_shortage(double needed_bytes);

}  // namespace petzval
