// SPDX-License-Identifier: Apache-2.0
// Lateral dispersion of a lens in pixels.
#pragma once

#include "camera/camera.h"
#include "camera/setup/focus_plane.h"
#include "core/spectrum/observer.h"

namespace petzval::camera {

/// RMS lateral dispersion in pixels: over film, iris and the wavelengths that the observer draws,
/// the root of the mean square of how far a wavelength's ray meets the plane of focus from line
/// d's. Two cameras of one lens: dispersion split, and shared. 0 where no ray comes through.
[[nodiscard]] double lateral_dispersion_px(const Camera& split, const Camera& shared,
                                           const Observer&, const FocusPlane&, V2i size_px);

}  // namespace petzval::camera
