// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP: perceived difference between two pictures when one flips between them (Andersson,
// Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: A Difference Evaluator for
// Alternating Images", Proceedings of the ACM on Computer Graphics 3(2), article 15).
#pragma once

#include <vector>

#include "core/math/math.h"
#include "io/picture/picture.h"

namespace petzval::io {

/// Pixels per degree of a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m: the paper's choice.
inline constexpr double kFlipPixelsPerDegree = 67;

/// FLIP of pictures against a reference. Pictures are scene-linear with channels R, G and B; they
/// are shown as sRGB shows them: times 2^exposure_ev, cut to [0, 1]. Beyond its edge a picture
/// repeats its last pixels.
class Flip {
  public:
    /// Prepares the reference. Throws std::invalid_argument where the picture has no R, G and B or
    /// no pixel, or where pixels_per_degree is not positive.
    explicit Flip(const Picture& reference, float exposure_ev = 0,
                  double pixels_per_degree = kFlipPixelsPerDegree);

    /// Error of each pixel, [0, 1], row by row. Throws std::invalid_argument where the size is not
    /// the reference's.
    [[nodiscard]] std::vector<float> map(const Picture& test) const;
    /// Mean of map().
    [[nodiscard]] double mean(const Picture& test) const;

  private:
    struct Plane {
        std::vector<float> v;  ///< width x height
    };
    /// Perceived picture: its colours, edges and points.
    struct Seen {
        std::vector<V3f> lab;  ///< after the contrast sensitivity and the Hunt effect
        std::vector<float> edge, point;
    };
    [[nodiscard]] Seen see(const Picture&) const;
    [[nodiscard]] Plane convolve(const Plane&, const std::vector<double>& across,
                                 const std::vector<double>& down) const;
    [[nodiscard]] Plane contrast_filtered(const Plane&, size_t channel) const;

    int width_, height_;
    float scale_;
    double pixels_per_degree_;
    Seen reference_;
};

}  // namespace petzval::io
