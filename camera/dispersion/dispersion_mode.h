// SPDX-License-Identifier: Apache-2.0
// Dispersion mode: how a camera carries wavelengths that its lens sends different ways.
#pragma once

#include <cstdint>

#include "core/math/lanes.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// Tolerance: one ray for all lanes where they would land within a tolerance, else one for each.
/// Shared: the ray of line d, as if the lens were achromatic. Split: one for each, always. Single:
/// one wavelength a path. Hero: the ray of one lane, weighed for each lane by where it would have
/// reached the film (hero.h).
enum class DispersionMode : uint8_t { Tolerance, Shared, Split, Single, Hero };

/// Whether all lanes go along the ray of line d.
[[nodiscard]] inline bool one_ray(const Bands& bands, DispersionMode mode) {
    return !bands.spectral || mode == DispersionMode::Shared;
}

[[nodiscard]] inline m4 only_lane(int lane) {
    m4 on{};
    on[lane] = -1;
    return on;
}

}  // namespace petzval
