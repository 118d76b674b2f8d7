// SPDX-License-Identifier: Apache-2.0
// From a point of the film to a point of the stop: which way does the ray leave the film?
#pragma once

#include <optional>
#include <vector>

#include "camera/lens.h"
#include "camera/lens_march.h"
#include "core/math.h"

namespace petzval {

/// Where rays from the film cross the plane of the stop, lane by lane.
struct StopCrossing {
    LensRay<f4> ray;  ///< at the stop, on its way to the scene
    f4 x_mm, y_mm;
    m4 clear;  ///< inside the clear semi-diameters on the way, the stop's too
    /// d(x, y) / d(L, M), L and M the direction cosines at the film: columns by L and by M.
    f4 x_by_l, y_by_l, x_by_m, y_by_m;

    /// Area on the stop for a unit of dL dM, which is projected solid angle at the film.
    [[nodiscard]] f4 stretch_mm2() const {
        const f4 determinant = x_by_l * y_by_m - x_by_m * y_by_l;
        return max(determinant, -determinant);
    }
};

/// The rear of a lens, film to stop. Millimetres; coordinates as in Prescription.
class Pupil {
  public:
    /// film_reach_mm: how far film points lie from the axis at most. The lens must outlive it.
    Pupil(const Lens&, double film_mm, double film_reach_mm);

    /// Direction cosines (L, M) at the film of the ray from film point to stop point at the
    /// wavelength of one lane, to a ten-thousandth of the stop's radius: Newton's method, begun
    /// between solved rays. Nothing where no ray gets there.
    [[nodiscard]] std::optional<V2f> direction(V2f film_point_mm, V2f stop_point_mm,
                                               const LensIndices<f4>&, int lane) const;
    /// The rays with these direction cosines, the same in all lanes. Semi-diameters do not stop
    /// them: a ray that glass blocks at one wavelength may have been drawn for another.
    [[nodiscard]] StopCrossing cross(V2f film_point_mm, V2f cosines, const LensIndices<f4>&) const;

  private:
    struct Known {
        V2f cosines;
        bool there = false;
    };
    [[nodiscard]] std::optional<V2f> newton(V2f film_point_mm, V2f stop_point_mm, V2f cosines,
                                            const LensIndices<f4>&, int lane) const;
    [[nodiscard]] std::optional<V2f> between(V2f film_point_mm, V2f stop_point_mm) const;
    void solve_table();
    [[nodiscard]] V2f film_point(int column, int row) const;
    [[nodiscard]] V2f stop_point(int i, int j) const;
    [[nodiscard]] Known& known(int column, int row, int i, int j);
    [[nodiscard]] const Known& known(int column, int row, int i, int j) const {
        return const_cast<Pupil*>(this)->known(column, row, i, j);
    }

    const Lens& lens_;
    double film_mm_;
    float film_reach_mm_, stop_radius_mm_;
    bool symmetric_;  ///< about the axis: film points on the +y axis say it all
    int columns_, rows_;
    /// By film point (x, y >= 0), then by stop point; see film_point and stop_point.
    std::vector<Known> table_;
};

}  // namespace petzval
