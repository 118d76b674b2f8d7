// SPDX-License-Identifier: Apache-2.0
// Rays to targets of a camera whose rays have closed forms: its stop is a plane, its pencils thin.
#pragma once

#include <memory>
#include <utility>

#include "camera/target_camera.h"
#include "camera/targets/targeted_stop.h"

namespace petzval {

/// C: ThinLensCamera with an iris, or AberratedLensCamera.
template <class C>
class StopTargetCamera final : public TargetCamera {
  public:
    explicit StopTargetCamera(std::shared_ptr<const C> camera) : camera_(std::move(camera)) {}

    [[nodiscard]] std::optional<PreparedTarget> prepared(const Target& target) const override {
        const LocalTarget local(camera_->pose(), target);
        return PreparedTarget{local, pictured(local.centre, camera_->tan_half())};
    }
    [[nodiscard]] std::optional<ListedTarget> listed(const PreparedTarget& target,
                                                     const FilmCell& cell) const override {
        const FilmPoint at{cell.nearest(target.place)};
        const StopPencils rays = camera_->pencils(at, Bands::rgb());
        return stop(rays).listed(target.target, at.film);
    }
    void sample_beside(std::span<const FilmPoint> points, std::span<const Bands> bands,
                       std::span<const TargetList> targets,
                       std::span<CameraSample> out) const override {
        for (size_t i = 0; i < points.size(); ++i) {
            const V2f stop_mm = camera_->drawn_stop_mm(points[i]);
            out[i] = camera_->through(points[i], stop_mm, bands[i]);
            if (targets[i].empty()) continue;
            const StopPencils rays = camera_->pencils(points[i], bands[i]);
            weigh(out[i], stop(rays).mis_weight(stop_mm, targets[i]));
        }
    }
    void sample_targets(std::span<const FilmPoint> points, std::span<const Bands> bands,
                        std::span<const TargetList> targets,
                        std::span<CameraSample> out) const override {
        for (size_t i = 0; i < points.size(); ++i) {
            out[i] = {};
            if (targets[i].empty()) continue;
            const StopPencils rays = camera_->pencils(points[i], bands[i]);
            const auto found = stop(rays).aim_at_one(points[i], targets[i]);
            if (!found) continue;
            out[i] = camera_->through(points[i], found->stop_mm, bands[i]);
            weigh(out[i], found->mis_weight);
        }
    }

  private:
    [[nodiscard]] TargetedStop stop(const StopPencils& rays) const {
        return {*camera_->iris(), rays.span()};
    }
    static void weigh(CameraSample& sample, float mis_weight) {
        for (CameraPath& path : sample) path.mis_weight = mis_weight;
    }

    std::shared_ptr<const C> camera_;
};

}  // namespace petzval
