// SPDX-License-Identifier: Apache-2.0
#include "camera/models/moving_camera.h"

#include <algorithm>

namespace petzval::camera {

void MovingCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                              std::span<CameraSample> out) const {
    std::array<FilmPoint, kMostFilmPoints> timed;
    std::copy(points.begin(), points.end(), timed.begin());
    for (size_t i = 0; i < points.size(); ++i)
        timed[i].time = shutter_->time(points[i].sampler.get1(Dim::Time));
    still_->sample_all({timed.data(), points.size()}, bands, out);
    for (size_t i = 0; i < points.size(); ++i)
        for (CameraPath& path : out[i]) {
            path.ray.time = timed[i].time;
            shutter_->move(path.ray);
        }
}

}  // namespace petzval::camera
