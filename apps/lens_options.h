// SPDX-License-Identifier: Apache-2.0
// The options of petzval render that are about the glass in front of the film.
#pragma once

#include "io/lens_setup.h"

namespace CLI {
class App;
}

namespace petzval {

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_lens_options(CLI::App&, LensCameraRequest&);

}  // namespace petzval
