// SPDX-License-Identifier: Apache-2.0
// Hero ray: one ray for all lanes of a lens that disperses, without a bias.
#pragma once

#include "camera/camera.h"

namespace petzval {

/// Shares of the lanes in a ray that was drawn for one of them. A ray of the scene reaches the film
/// at a place of its own in each lane, and the pixel's filter says what it counts there; the
/// measure of rays is the same on both sides of the lens (conservation of etendue). So the ray
/// could have been drawn for each lane, with a density in proportion to its filter's value, and
/// lane i weighs value_i over the mean of all values times the weight that the drawn lane has by
/// itself (balance heuristic: Veach 1997, 9.2.3; for wavelengths, Wilkie et al. 2014, "Hero
/// Wavelength Spectral Sampling", equation 12). The shares add up to the number of lanes that are
/// on, so that no weight is larger than that. dx_px, dy_px: from the drawn point to where the lane
/// reaches the film, pixels, y down. open: [0, 1], the lane's share that iris and rims let through;
/// as iris points are drawn in proportion to it, it is a part of the density.
[[nodiscard]] inline f4 hero_shares(const PixelFilter& pixel, f4 dx_px, f4 dy_px, m4 on, f4 open) {
    f4 value{};
    for (int i = 0; i < 4; ++i)
        if (on[i] && open[i] > 0)
            value[i] = open[i] * pixel.filter->value(pixel.offset_px + V2f(dx_px[i], dy_px[i]));
    const float sum = hsum(value);
    return sum > 0 ? value * (static_cast<float>(lane_count(on)) / sum) : f4{};
}

}  // namespace petzval
