// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds `petzval live`: a view finder in the browser.
void add_live_command(CLI::App&, Session&);

}  // namespace petzval::apps
