// SPDX-License-Identifier: Apache-2.0
// petzval image view.
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Declares the command that shows a linear picture on a display.
void add_view(CLI::App& image);

}  // namespace petzval::apps
