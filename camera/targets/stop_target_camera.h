// SPDX-License-Identifier: Apache-2.0
// Rays to targets of a camera with a stop.
#pragma once

#include <memory>
#include <vector>

#include "camera/target_camera.h"
#include "camera/targets/stop_camera.h"
#include "camera/targets/stop_search.h"

namespace petzval::camera {

/// A camera that draws points of its stop twice: from the iris, and where rays of the film point
/// pass a target. Some of the latter draw the film point as well, within its pixel. Whatever the
/// regions are that they draw from, the mean stays: a ray has one density of each draw.
class StopTargetCamera final : public TargetCamera {
  public:
    explicit StopTargetCamera(StopCamera camera);

    [[nodiscard]] std::shared_ptr<const StopMap> map(const FilmCell&) const override;
    [[nodiscard]] std::optional<ListedTarget> listed(const Target&, const StopMap&,
                                                     V2i frame_px) const override;
    void sample_beside(std::span<const FilmPoint>, std::span<const Bands>, CellsOfPoints,
                       std::span<CameraSample>) const override;
    void sample_targets(std::span<const FilmPoint>, std::span<const Bands>, CellsOfPoints,
                        std::span<CameraSample>) const override;

  private:
    struct Batch {
        std::span<const FilmPoint> points;
        std::span<const Bands> bands;
        CellsOfPoints cells;
    };
    /// A film point of a batch, perhaps moved within its pixel, the point of the stop, and the
    /// density with which its target drew it, 1/mm^2; -1: not known.
    struct Aimed {
        size_t of;
        FilmPoint point;
        V2f stop_mm;
        const ListedTarget* target;
        float density = -1;
    };
    /// What each film point of a batch sends a ray to, and whether the ray draws a film point.
    struct PickedView : TargetView {
        bool draws_film;
    };
    using PickedViews = std::array<std::optional<PickedView>, kMostFilmPoints>;
    [[nodiscard]] std::optional<PickedView> picked(const Batch&, size_t point, uint32_t ray) const;
    [[nodiscard]] Sampler sampler(const Batch&, size_t point, uint32_t ray) const;
    void aim_at_stop(const Batch&, const PickedViews&, uint32_t ray, std::vector<Aimed>&) const;
    void aim_at_film(const Batch&, const PickedViews&, uint32_t ray, std::vector<Aimed>&) const;
    /// Rays to targets of a sample: one, where the lanes part.
    [[nodiscard]] uint32_t rays_of(const TargetCell&, const FilmPoint&, const Bands&) const;
    void sample(std::span<const FilmPoint>, std::span<const Bands>, CellsOfPoints,
                const StopPoints&, std::span<CameraSample>, std::span<const Aimed> = {}) const;
    /// Density of rays to targets at the crossings of a ray, over that of its film point, in the
    /// unit of CameraSample::density.
    [[nodiscard]] float density_to_targets(const StopCrossings&, const FilmPoint&,
                                           const TargetCell&, const Aimed*) const;
    /// The same of one target: of points of the stop, and with those of the film point.
    [[nodiscard]] float density_of_stop(const TargetView&, const StopMap::Rays&, V2f stop_mm) const;
    [[nodiscard]] float density_of_film(const TargetView&, const FilmPoint&, V2f stop_mm) const;

    StopCamera camera_;
    Pose pose_;
    double iris_mm2_;
};

}  // namespace petzval::camera
