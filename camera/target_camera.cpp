// SPDX-License-Identifier: Apache-2.0
#include "camera/target_camera.h"

#include <algorithm>

namespace petzval::camera {

void TargetCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                              std::span<CameraSample> out) const {
    std::array<const TargetCell*, kMostFilmPoints> of_points{};
    bool any = false;
    for (size_t i = 0; targets_ && i < points.size(); ++i) {
        const TargetCell& cell = targets_->at(points[i].film);
        if (cell.empty() || !points[i].pixel.filter) continue;
        of_points[i] = &cell;
        any = true;
    }
    const CellsOfPoints cells(of_points.data(), points.size());
    sample_beside(points, bands, cells, out);
    if (!any) return;
    std::array<CameraSample, kMostFilmPoints> to_targets;
    sample_targets(points, bands, cells, {to_targets.data(), points.size()});
    for (size_t i = 0; i < points.size(); ++i)
        for (CameraPath& path : to_targets[i]) {
            path.to_target = true;
            out[i].add() = path;
        }
}

}  // namespace petzval::camera
