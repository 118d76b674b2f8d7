// SPDX-License-Identifier: Apache-2.0
// A camera that takes its picture in a span of time.
#pragma once

#include <memory>
#include <utility>

#include "camera/camera.h"
#include "camera/shutter.h"

namespace petzval::camera {

/// Rays of another camera, each at a time that a shutter draws, from where the camera stands then.
class MovingCamera final : public Camera {
  public:
    MovingCamera(std::shared_ptr<const Camera> still, std::shared_ptr<const Shutter> shutter)
        : still_(std::move(still)), shutter_(std::move(shutter)) {}
    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        return one_of_all(point, bands);
    }
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const override;

  private:
    std::shared_ptr<const Camera> still_;
    std::shared_ptr<const Shutter> shutter_;
};

}  // namespace petzval::camera
