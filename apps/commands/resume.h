// SPDX-License-Identifier: Apache-2.0
// petzval resume.
#pragma once

#include <string>
#include <vector>

#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval::apps {

/// Declares the command that goes on with a render from its state.
void add_resume_command(CLI::App&, Session&);
/// How a command talks: as its words ask, and a resumed render as its state asks besides.
[[nodiscard]] ConsoleWish console_wish_of(const std::vector<std::string>& words);

}  // namespace petzval::apps
