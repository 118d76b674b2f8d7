// SPDX-License-Identifier: Apache-2.0
// Regions of the stop, and of the film, corrected by rays that are traced through the lens itself.
#pragma once

#include <optional>
#include <span>

#include "camera/targets/stop_camera.h"
#include "camera/targets/stop_region.h"

namespace petzval::camera {

/// A target as a film point sees it at a wavelength.
struct TargetView {
    const StopMap* map;
    const ListedTarget* target;
    V2f film;
    float nm;
};

/// Landings on targets of rays through points of the stop, in radii: by the lens itself, up to
/// eight at once. Nothing where no ray leads there.
void trace_landings(const StopCamera&, std::span<const TargetView>, std::span<const V2f> stop_mm,
                    std::span<std::optional<V2f>>);

/// Region of the stop for a film point.
struct StopSearch {
    TargetView view;
    StopRegion region;

    StopSearch(const TargetView& seen, const StopMap::Rays& rays)
        : view(seen), region(*view.map, rays, *view.target) {}
};
/// Puts the ellipses of regions where the lens itself has them.
void correct(const StopCamera&, std::span<StopSearch>);

/// Places within a pixel from which the ray through a point of the stop passes a target: an
/// ellipse, in pixels from its middle.
class FilmEllipse {
  public:
    /// The view is that of the pixel's middle; landing: that of its ray through the point.
    FilmEllipse(const TargetView&, V2f frame_px, V2f stop_mm, V2f landing);

    [[nodiscard]] V2f sample(V2f u) const;
    [[nodiscard]] float density_per_px2(V2f offset_px) const;

  private:
    FilmMotion motion_;  ///< for a pixel
    V2f landing_;
};

}  // namespace petzval::camera
