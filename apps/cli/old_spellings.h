// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Words of a command line with today's names of options, and which of them were typed otherwise.
struct Spelling {
    std::vector<std::string> words;                            ///< without the program's name
    std::vector<std::pair<std::string, std::string>> renamed;  ///< as typed, and today
};

/// The arguments of the command line with today's names in place of those that options had until
/// November 2026: --chroma, --march, --spectral hero, --axis chroma. They stay for one
/// release and are not in --help.
[[nodiscard]] Spelling with_current_spellings(int argc, const char* const* argv);

}  // namespace petzval
