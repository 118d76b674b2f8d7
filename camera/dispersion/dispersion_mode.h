// SPDX-License-Identifier: Apache-2.0
// Dispersion mode: how a camera carries wavelengths that its lens sends different ways.
#pragma once

#include <cstdint>

#include "core/math/lanes.h"
#include "core/spectrum/bands.h"

namespace petzval::camera {

/// Shared: the ray of line d, as if the lens were achromatic. Split: one ray for each lane. Hero:
/// the ray of one lane, weighed for each lane by where it would have reached the film (hero.h).
enum class DispersionMode : uint8_t { Shared, Split, Hero };

/// Whether all lanes go along the ray of line d.
[[nodiscard]] inline bool one_ray(const Bands& bands, DispersionMode mode) {
    return !bands.spectral || mode == DispersionMode::Shared;
}

[[nodiscard]] inline m4 only_lane(int lane) {
    m4 on{};
    on[lane] = -1;
    return on;
}

}  // namespace petzval::camera
