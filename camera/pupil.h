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
    f4 l, m;          ///< direction cosines at the film
    LensRay<f4> ray;  ///< at the stop, on its way to the scene
    f4 x_mm, y_mm;
    m4 clear;  ///< inside the clear semi-diameters on the way, the stop's too
    /// d(x, y) / d(l, m): columns by l and by m.
    f4 x_by_l, y_by_l, x_by_m, y_by_m;

    [[nodiscard]] f4 determinant() const { return x_by_l * y_by_m - x_by_m * y_by_l; }
    /// Area on the stop for a unit of dl dm, which is projected solid angle at the film.
    [[nodiscard]] f4 stretch_mm2() const { return max(determinant(), -determinant()); }
};

/// The rear of a lens, film to stop. Millimetres; coordinates as in Prescription.
class Pupil {
  public:
    /// film_reach_mm: how far film points lie from the axis at most. The lens must outlive it.
    Pupil(const Lens&, double film_mm, double film_reach_mm);

    /// The ray that leaves the film in the same direction in all lanes, and in one of them, whose
    /// wavelength is nm, meets a point of the stop to a ten-thousandth of the stop's radius.
    /// Nothing where no ray gets there. Semi-diameters do not stop rays: one that glass blocks at
    /// one wavelength may have been drawn for another.
    [[nodiscard]] std::optional<StopCrossing> solve(V2f film_point_mm, V2f stop_point_mm,
                                                    const LensIndices<f4>&, int lane,
                                                    float nm) const;

  private:
    /// Equal steps over [first, last].
    struct Axis {
        float first, last;
        int size;
        [[nodiscard]] float at(int i) const;
    };
    /// Direction cosines at kNodes_nm.
    struct Node {
        f4 l{}, m{};
    };
    [[nodiscard]] StopCrossing cross(V2f film_point_mm, const Node& cosines,
                                     const LensIndices<f4>&) const;
    [[nodiscard]] std::optional<StopCrossing> newton(V2f film_point_mm, V2f stop_point_mm,
                                                     V2f cosines, const LensIndices<f4>&,
                                                     int lane) const;
    [[nodiscard]] Node settled(V2f film_point_mm, V2f stop_point_mm, const Node& guess,
                               const LensIndices<f4>&) const;
    [[nodiscard]] V2f between(V2f film_point_mm, V2f stop_point_mm, float nm) const;
    void solve_table();
    [[nodiscard]] size_t place(int column, int row, int i, int j) const {
        return static_cast<size_t>(((column * rows_.size + row) * across_.size + i) * up_.size + j);
    }

    const Lens& lens_;
    double film_mm_;
    float stop_radius_mm_;
    bool symmetric_;       ///< about the axis: film points on the +y axis say it all
    Axis columns_, rows_;  ///< x and y of film points, >= 0
    Axis across_, up_;     ///< x and y of stop points
    std::vector<Node> table_;
};

}  // namespace petzval
