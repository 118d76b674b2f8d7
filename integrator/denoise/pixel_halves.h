// SPDX-License-Identifier: Apache-2.0
// What the halves of a pixel's samples show, and what is estimated of each.
#pragma once

#include <array>

#include "core/film/film.h"
#include "integrator/denoise/shrinkage.h"

namespace petzval::integrator {

/// Two halves of a pixel, and what is estimated of each, nits.
struct PixelHalves {
    Imath::V3d a, b;
    std::array<Imath::V3d, kEstimates> of_a, of_b;

    PixelHalves(const Film& film, const HalfEstimates& estimates, int x, int y)
        : a(film.half(x, y, 0).colour), b(film.half(x, y, 1).colour) {
        const size_t at = estimates.offset(x, y);
        for (size_t e = 0; e < kEstimates; ++e) {
            of_a[e] = Imath::V3d(estimates.colour[0][e][at]);
            of_b[e] = Imath::V3d(estimates.colour[1][e][at]);
        }
    }
    /// What the samples show.
    [[nodiscard]] Imath::V3d samples() const { return (a + b) / 2; }
};

/// Whether both halves of a pixel have samples: one alone knows nothing of its error.
[[nodiscard]] inline bool has_both(const Film& film, int x, int y) {
    return film.half(x, y, 0).count > 0 && film.half(x, y, 1).count > 0;
}

}  // namespace petzval::integrator
