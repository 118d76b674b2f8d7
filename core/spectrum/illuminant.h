// SPDX-License-Identifier: Apache-2.0
// Illuminants: measured spectra of light, the meaning of an RGB of 1 on a lamp that is not the
// scene's white.
#pragma once

#include <string>

#include "core/spectrum/bands.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval {

struct Illuminant {
    std::string name;
    SpectrumTable per_nit;  ///< W/(m2 sr nm) at 1 nit
    Rgb rgb;                ///< colour of 1 nit, for lanes of RGB; may have negative channels
};

/// Radiance of a source whose white is `illuminant`; the scene's own white for nullptr.
[[nodiscard]] inline f4 uplift_radiance(Rgb c, const Bands& bands, const Illuminant* illuminant) {
    if (!illuminant) return uplift_radiance(c, bands);
    if (!bands.spectral) return uplift_radiance(c * illuminant->rgb, bands);
    return zero_off(bands.on, uplift_reflectance(c, bands) * illuminant->per_nit.at(bands.nm));
}

}  // namespace petzval
