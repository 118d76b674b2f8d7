// SPDX-License-Identifier: Apache-2.0
// Sky: light from infinitely far, an equirectangular picture or one colour, and its importance
// sampling.
#pragma once

#include <array>
#include <vector>

#include "core/math/math.h"
#include "core/sampling/distribution.h"
#include "core/scene/texel_block.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// Radiance by world-space direction. u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi from the top,
/// before the rotation about +y (counter-clockwise seen from above). Lookups are bilinear between
/// texel centres, around in u, clamped in v. Directions are drawn in proportion to what of that is
/// above the mean.
class Sky {
  public:
    /// A black sky.
    Sky() = default;
    /// A sky of the same radiance, in nits, from everywhere.
    static Sky uniform(Rgb radiance);
    /// A sky from RGB texels in nits, row 0 at the zenith; strength multiplies them. Texels must be
    /// finite and not negative; width and height at least 1. They are kept as half floats beside a
    /// common power of two for each eight (core/scene/texel_block.h).
    static Sky picture(std::vector<float> rgb, int width, int height, float rotate_deg,
                       float strength);

    [[nodiscard]] bool black() const { return average_ <= 0.f; }
    /// Mean luminance over the sphere, nits.
    [[nodiscard]] float average_luminance() const { return average_; }
    /// Radiance hardly varies over the sky: nothing is worth drawing.
    [[nodiscard]] bool even() const { return drawn_ <= 0.f; }
    /// Whether a radiance of this sky is a light of its own: at least 16 times the mean.
    [[nodiscard]] bool is_sun(const Rgb& radiance) const {
        return luminance(radiance) >= 16 * average_;
    }
    /// Mean over the sphere of the luminance above the mean, nits: of what `sample` draws.
    [[nodiscard]] float drawn_luminance() const { return drawn_; }

    /// Position on the picture.
    struct Place {
        V2f texel;   ///< [0, width] x [0, height]
        float sine;  ///< of the polar angle
    };
    struct Draw {
        V3f direction;  ///< unit
        Place place;
    };
    /// Draws a direction: a texel in proportion to its light above the mean, then a distance from
    /// its centre in proportion to the texel's part in a lookup. A sum of such tents is what
    /// lookups find, so that density follows radiance within texels too. The sky must not be even.
    /// Prefetches what find(place) reads.
    [[nodiscard]] Draw sample(V2f u) const;

    /// Radiance and density in a direction.
    struct Found {
        Rgb radiance;
        float pdf;  ///< density of `sample` there, 1/sr; 0 where none are drawn
    };
    [[nodiscard]] Found find(const Place&) const;
    [[nodiscard]] Found find(const V3f& direction) const;
    [[nodiscard]] Rgb radiance(const V3f& direction) const;
    [[nodiscard]] float pdf(const V3f& direction) const { return find(direction).pdf; }

  private:
    /// The four texels of a lookup, and its weights.
    struct Corners {
        std::array<int, 2> column, row;
        V2f weight;  ///< of the second column and the second row
    };
    void fill_importance();
    [[nodiscard]] Place place_of(const V3f& direction) const;
    [[nodiscard]] Corners corners_of(V2f texel) const;
    [[nodiscard]] const TexelBlock* blocks_of(int y) const {
        return &blocks_[static_cast<size_t>(y) * blocks_across_];
    }
    [[nodiscard]] Rgb radiance_at(const Corners&) const;
    [[nodiscard]] float density_at(const Corners&) const;

    Rgb colour_{0.f};
    float average_ = 0.f, drawn_ = 0.f;
    int width_ = 0, height_ = 0;  ///< 0: uniform
    int blocks_across_ = 0;
    std::vector<TexelBlock> blocks_;  ///< row by row
    Piecewise2D importance_;          ///< of the blocks
    std::vector<float> row_density_;  ///< of a unit of the row, per steradian times the sine
    float turn_ = 0.f;                ///< rotation in turns
};

}  // namespace petzval
