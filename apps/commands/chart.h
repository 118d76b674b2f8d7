// SPDX-License-Identifier: Apache-2.0
// petzval chart
#pragma once

namespace CLI {
class App;
}

namespace petzval {

/// Adds the subcommand; its callback measures. exit_code becomes 130 where a signal ended it.
void add_chart_command(CLI::App&, int& exit_code);

}  // namespace petzval
