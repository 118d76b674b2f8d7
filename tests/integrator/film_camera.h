// SPDX-License-Identifier: Apache-2.0
// A camera for tracers that are functions of the film.
#pragma once

#include "camera/camera.h"

namespace petzval::test {

/// Looks along the film point: x and y of a ray are those of the film.
class FilmCamera final : public camera::Camera {
  public:
    [[nodiscard]] camera::CameraSample sample(const camera::FilmPoint& at,
                                              const Bands& bands) const override {
        camera::CameraSample out;
        camera::CameraPath& path = out.add();
        path.ray.direction = V3f(at.film.x, at.film.y, -1);
        path.weight = uniform(1.f, bands);
        path.lanes = bands.on;
        return out;
    }
};

}  // namespace petzval::test
