// SPDX-License-Identifier: Apache-2.0
// How far a lens parts wavelengths, and the same lens parting them further.
#pragma once

#include <memory>

#include "apps/setup/render_setup.h"

namespace petzval {

/// Root of the mean square, over film, iris and the wavelengths that are drawn, of how far a
/// wavelength's ray meets the plane of focus from line d's, in pixels there. Two sessions of one
/// lens with wavelengths: dispersion split, and shared. 0 where no ray comes through.
[[nodiscard]] double spread_px(const Session& split, const Session& shared, V2i size_px);

/// Up to here one ray for all wavelengths that is weighed for each of them (DispersionMode::Hero)
/// has less variance for its cost than split ones, in luminance and in colour: docs/lens_camera.md.
inline constexpr double kMostHeroSpread_px = 0.2;

/// A camera whose rays leave those of line d `factor` times as far as `parted`'s do. An error that
/// grows in proportion to how far wavelengths are parted stands out of the noise by it: an edge of
/// the scene lies between two rays by chance, and the chance grows by the same factor. Both cameras
/// are of one lens; shared: dispersion shared.
[[nodiscard]] std::unique_ptr<Camera> parted_further(std::unique_ptr<Camera> parted,
                                                     std::unique_ptr<Camera> shared, float factor);

}  // namespace petzval
