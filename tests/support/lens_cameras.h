// SPDX-License-Identifier: Apache-2.0
// Lens cameras that tests look through.
#pragma once

#include <string>

#include "camera/lens/paraxial.h"
#include "camera/models/lens_camera.h"
#include "tests/support/lens_json.h"

namespace petzval::test {

inline const std::string kTakumar = "takumar-50mm-f1.2", kGauss = "double-gauss-100mm-f2",
                         kFisheye = "minolta-fisheye-16mm-f2.8";

/// Turned and moved: its camera looks along (0.48, -0.6, -0.64), up is (0.36, 0.8, -0.48).
[[nodiscard]] inline M44f posed() {
    M44f m;
    const V3f back(-0.48f, 0.6f, 0.64f), up(0.36f, 0.8f, -0.48f), right = up.cross(back);
    const V3f origin(1, 2, 3);
    const V3f rows[] = {right, up, back, origin};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) m[i][k] = rows[i][k];
    return m;
}

[[nodiscard]] inline camera::LensCameraInput input_of(
    const std::string& name, camera::DispersionMode dispersion = camera::DispersionMode::Split,
    double stop_scale = 1) {
    const auto lens = std::make_shared<const camera::Lens>(read_lens(name));
    const double radius =
        lens->prescription().surfaces[size_t(lens->stop())].semi_diameter_mm * stop_scale;
    camera::LensCameraInput in{
        .lens = lens, .iris = camera::Iris(camera::Disk{}, radius), .to_world = posed()};
    in.film_mm = lens->film_mm();
    in.entrance_pupil_mm = camera::first_order(*lens, kLineD_nm).entrance_pupil_mm;
    in.dispersion = dispersion;
    return in;
}

/// Inside the lines F to C, between which the glasses of read_lens have their dispersion.
[[nodiscard]] inline Bands four_wavelengths() {
    Bands bands = Bands::rgb();
    bands.spectral = true;
    bands.nm = f4{490, 530, 610, 652};
    bands.on = m4{-1, -1, -1, -1};
    return bands;
}

[[nodiscard]] inline int first_lane(const camera::CameraPath& path) {
    int lane = 0;
    while (lane < 3 && !path.lanes[lane]) ++lane;
    return lane;
}

/// The bands with another hero, each equally likely for u in [0, 1).
[[nodiscard]] inline Bands led_by(Bands bands, float u) {
    std::vector<int> lanes;
    for (int i = 0; i < 4; ++i)
        if (bands.on[i]) lanes.push_back(i);
    bands.hero = lanes[size_t(u * float(lanes.size()))];
    return bands;
}

/// The hero lane, and no other.
[[nodiscard]] inline Bands alone(Bands bands) {
    bands.on = m4{};
    bands.on[bands.hero] = -1;
    return bands;
}

[[nodiscard]] inline camera::FilmPoint film_point(V2f film, uint32_t index) {
    return {film, Sampler(SamplerKind::Owen, 7, {0, 0, index})};
}
[[nodiscard]] inline V2f millimetres(const camera::LensCameraInput& in, V2f film) {
    return {(0.5f - film.x) * float(in.film_width_mm), (film.y - 0.5f) * float(in.film_height_mm)};
}
/// What sample() draws for that point.
template <class V = f4>
camera::LensDraw<V> draw_of(const camera::LensCamera& camera, const camera::LensCameraInput& in,
                            const camera::FilmPoint& at, const Bands& bands) {
    return camera.draw<V>(millimetres(in, at.film), at.sampler.get2(Dim::Lens), bands);
}

}  // namespace petzval::test
