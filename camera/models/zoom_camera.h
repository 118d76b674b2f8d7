// SPDX-License-Identifier: Apache-2.0
// A camera whose view changes while the shutter is open.
#pragma once

#include <memory>
#include <vector>

#include "camera/camera.h"

namespace petzval::camera {

/// Camera that zooms: it has the rays of other cameras, one for each time step of its shutter, and
/// lies between the two next to a film point's time.
class ZoomCamera final : public Camera {
  public:
    /// at_steps: two at least, evenly from time 0 to 1. Each stands where the others do, and gives
    /// one path for every film point.
    explicit ZoomCamera(std::vector<std::unique_ptr<Camera>> at_steps)
        : at_steps_(std::move(at_steps)) {}
    [[nodiscard]] CameraSample sample(const FilmPoint&, const Bands&) const override;

  private:
    std::vector<std::unique_ptr<Camera>> at_steps_;
};

}  // namespace petzval::camera
