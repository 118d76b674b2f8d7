// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/more_rays.h"

#include <array>

namespace petzval {

void find_target_rays(const Camera& camera, std::span<const FilmPoint> points,
                      std::span<const Bands> bands, std::span<CameraSample> out) {
    std::array<TargetList, kMostFilmPoints> lists;
    bool any = false;
    for (size_t i = 0; i < points.size(); ++i) {
        lists[i] = camera.targets()->at(points[i].film);
        out[i] = {};
        any = any || !lists[i].empty();
    }
    if (any) camera.sample_targets(points, bands, {lists.data(), points.size()}, out);
}

void move_rays(const Shutter& shutter, std::span<const FilmPoint> points,
               std::span<CameraSample> ordinary, std::span<CameraSample> to_targets) {
    for (size_t i = 0; i < points.size(); ++i) {
        const float time = shutter.time(points[i].sampler.get1(Dim::Time));
        const auto move = [&](CameraSample& sample) {
            for (CameraPath& path : sample) {
                path.ray.time = time;
                shutter.move(path.ray);
            }
        };
        move(ordinary[i]);
        if (!to_targets.empty()) move(to_targets[i]);
    }
}

}  // namespace petzval
