// SPDX-License-Identifier: Apache-2.0
// Hero ray: one ray for all lanes of a lens that disperses, without a bias.
#pragma once

#include "camera/camera.h"
#include "camera/dispersion/lens_point.h"

namespace petzval::camera {

/// Shares of the lanes in a ray that was drawn for one of them. A ray of the scene reaches the film
/// at a place of its own in each lane, and the pixel's filter says what it counts there; the
/// measure of rays is the same on both sides of the lens (conservation of etendue). So the ray
/// could have been drawn for each lane, with a density in proportion to its filter's value and its
/// draw of the stop, and lane i weighs value_i open_i over the mean of value_j drawn_j, times
/// drawn / open of the hero and the weight that the hero has by itself (balance heuristic: Veach
/// 1997, 9.2.3; for wavelengths, Wilkie et al. 2014, "Hero Wavelength Spectral Sampling", equation
/// 12). Where the stop is drawn in proportion to what it lets through, the shares add up to the
/// number of lanes that are on.
[[nodiscard]] inline f4 hero_shares(const PixelFilter& pixel, const FilmLanding& landing, int hero,
                                    m4 on) {
    f4 value{};
    for (int i = 0; i < 4; ++i)
        if (on[i] && landing.open[i] > 0)
            value[i] =
                pixel.filter->value(pixel.offset_px + V2f(landing.dx_px[i], landing.dy_px[i]));
    const float sum = hsum(value * landing.drawn);
    if (!(sum > 0 && landing.open[hero] > 0)) return f4{};
    const float of_hero = landing.drawn[hero] / landing.open[hero];
    return value * landing.open * (static_cast<float>(lane_count(on)) * of_hero / sum);
}

}  // namespace petzval::camera
