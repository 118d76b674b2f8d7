// SPDX-License-Identifier: Apache-2.0
// petzval image noise.
#pragma once

namespace CLI {
class App;
}

namespace petzval::apps {

/// Declares the command that prints the noise that a picture states of itself, by region.
void add_noise(CLI::App& image);

}  // namespace petzval::apps
