// SPDX-License-Identifier: Apache-2.0
// Film places where the light of a thing lands, circle of confusion included.
#pragma once

#include <span>
#include <vector>

#include "camera/ray_bundle.h"
#include "core/film/film.h"
#include "core/light/small_features.h"

namespace petzval::camera {

/// Disjoint rectangles of a frame, pixels.
struct FilmRegion {
    std::vector<Rect> rects;

    [[nodiscard]] int64_t area_px() const;
    [[nodiscard]] bool contains(int x, int y) const;
    /// Pixel number i of the region, row by row within each rectangle; i < area_px().
    [[nodiscard]] std::array<int, 2> pixel(int64_t i) const;
};

/// Whether rays of the bundle's rectangle pass a thing, as seen in the plane through it across
/// their mean direction. What the rays span is enlarged by this share on each side: those between
/// and beyond them, through the rim of the iris, pass outside.
[[nodiscard]] bool passes(const RayBundle&, const SmallFeature&, float margin = 0.6f);

/// For each thing, the region of the frame whose camera rays pass it, as coarse as a few dozen
/// rectangles; empty where none does. What stands between, mirrors and glass are not regarded. Rays
/// are sampled: margins make up for what lies between them. Cameras are asked in RGB.
[[nodiscard]] std::vector<FilmRegion> film_regions(const Camera&, V2i size_px,
                                                   std::span<const SmallFeature>);

}  // namespace petzval::camera
