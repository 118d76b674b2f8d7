// SPDX-License-Identifier: Apache-2.0
#include "camera/models/zoom_camera.h"

#include "core/math/steps.h"

namespace petzval::camera {

CameraSample ZoomCamera::sample(const FilmPoint& at, const Bands& bands) const {
    const auto [before, share] = step_place(at.time, at_steps_.size());
    CameraSample out = at_steps_[before]->sample(at, bands);
    const CameraSample next = at_steps_[before + 1]->sample(at, bands);
    out.exposure = lerp(out.exposure, next.exposure, share);
    CameraPath& path = out[0];
    const Ray& after = next[0].ray;
    path.weight = path.weight * (1 - share) + next[0].weight * share;
    path.ray.origin = path.ray.origin * (1 - share) + after.origin * share;
    path.ray.direction = unit(path.ray.direction * (1 - share) + after.direction * share);
    return out;
}

}  // namespace petzval::camera
