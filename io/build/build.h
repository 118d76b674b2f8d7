// SPDX-License-Identifier: Apache-2.0
// Sources, compiler and libraries of this program. Any of them may change pixels.
#pragma once

#include <string>

namespace petzval::io {

/// Facts of the build, one a line: the SHA-256 of the sources, the compiler with its flags, and the
/// libraries. The same for two checkouts in different folders. The C library is
/// the one that the program runs with.
[[nodiscard]] std::string build_description();

/// "petzval 0.2.0 (build 0123456789abcdef)": the number is the FNV-1a hash of build_description().
[[nodiscard]] std::string program_version();

}  // namespace petzval::io
