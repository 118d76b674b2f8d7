// SPDX-License-Identifier: Apache-2.0
// What the pixels about a pixel say of the ways from its samples to what is estimated of them.
#pragma once

#include <array>
#include <vector>

#include "core/film/film.h"
#include "integrator/denoise/shrinkage.h"

namespace petzval::integrator {

/// What tells which parts of both ways leave the least squared error, as sums over pixels: what of
/// the error goes with each way, and the products of the ways.
struct WaySums {
    static constexpr size_t kNumbers = 5;
    std::array<double, kNumbers> numbers{};

    [[nodiscard]] Imath::V2d gain() const { return {numbers[0], numbers[1]}; }
    [[nodiscard]] double first() const { return numbers[2]; }
    [[nodiscard]] double both() const { return numbers[3]; }
    [[nodiscard]] double second() const { return numbers[4]; }
};

/// Numbers of a rectangle of pixels, row by row; T(0) to begin with.
template <class T>
class Pixels {
  public:
    explicit Pixels(const Rect& where)
        : where_(where),
          values_(static_cast<size_t>(where.width()) * static_cast<size_t>(where.height()), T(0)) {}
    [[nodiscard]] const Rect& where() const { return where_; }
    [[nodiscard]] T& operator()(int x, int y) { return values_[index(x, y)]; }
    [[nodiscard]] const T& operator()(int x, int y) const { return values_[index(x, y)]; }

  private:
    [[nodiscard]] size_t index(int x, int y) const {
        return static_cast<size_t>(y - where_.y0) * size_t(where_.width()) + size_t(x - where_.x0);
    }

    Rect where_;
    std::vector<T> values_;
};

/// What pixels add to WaySums, a plane for each number.
using WayPlanes = std::array<Pixels<double>, WaySums::kNumbers>;

/// Sums of the ways about each pixel of a tile of the denoiser; all are 0 where no second estimate
/// counts.
class WaysAbout {
  public:
    /// Looks at estimates up to kShrinkageReach_px away from the tile, as far as the frame goes.
    WaysAbout(const Film&, const HalfEstimates&, const Rect& tile);
    [[nodiscard]] WaySums all(int x, int y) const;
    /// Without the pixel itself.
    [[nodiscard]] WaySums of_others(int x, int y) const;

  private:
    WayPlanes own_, sums_;
};

}  // namespace petzval::integrator
