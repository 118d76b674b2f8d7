// SPDX-License-Identifier: Apache-2.0
// What this program was built from. Any of it may change pixels.
#pragma once

#include <string>

namespace petzval {

/// What the program was built from, one fact a line: the SHA-256 of its sources, the compiler with
/// its flags, and its libraries. The same for two checkouts in different folders. The C library is
/// the one that the program runs with.
[[nodiscard]] std::string build_description();

/// "petzval 0.1.0 (build 0123456789abcdef)": the number is the FNV-1a hash of build_description().
[[nodiscard]] std::string program_version();

}  // namespace petzval
