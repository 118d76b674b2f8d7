// SPDX-License-Identifier: Apache-2.0
// Scaling of a lens: its f-number, its field and its relative aberrations stay.
#pragma once

#include <optional>

#include "camera/lens/lens.h"

namespace petzval::camera {

/// The prescription with every length times the factor, the stated focal length and the image
/// circle too; an aspheric coefficient A of r^n times factor^(1-n). Throws std::invalid_argument
/// where the factor is not above 0 and finite.
[[nodiscard]] Prescription scaled(Prescription, double factor);

/// Scale factor that brings the chief ray of line d of a distant point at half_field_deg from the
/// axis to half_height_mm on the film, in the y-z section. film_mm: of the lens at factor 1, from
/// the first vertex. Nothing where no light of that field reaches the film.
[[nodiscard]] std::optional<double> scale_for_field(const Lens&, double half_height_mm,
                                                    double half_field_deg, double film_mm);

}  // namespace petzval::camera
