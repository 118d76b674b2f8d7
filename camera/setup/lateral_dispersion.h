// SPDX-License-Identifier: Apache-2.0
// Lateral dispersion of a lens in pixels, and a camera with that dispersion amplified.
#pragma once

#include <memory>

#include "camera/camera.h"
#include "camera/setup/focus_plane.h"
#include "core/spectrum/observer.h"

namespace petzval {

/// RMS lateral dispersion in pixels: over film, iris and the wavelengths that the observer draws,
/// the root of the mean square of how far a wavelength's ray meets the plane of focus from line
/// d's. Two cameras of one lens: dispersion split, and shared. 0 where no ray comes through.
[[nodiscard]] double lateral_dispersion_px(const Camera& split, const Camera& shared,
                                           const Observer&, const FocusPlane&, V2i size_px);

/// Camera whose rays leave those of line d `factor` times as far as `split`'s do. An error that
/// grows in proportion to the dispersion stands out of the noise by it: an edge of the scene lies
/// between two rays by chance, and the chance grows by the same factor. Both cameras are of one
/// lens; shared: dispersion shared.
[[nodiscard]] std::unique_ptr<Camera> amplified_dispersion(std::unique_ptr<Camera> split,
                                                           std::unique_ptr<Camera> shared,
                                                           float factor);

}  // namespace petzval
