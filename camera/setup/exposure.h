// SPDX-License-Identifier: Apache-2.0
// Photographic exposure: the brightness of a picture for the light on its film.
#pragma once

#include <cmath>

namespace petzval::camera {

/// Factor on radiance, in nits, after which 1 is the exposure that saturates a camera of that
/// speed: 78 lx s / ISO (ISO 12232:2019, saturation-based speed). irradiance: of the film's middle
/// over the radiance of the scene, pi sin^2 u'.
[[nodiscard]] constexpr double photographic_gain(double irradiance, double iso, double shutter_s) {
    return irradiance * shutter_s * iso / 78;
}

/// Irradiance in the middle of the film over the radiance of the scene, behind a thin lens: pi
/// sin^2 u' of a round stop of that radius, in proportion to the area of the iris.
[[nodiscard]] inline double thin_lens_irradiance(double stop_radius_mm, double film_mm,
                                                 double iris_area_mm2) {
    const double sine = std::sin(std::atan(stop_radius_mm / film_mm));
    return iris_area_mm2 / (stop_radius_mm * stop_radius_mm) * sine * sine;
}

}  // namespace petzval::camera
