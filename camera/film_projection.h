// SPDX-License-Identifier: Apache-2.0
// From a point of the scene to where a camera pictures it: for layers, not for light.
#pragma once

#include <optional>

#include "camera/camera.h"

namespace petzval::camera {

class FilmProjection {
  public:
    /// finder: a camera with a narrow iris, which must outlive this. size_px: of the full frame.
    FilmProjection(const Camera& finder, V2i size_px) : finder_(finder), size_px_(size_px) {}

    /// Place on the film in pixels, (0, 0) at the top left, where the finder pictures a point;
    /// beyond the frame too, as far as its rays go. guess: a place to begin with. Nothing where no
    /// ray is found that meets the point.
    [[nodiscard]] std::optional<V2d> place_of(const V3d& p, const V2d& guess) const;

  private:
    [[nodiscard]] std::optional<Ray> ray_at(const V2d& px) const;

    const Camera& finder_;
    V2i size_px_;
};

}  // namespace petzval::camera
