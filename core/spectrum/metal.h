// SPDX-License-Identifier: Apache-2.0
// Measured surfaces: complex index of refraction or reflectance by wavelength.
#pragma once

#include <string>

#include "core/spectrum/bands.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval {

/// Complex index of refraction n + ik, relative to air.
struct Metal {
    std::string name;
    SpectrumTable n, k;
};

/// Share of light that a surface sends back.
struct MeasuredReflectance {
    std::string name;
    SpectrumTable share;  ///< 0 to 1
    Rgb rgb;              ///< its colour under D65, within [0, 1], for lanes of RGB
};

}  // namespace petzval
