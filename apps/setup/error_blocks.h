// SPDX-License-Identifier: Apache-2.0
// Error of a denoised picture by blocks of its pixels.
#pragma once

#include <vector>

#include "core/film/film.h"

namespace petzval::apps {

/// Error of a picture or of a part of it: the root of the mean, over its pixels and R, G and B, of
/// squared error / (m^2 + floor^2), m being the mean of what is denoised over 7 x 7 pixels. By the
/// pixel's own brightness an error would look too small: light that is there by chance makes both.
struct DenoisedError {
    double squared = 0;    ///< by the two halves, without bias: it may be negative
    double deviation = 0;  ///< standard error of `squared`, wider where few blocks tell it

    /// Bounds of the root with a chance of 95 %.
    [[nodiscard]] double least() const;
    [[nodiscard]] double most() const;
    /// Whether the halves tell no more than that it is at most most().
    [[nodiscard]] bool is_at_most() const { return squared < 2 * deviation; }
    /// The root; most() where that is all that is known.
    [[nodiscard]] double value() const;
};

/// Two-sided 95 % of a normal distribution.
inline constexpr double kDeviations = 1.96;

/// Side of the blocks whose means are taken as independent of each other.
inline constexpr int kErrorBlock_px = 8;

/// Squared errors of a picture, summed over blocks.
class ErrorBlocks {
  public:
    ErrorBlocks() = default;
    ErrorBlocks(int width_px, int height_px);

    [[nodiscard]] int across() const { return across_; }
    [[nodiscard]] int down() const { return down_; }
    /// Adds the squared error of a pixel, the variance of half of its samples in the same units,
    /// and what of the squared error is in doubt.
    void add(int x, int y, double squared_error, double variance, double doubt);
    /// Error over a rectangle of blocks. Its deviation follows from how the blocks part, or is what
    /// it is where noise that is in single pixels is as likely in others about them. What is in
    /// doubt is one more independent deviation, as large as the bounds.
    [[nodiscard]] DenoisedError over(const Rect& blocks) const;

  private:
    int across_ = 0, down_ = 0;
    std::vector<double> sum_, count_, variance_, variance_squares_, doubt_;  ///< row by row
};

}  // namespace petzval::apps
