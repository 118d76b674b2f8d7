// SPDX-License-Identifier: Apache-2.0
// Pencil of a thin lens: the rays of one film point and wavelength, by where they cross the stop.
#pragma once

#include "core/math/math.h"

namespace petzval::camera {

/// Rays of a film point through a lens without thickness at the origin, which looks along -z. A ray
/// through the stop at s, h = |s|, has the slope tangents - s v(h), with the vergence
/// v(h) = 1 / (focal_m - half_k_per_m h^2) - film_vergence_per_m. All in metres, of the camera's
/// space.
struct StopPencil {
    V2d tangents;  ///< right and up, of the ray through the middle
    double focal_m, half_k_per_m = 0, film_vergence_per_m = 0;

    [[nodiscard]] double vergence_per_m(double h) const {
        return 1 / (focal_m - half_k_per_m * h * h) - film_vergence_per_m;
    }
    /// Direction of the ray through a point of the stop; z is -1.
    [[nodiscard]] V3d direction(V2d s) const;
};

}  // namespace petzval::camera
