// SPDX-License-Identifier: Apache-2.0
// petzval resume.
#pragma once

#include <string>
#include <vector>

#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval {

/// Declares the command that goes on with a render from its state.
void add_resume_command(CLI::App&, Session&);
/// Words that say how a command talks: of a resumed render, those of its state too.
[[nodiscard]] std::vector<std::string> words_of_console(const std::vector<std::string>& words);

}  // namespace petzval
