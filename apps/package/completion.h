// SPDX-License-Identifier: Apache-2.0
// Completions for shells from the table that --help prints.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace petzval::apps {

/// Script that completes commands, options and file names in bash.
[[nodiscard]] std::string bash_completion(const CLI::App&);
/// The same for zsh, which shows what each of them is.
[[nodiscard]] std::string zsh_completion(const CLI::App&);

}  // namespace petzval::apps
