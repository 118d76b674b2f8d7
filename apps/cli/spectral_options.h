// SPDX-License-Identifier: Apache-2.0
// Wavelength options of petzval render.
#pragma once

#include <string>

#include "apps/setup/spectral_setup.h"

namespace CLI {
class App;
}

namespace petzval {

struct SpectralOptions {
    SpectralRequest request;
    std::string bins;  ///< as given; becomes request.bins in resolve()
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_spectral_options(CLI::App&, SpectralOptions&);

/// Reads the options that depend on each other. Throws CLI::ValidationError.
void resolve(SpectralOptions&);

}  // namespace petzval
