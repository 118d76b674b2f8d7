// SPDX-License-Identifier: Apache-2.0
// How bright a picture is for the light on its film.
#pragma once

namespace petzval {

/// Factor on radiance, in nits, after which 1 is the exposure that saturates a camera of that
/// speed: 78 lx s / ISO (ISO 12232:2019, saturation-based speed). irradiance: of the film's middle
/// over the radiance of the scene, pi sin^2 u'.
[[nodiscard]] constexpr double photographic_gain(double irradiance, double iso, double shutter_s) {
    return irradiance * shutter_s * iso / 78;
}

}  // namespace petzval
