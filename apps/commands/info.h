// SPDX-License-Identifier: Apache-2.0
// petzval info
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds the subcommand; its callback prints to stdout what a glTF file holds.
void add_info_command(CLI::App&);

}  // namespace petzval::apps
