// SPDX-License-Identifier: Apache-2.0
// petzval render
#pragma once

namespace CLI {
class App;
}

namespace petzval {

struct Session;

/// Adds the subcommand; its callback renders. the session's exit code tells how it
/// ended.
void add_render_command(CLI::App&, Session&);

}  // namespace petzval
