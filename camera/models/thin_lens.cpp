// SPDX-License-Identifier: Apache-2.0
#include "camera/models/thin_lens.h"

#include <cmath>
#include <utility>

namespace petzval::camera {
namespace {

// Distance from which a lens radius is below the last digit of a float: as good as infinity.
constexpr float kFarthest_m = 1e9f;

// A camera ray from a point and a direction of the camera's own space.
CameraSample one_path(const Pose& pose, const V3f& origin, const V3f& direction, const Bands& bands,
                      float exposure, float weight) {
    CameraSample out;
    out.exposure = exposure;
    CameraPath& path = out.add();
    path.ray.origin = pose.origin + pose.to_world(origin);
    path.ray.direction = unit(pose.to_world(direction));
    path.weight = uniform(weight, bands);
    path.lanes = bands.on;
    return out;
}

}  // namespace

ThinLensCamera::ThinLensCamera(ThinLens lens)
    : pose_(lens.to_world),
      iris_(std::move(lens.iris)),
      vignetting_(lens.vignetting),
      focus_m_(std::fmin(lens.focus_m, kFarthest_m)),
      exposure_(lens.exposure),
      tan_half_x_(std::tan(lens.yfov_rad / 2) * lens.aspect),
      tan_half_y_(std::tan(lens.yfov_rad / 2)) {}

V2f ThinLensCamera::tangents(V2f film) const {
    return {(2.f * film.x - 1.f) * tan_half_x_, (1.f - 2.f * film.y) * tan_half_y_};
}

CameraSample ThinLensCamera::through(const FilmPoint& at, V2f stop_mm, const Bands& bands) const {
    const V2f slope = tangents(at.film), stop = stop_mm * 1e-3f;
    const V3f origin{stop.x, stop.y, 0.f}, direction{slope.x, slope.y, -1.f};
    const float weight = vignetting_ ? exposure_ * vignetting_->factor(slope, stop_mm) : exposure_;
    return one_path(pose_, origin, iris_ ? direction * focus_m_ - origin : direction, bands,
                    exposure_, weight);
}

V2f ThinLensCamera::drawn_stop_mm(const FilmPoint& at) const {
    return iris_ ? iris_->sample(at.sampler.get2(Dim::Lens)) : V2f(0.f);
}

CameraSample ThinLensCamera::sample(const FilmPoint& at, const Bands& bands) const {
    return through(at, drawn_stop_mm(at), bands);
}

StopPencil ThinLensCamera::pencil(V2f film) const {
    return {V2d(tangents(film)), double(focus_m_)};
}

OrthographicCamera::OrthographicCamera(const M44f& to_world, float half_width_m,
                                       float half_height_m)
    : pose_(to_world), half_width_m_(half_width_m), half_height_m_(half_height_m) {}

CameraSample OrthographicCamera::sample(const FilmPoint& at, const Bands& bands) const {
    const V3f origin{(2.f * at.film.x - 1.f) * half_width_m_,
                     (1.f - 2.f * at.film.y) * half_height_m_, 0.f};
    return one_path(pose_, origin, V3f(0, 0, -1), bands, 1.f, 1.f);
}

M44f look_at(const V3f& eye, const V3f& target) {
    const V3f back = unit(eye - target);
    const V3f up = std::fabs(back.y) > 0.9999f ? V3f(0, 0, -1) : V3f(0, 1, 0);
    const V3f right = unit(up.cross(back));
    const V3f true_up = back.cross(right);
    return M44f(right.x, right.y, right.z, 0, true_up.x, true_up.y, true_up.z, 0, back.x, back.y,
                back.z, 0, eye.x, eye.y, eye.z, 1);
}

}  // namespace petzval::camera
