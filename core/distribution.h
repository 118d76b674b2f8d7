// SPDX-License-Identifier: Apache-2.0
// Piecewise-constant densities that can be sampled; both keep the stratification of their input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace petzval {

/// Density over [0, 1) in equal cells. Inversion by a guide table (Chen and Asau 1974), so that a
/// draw costs the same for a thousand cells and for a million.
class Piecewise1D {
  public:
    Piecewise1D() = default;
    /// Weights must be finite and not negative, with at least one above 0.
    explicit Piecewise1D(std::span<const float> weights);

    struct Draw {
        uint32_t cell;
        float offset;       ///< position within the cell, [0, 1): may be used again
        float probability;  ///< of the cell
    };
    [[nodiscard]] Draw sample(float u) const;
    [[nodiscard]] float probability(uint32_t cell) const { return cdf_[cell + 1] - cdf_[cell]; }
    [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(cdf_.size()) - 1; }
    [[nodiscard]] double sum() const { return sum_; }  ///< of the weights

  private:
    std::vector<float> cdf_;       ///< size + 1 values from 0 to 1
    std::vector<uint32_t> guide_;  ///< first cell that a u of k/size can fall in
    double sum_ = 0;
};

/// Density over [0, 1)^2 in width x height cells, row by row.
class Piecewise2D {
  public:
    Piecewise2D() = default;
    Piecewise2D(std::span<const float> weights, uint32_t width, uint32_t height);

    struct Draw {
        V2f point;
        float pdf;
    };
    [[nodiscard]] Draw sample(V2f u) const;
    [[nodiscard]] float pdf(V2f point) const;

  private:
    std::vector<Piecewise1D> rows_;  ///< a row without weight has no cells and is never drawn
    Piecewise1D marginal_;
};

}  // namespace petzval
