// SPDX-License-Identifier: Apache-2.0
// Axial spot: the image of a point on the axis, in moments that say how it changes as the film
// moves.
#pragma once

#include <optional>

#include "camera/lens/lens.h"

namespace petzval::camera {

/// Moments of the spot: means over the light of the lines F, d and C in equal parts, each spread
/// evenly over the part of the entrance pupil that passes. The centroid lies on the axis: lenses
/// have two planes of symmetry at least.
struct AxialSpot {
    double square_mm2 = 0;  ///< of the distance from the axis
    double product_mm = 0;  ///< of the distance and its change per mm of film
    double slope_square = 0;

    /// Mean square distance from the axis in a plane this far behind the film.
    [[nodiscard]] double mean_square_mm2(double shift_mm = 0) const;
    /// Shift of the film at which it is least; 0 where rays leave parallel.
    [[nodiscard]] double best_shift_mm() const;
};

/// Spot of an axial point. object_mm and film_mm count from the first vertex, object_mm < 0 or
/// -infinity. stop_radius_mm: of a round iris; the stop's own rim and all others stop light too.
/// Nothing where no ray passes.
[[nodiscard]] std::optional<AxialSpot> axial_spot(const Lens&, double object_mm, double film_mm,
                                                  double stop_radius_mm);

}  // namespace petzval::camera
