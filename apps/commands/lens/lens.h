// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Adds petzval lens, the optics bench.
void add_lens_commands(CLI::App&);

}  // namespace petzval::apps
