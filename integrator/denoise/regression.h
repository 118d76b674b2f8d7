// SPDX-License-Identifier: Apache-2.0
// First-order regression about the pixels of a tile (Bitterli, Rousselle, Moon et al. 2016,
// "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings").
#pragma once

#include <array>
#include <span>

#include "core/math/lanes.h"
#include "integrator/denoise/window_weights.h"

namespace petzval::integrator {

/// How a regression takes the weights of a window.
struct WeightsAs {
    bool fourth_root;  ///< e^-a as e^-a/4, which is four times k^2
    float least;       ///< smaller ones are left out
};

struct ColourEstimate {
    std::array<f8, 3> mean;
    std::array<f8, 3> variance;  ///< of mean, as far as the pixels' variances tell
};

/// Regressors of a pixel of the window: 1, differences of the guides, and its place.
inline constexpr size_t kRegressors = 1 + kGuideNumbers + 2;
using Regressors = std::array<f8, kRegressors>;

/// Linear regression about eight pixels. The estimate of a pixel is the regression's value there: a
/// sum over its window, of which the shares are solved for.
class Regression {
  public:
    /// x, y: the first of the eight, by its place in the tile.
    Regression(const HalfTile&, const WindowWeights&, WeightsAs, int x, int y);
    /// The estimates of R, G and B, nits, and their variances.
    [[nodiscard]] ColourEstimate colour() const;
    /// Writes the estimates of planes, such as bins, each a sum of the window's values by the same
    /// shares as the colour. Shares below 0 are left out: no estimate lies beyond the window's
    /// values, none is negative.
    void estimate(std::span<const HalfTile::Plane> planes, f8* out) const;

  private:
    /// Calls use(weight, regressors, index) for the pixels of the window that have a weight.
    template <class Use>
    void each_pixel(const Use& use) const;
    /// Calls use(share, index) for the pixels of the window. Returns the sum of the shares.
    template <class Use>
    f8 each_share(const Use& use) const;
    void add_up();
    void solve();

    const HalfTile& half_;
    const WindowWeights& weights_;
    WeightsAs as_;
    int x_, y_, centre_;
    std::array<f8, kGuideNumbers> own_;
    std::array<Regressors, kRegressors> matrix_{};  ///< lower half; then its Cholesky factor
    Regressors shares_;
};

}  // namespace petzval::integrator
