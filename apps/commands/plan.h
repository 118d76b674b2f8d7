// SPDX-License-Identifier: Apache-2.0
// petzval plan
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds the subcommand; its callback prints to stdout how a scene is best rendered.
void add_plan_command(CLI::App&);

}  // namespace petzval::apps
