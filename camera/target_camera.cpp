// SPDX-License-Identifier: Apache-2.0
#include "camera/target_camera.h"

#include <algorithm>

namespace petzval {

void TargetCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                              std::span<CameraSample> out) const {
    std::array<TargetList, kMostFilmPoints> lists_of_all;
    const std::span lists(lists_of_all.data(), points.size());
    if (targets_)
        for (size_t i = 0; i < points.size(); ++i) lists[i] = targets_->at(points[i].film);
    sample_beside(points, bands, lists, out);
    if (std::all_of(lists.begin(), lists.end(), [](TargetList list) { return list.empty(); }))
        return;
    std::array<CameraSample, kMostFilmPoints> to_targets;
    sample_targets(points, bands, lists, {to_targets.data(), points.size()});
    for (size_t i = 0; i < points.size(); ++i)
        for (CameraPath& path : to_targets[i]) {
            path.to_target = true;
            out[i].add() = path;
        }
}

}  // namespace petzval
