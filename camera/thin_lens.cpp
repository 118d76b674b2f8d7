// SPDX-License-Identifier: Apache-2.0
#include "camera/thin_lens.h"

#include "core/warp.h"

namespace petzval {
namespace {

CameraSample one_path(const M44f& to_world, const V3f& origin, const V3f& direction,
                      const Bands& bands) {
    CameraSample out;
    out.count = 1;
    CameraPath& path = out.path[0];
    to_world.multVecMatrix(origin, path.ray.origin);
    to_world.multDirMatrix(direction, path.ray.direction);
    path.ray.direction = unit(path.ray.direction);
    path.weight = uniform(1.f, bands);
    path.lanes = bands.on;
    return out;
}

}  // namespace

ThinLensCamera::ThinLensCamera(const ThinLens& lens)
    : lens_(lens), tan_half_y_(std::tan(lens.yfov_rad / 2)) {}

CameraSample ThinLensCamera::sample(const FilmPoint& at, const Bands& bands) const {
    const V3f direction{(2.f * at.film.x - 1.f) * tan_half_y_ * lens_.aspect,
                        (1.f - 2.f * at.film.y) * tan_half_y_, -1.f};
    if (lens_.radius_m <= 0.f) return one_path(lens_.to_world, V3f(0.f), direction, bands);
    const V2f stop = uniform_disk(at.lens) * lens_.radius_m;
    const V3f origin{stop.x, stop.y, 0.f};
    return one_path(lens_.to_world, origin, direction * lens_.focus_m - origin, bands);
}

OrthographicCamera::OrthographicCamera(const M44f& to_world, float half_width_m,
                                       float half_height_m)
    : to_world_(to_world), half_width_m_(half_width_m), half_height_m_(half_height_m) {}

CameraSample OrthographicCamera::sample(const FilmPoint& at, const Bands& bands) const {
    const V3f origin{(2.f * at.film.x - 1.f) * half_width_m_,
                     (1.f - 2.f * at.film.y) * half_height_m_, 0.f};
    return one_path(to_world_, origin, V3f(0, 0, -1), bands);
}

M44f look_at(const V3f& eye, const V3f& target) {
    const V3f back = unit(eye - target);
    const V3f up = std::fabs(back.y) > 0.9999f ? V3f(0, 0, -1) : V3f(0, 1, 0);
    const V3f right = unit(up.cross(back));
    const V3f true_up = back.cross(right);
    return M44f(right.x, right.y, right.z, 0, true_up.x, true_up.y, true_up.z, 0, back.x, back.y,
                back.z, 0, eye.x, eye.y, eye.z, 1);
}

}  // namespace petzval
