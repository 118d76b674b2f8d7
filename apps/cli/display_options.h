// SPDX-License-Identifier: Apache-2.0
// How PNG and JPEG show a picture: a view of an OpenColorIO configuration.
#pragma once

#include <string>
#include <vector>

#include "io/base/overwrite.h"
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

/// Files of the configuration that is asked for, or that $OCIO names whether or not it is used:
/// none of them may be written.
[[nodiscard]] std::vector<NamedFile> input_files(const DisplayOptions&);

}  // namespace petzval
