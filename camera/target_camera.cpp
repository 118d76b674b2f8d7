// SPDX-License-Identifier: Apache-2.0
#include "camera/target_camera.h"

#include <algorithm>

namespace petzval::camera {

void TargetCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                              std::span<CameraSample> out) const {
    std::array<const TargetCell*, kMostFilmPoints> of_points{};
    bool any = false;
    for (size_t i = 0; targets_ && i < points.size(); ++i) {
        // By its pixel: a ray to a target may have another film point, and must have the same list.
        const TargetCell& cell = targets_->at(middle_of_pixel(points[i]));
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
