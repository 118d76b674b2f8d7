// SPDX-License-Identifier: Apache-2.0
// Measured metals: complex index of refraction by wavelength.
#pragma once

#include <string>

#include "core/spectrum/spectrum_table.h"

namespace petzval {

/// Complex index of refraction n + ik, relative to air.
struct Metal {
    std::string name;
    SpectrumTable n, k;
};

}  // namespace petzval
