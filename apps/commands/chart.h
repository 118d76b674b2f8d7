// SPDX-License-Identifier: Apache-2.0
// petzval chart
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

struct Session;

/// Adds the subcommand; its callback measures. the session's exit code tells how it
/// ended.
void add_chart_command(CLI::App&, Session&);

}  // namespace petzval::apps
