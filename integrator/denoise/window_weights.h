// SPDX-License-Identifier: Apache-2.0
// Weights of the pixels of a window by how alike patches are, in units of their noise.
#pragma once

#include <vector>

#include "core/math/lanes.h"
#include "integrator/denoise/half_tile.h"

namespace petzval::integrator {

/// Radius of the window, whose pixels a pixel is estimated from.
inline constexpr int kWindow_px = 7;

/// What patches are compared by.
struct Compared {
    const std::array<HalfTile::Plane, 3>& colour;
    const std::array<HalfTile::Plane, 3>& variance;  ///< of colour
    const HalfTile::Plane& inside;                   ///< 1, and 0 beyond the frame
    float precision;  ///< k^2 of Rousselle, Knaus and Zwicker (2012): more is more alike
};

/// Weights of the pixels of a window, for all pixels of a tile.
class WindowWeights {
  public:
    explicit WindowWeights(const Compared&);
    /// Of eight pixels of the tile, and the n-th pixel of their windows, row by row.
    [[nodiscard]] f8 of(int n, int x, int y) const {
        return load8(
            &weights_[static_cast<size_t>((n * kDenoiserTile_px + y) * kDenoiserTile_px + x)]);
    }

  private:
    std::vector<float> weights_;
};

}  // namespace petzval::integrator
