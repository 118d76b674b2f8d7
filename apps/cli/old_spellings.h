// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// The arguments of the command line with today's names in place of those that options had until
/// November 2026: --chroma, --chroma-tolerance, --march, --spectral hero, --axis chroma. They stay
/// for one release and are not in --help. Without the program's name.
[[nodiscard]] std::vector<std::string> with_current_spellings(int argc, const char* const* argv);

}  // namespace petzval
