// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/memory.h"

#include <fmt/format.h>
#include <unistd.h>

namespace petzval {

std::optional<std::string> memory_shortage(double needed_bytes) {
    const double there =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    if (needed_bytes <= there) return std::nullopt;
    return fmt::format("needs {:.1f} GiB of memory, this machine has {:.1f}",
                       needed_bytes * 0x1p-30, there * 0x1p-30);
}

}  // namespace petzval
