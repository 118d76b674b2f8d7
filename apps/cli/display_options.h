// SPDX-License-Identifier: Apache-2.0
// How PNG and JPEG show a picture: a view of an OpenColorIO configuration.
#pragma once

#include <string>
#include <vector>

#include "io/image/output.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace petzval {

/// Declares --view and --ocio; they write to the struct, which must outlive the parsing. Returns
/// them.
std::vector<CLI::Option*> add_display_options(CLI::App&, DisplayOptions&);

/// Settles configuration and view: without --ocio the one that the environment variable OCIO names
/// is taken. Returns what to tell about it, or nothing. Throws CLI::ValidationError.
[[nodiscard]] std::string resolve_display(DisplayOptions&);

}  // namespace petzval
