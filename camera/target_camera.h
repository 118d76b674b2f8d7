// SPDX-License-Identifier: Apache-2.0
// A camera that sends rays to targets, beside those that it has anyway.
#pragma once

#include <memory>
#include <optional>

#include "camera/camera.h"
#include "camera/target.h"

namespace petzval::camera {

/// The middle of the pixel of a film point, as FilmPoint has it.
[[nodiscard]] inline V2f middle_of_pixel(const FilmPoint& point) {
    return point.film - point.pixel.offset_px / point.pixel.frame_px;
}

/// Rays of another camera and, together with them, rays to targets: an estimate without a bias, by
/// the shares of both (balance heuristic, Veach and Guibas 1995).
class TargetCamera : public Camera {
  public:
    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const final {
        return one_of_all(point, bands);
    }
    /// Rays of the other camera, then those to targets.
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const final;

    /// Targets from here on, made ready by this camera; nullptr: none.
    void set_targets(std::shared_ptr<const TargetGrid> targets) { targets_ = std::move(targets); }
    [[nodiscard]] const std::shared_ptr<const TargetGrid>& targets() const { return targets_; }

    /// Map of the rays of a cell; nullptr where they are too few.
    [[nodiscard]] virtual std::shared_ptr<const StopMap> map(const FilmCell&) const = 0;
    /// A target made ready for the film points of a cell, in a frame of so many pixels; nothing
    /// where none of their rays passes it.
    [[nodiscard]] virtual std::optional<ListedTarget> listed(const Target&, const StopMap&,
                                                             V2i frame_px) const = 0;
    /// Rays of the other camera, weighed beside those to the targets of each film point, which has
    /// a pixel filter where it has a cell.
    virtual void sample_beside(std::span<const FilmPoint>, std::span<const Bands>, CellsOfPoints,
                               std::span<CameraSample>) const = 0;
    /// Rays of film points to one of the targets of each. None for a film point that has no
    /// targets, or where the ray is blocked.
    virtual void sample_targets(std::span<const FilmPoint>, std::span<const Bands>, CellsOfPoints,
                                std::span<CameraSample>) const = 0;

  private:
    std::shared_ptr<const TargetGrid> targets_;
};

}  // namespace petzval::camera
