// SPDX-License-Identifier: Apache-2.0
// petzval image: pictures compared, shown, put together and cut.
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds the subcommands "image diff", "view", "noise" and "spectrum"; their callbacks do
/// the work and throw InputError, also for pictures further apart than --fail-above allows.
void add_image_commands(CLI::App&);

}  // namespace petzval::apps
