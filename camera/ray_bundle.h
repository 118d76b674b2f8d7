// SPDX-License-Identifier: Apache-2.0
// Rays of a part of the film, to tell what it may see.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "camera/film_cell.h"

namespace petzval::camera {

/// Rays of some film points of a cell.
struct RayBundle {
    std::vector<Ray> rays;
    V3f origin{0.f}, direction{0.f};  ///< means; direction: unit, 0 where there is no ray
    float reach_m = 0;                ///< of the rays' origins from the mean
    float least_cosine = 1;           ///< of the rays' directions with the mean
};

/// A bundle of up to so many rays, in RGB: from the corners of the cell and from points within.
/// They are drawn by the seed for a place of the frame. A picture with that seed draws the same.
[[nodiscard]] RayBundle bundle_of(const Camera&, const FilmCell&, uint32_t seed, V2i drawn_for,
                                  int rays = 16);
/// Whether two cameras, asked in RGB, have the same rays for a few dozen film points, to the bit.
[[nodiscard]] bool has_same_rays(const Camera&, const Camera&);

}  // namespace petzval::camera
