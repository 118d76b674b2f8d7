// SPDX-License-Identifier: Apache-2.0
// How far what a sample sees moves in the picture until the next frame.
#pragma once

#include <memory>

#include "camera/film_projection.h"
#include "camera/shutter.h"
#include "core/film/film.h"
#include "core/scene/scene.h"

namespace petzval::integrator {

/// The scene and its camera one frame later, and how the camera pictures points.
class Velocity {
  public:
    /// All must outlive it. next: the scene a frame later, of the same meshes and instances.
    /// shutter: of this frame, nullptr where nothing moves; next_shutter: of the next one, in which
    /// the camera's places are told against the middle of this frame.
    Velocity(const Scene& scene, const Scene& next, const camera::Camera& finder, V2i size_px,
             std::shared_ptr<const camera::Shutter> shutter,
             std::shared_ptr<const camera::Shutter> next_shutter)
        : scene_(scene),
          next_(next),
          projection_(finder, size_px),
          shutter_(std::move(shutter)),
          next_shutter_(std::move(next_shutter)) {}

    /// Pixels from where the camera pictures a point of a surface to where it pictures that point a
    /// frame later: x to the right, y down; 0 where one of them cannot be told. film_px: where the
    /// sample lies.
    [[nodiscard]] V3f at(const Hit&, const V2f& film_px) const;

  private:
    const Scene& scene_;
    const Scene& next_;
    camera::FilmProjection projection_;
    std::shared_ptr<const camera::Shutter> shutter_, next_shutter_;
};

}  // namespace petzval::integrator
