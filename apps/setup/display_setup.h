// SPDX-License-Identifier: Apache-2.0
// How PNG and JPEG show a picture: a view of an OpenColorIO configuration.
#pragma once

#include <string>
#include <vector>

#include "apps/request/render_request.h"
#include "io/file/overwrite.h"

namespace petzval::apps {

/// Settles the configuration: without one that is asked for it is that which the environment
/// variable OCIO names. Returns what to tell about it, or nothing. Throws ValueError, also where
/// the configuration does not have the view.
[[nodiscard]] std::string resolve_display(DisplayRequest&);

/// Files of the configuration that is asked for, or that $OCIO names whether or not it is used:
/// none of them may be written.
[[nodiscard]] std::vector<io::NamedFile> input_files(const DisplayRequest&);

}  // namespace petzval::apps
