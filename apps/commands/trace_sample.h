// SPDX-License-Identifier: Apache-2.0
// petzval trace-sample
#pragma once

#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds the subcommand; its callback prints the paths of one sample to stdout.
void add_trace_sample_command(CLI::App&, Session&);

}  // namespace petzval::apps
