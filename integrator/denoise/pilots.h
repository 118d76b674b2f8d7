// SPDX-License-Identifier: Apache-2.0
// Pilot estimates: pictures of each half that leave little noise. They are not shown: the second
// estimate takes from them which pixels are alike.
#pragma once

#include <array>
#include <vector>

#include "core/film/film.h"
#include "core/film/grown.h"
#include "integrator/denoise/shrinkage.h"

namespace petzval::integrator {

/// How far away pilot estimates are looked at: a window, and patches about its pixels.
inline constexpr int kPilotReach_px = 8;

struct Pilots {
    Rect pixels;                                     ///< row by row
    std::array<std::vector<V3f>, kHalves> colour;    ///< nits
    std::array<std::vector<V3f>, kHalves> variance;  ///< of colour, nits^2
    /// Standard errors of R, G and B of the first estimates, their sum, nits.
    std::array<std::vector<float>, kHalves> first_deviation;

    /// Black ones for estimates; none where there is no second estimate.
    Pilots(const Film& film, const HalfEstimates& of)
        : pixels(grown(of.pixels, of.can_choose ? kPilotReach_px : 0, film.pixels())) {
        if (!of.can_choose) return;
        const auto count = static_cast<size_t>(pixels.width()) * size_t(pixels.height());
        for (size_t half = 0; half < kHalves; ++half) {
            colour[half].resize(count, V3f(0));
            variance[half].resize(count, V3f(0));
            first_deviation[half].resize(count);
        }
    }
    [[nodiscard]] size_t offset(int x, int y) const {
        return static_cast<size_t>(y - pixels.y0) * size_t(pixels.width()) + size_t(x - pixels.x0);
    }
};

}  // namespace petzval::integrator
