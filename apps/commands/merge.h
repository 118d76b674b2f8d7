// SPDX-License-Identifier: Apache-2.0
// petzval merge.
#pragma once

#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval::apps {

/// Declares the command that adds states and writes their picture.
void add_merge_command(CLI::App&, Session&);

}  // namespace petzval::apps
