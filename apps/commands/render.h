// SPDX-License-Identifier: Apache-2.0
// petzval render
#pragma once

namespace CLI {
class App;
}

namespace petzval {

/// Adds the subcommand; its callback renders. exit_code becomes 130 where a signal ended it.
void add_render_command(CLI::App&, int& exit_code);

}  // namespace petzval
