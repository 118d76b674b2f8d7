// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/memory.h"

#include <fmt/format.h>

namespace petzval::apps {

std::optional<std::string> memory_shortage(double needed_bytes, uint64_t there_bytes) {
    const auto there = static_cast<double>(there_bytes);
    if (needed_bytes <= there) return std::nullopt;
    if (needed_bytes < 0x1p30)
        return fmt::format("needs {:.1f} MiB of memory, and {:.1f} can be had",
                           needed_bytes * 0x1p-20, there * 0x1p-20);
    return fmt::format("needs {:.1f} GiB of memory, and {:.1f} can be had", needed_bytes * 0x1p-30,
                       there * 0x1p-30);
}

}  // namespace petzval::apps
