// SPDX-License-Identifier: Apache-2.0
// Cores and memory that this process may use: affinity, control groups and resource limits.
#pragma once

#include <cstdint>
#include <filesystem>

namespace petzval::io {

/// Number of threads that can run at once: the processors of the affinity mask, and no more than
/// the CPU quota of the control groups (versions 1 and 2), rounded up. At least 1. root: folder in
/// which proc lies, and the mount points that it names.
[[nodiscard]] int usable_threads(const std::filesystem::path& root = "/");

/// Bytes of memory that can be had: the least of the machine's, the limits of the control groups,
/// and the limit on the address space.
[[nodiscard]] uint64_t usable_memory_bytes(const std::filesystem::path& root = "/");

}  // namespace petzval::io
