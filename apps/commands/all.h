// SPDX-License-Identifier: Apache-2.0
// All commands, with what the program says of itself.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/commands/session.h"

namespace petzval::apps {

/// Adds name, version and all commands to an app. The session must outlive it.
void add_all_commands(CLI::App&, Session&);

}  // namespace petzval::apps
