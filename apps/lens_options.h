// SPDX-License-Identifier: Apache-2.0
// The options of petzval render that are about the glass in front of the film.
#pragma once

#include <string>

#include "io/lens_setup.h"

namespace CLI {
class App;
}

namespace petzval {

struct LensOptions {
    LensCameraRequest request;  ///< request.lens as given: pinhole, thin, a name or a file
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_lens_options(CLI::App&, LensOptions&);

}  // namespace petzval
