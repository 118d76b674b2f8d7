// SPDX-License-Identifier: Apache-2.0
// Ray aiming: finds the direction in which a ray must leave a film point to meet a point of the
// stop.
#pragma once

#include <vector>

#include "camera/lens/lens.h"
#include "camera/lens/lens_ray.h"
#include "core/math/math.h"

namespace petzval::camera {

/// Point of a plane across the axis, lane by lane. Millimetres.
template <class V>
struct PlanePoint {
    V x, y;

    PlanePoint(V x0, V y0) : x(x0), y(y0) {}
    /// The same point in all lanes.
    explicit PlanePoint(V2f p)
        : x(broadcast<V>(ScalarOf<V>(p.x))), y(broadcast<V>(ScalarOf<V>(p.y))) {}
    [[nodiscard]] V2f operator[](int lane) const {
        return {static_cast<float>(x[lane]), static_cast<float>(y[lane])};
    }
};

/// Rays from the film at the plane of the stop, lane by lane. V: f4, f8 or d4.
template <class V>
struct AimedRay {
    V l, m;           ///< direction cosines at the film
    LensRay<V> ray;   ///< at the stop, on its way to the scene
    MaskOf<V> clear;  ///< inside the clear semi-diameters of all that it met before the stop
    /// Jacobian d(x, y) / d(l, m): columns by l and by m.
    V x_by_l, y_by_l, x_by_m, y_by_m;

    [[nodiscard]] V determinant() const { return x_by_l * y_by_m - x_by_m * y_by_l; }
    /// Area on the stop for a unit of dl dm, which is projected solid angle at the film.
    [[nodiscard]] V stretch_mm2() const {
        const V d = determinant();
        return d < 0 ? -d : d;
    }
};

/// Rays that aim() has found.
struct FoundRays : AimedRay<f8> {
    m8 found{};   ///< lanes in which a ray gets there
    m8 traces{};  ///< needed to find it
};

/// Ray aiming through the rear of a lens, film to stop. Millimetres; coordinates as in
/// Prescription.
class RayAimer {
  public:
    /// film_reach_mm: greatest distance of film points from the axis. The lens must outlive it.
    RayAimer(const Lens&, double film_mm, double film_reach_mm);

    /// Rays that meet a point of the stop to a ten-thousandth of the stop's radius, or as near as
    /// floats can, and are within a thousandth of the direction that does: each lane by itself, as
    /// if the others were not there. Semi-diameters do not stop rays: one that glass blocks at one
    /// wavelength may have been drawn for another.
    [[nodiscard]] FoundRays aim(const PlanePoint<f8>& film_mm, const PlanePoint<f8>& stop_mm,
                                const LensIndices<f8>&, f8 nm) const;
    /// The ray that leaves the film with direction cosines l and m. V: f4, f8 or d4.
    template <class V>
    [[nodiscard]] AimedRay<V> cross(const PlanePoint<V>& film_mm, V l, V m,
                                    const LensIndices<V>&) const;
    /// Ray of cross() where it leaves the film. N: V, or V with derivatives.
    template <class N>
    [[nodiscard]] LensRay<N> leave(const PlanePoint<ValueOf<N>>& film_mm, const N& l,
                                   const N& m) const {
        const double z = film_mm_ - lens_.vertex_mm(lens_.last());
        LensRay<N> ray;
        ray.counted_from = lens_.last();
        ray.origin = {constant<N>(film_mm.x), constant<N>(film_mm.y),
                      constant<N>(broadcast<ValueOf<N>>(ScalarOf<N>(z)))};
        ray.direction = {l, m, -sqrt(1 - l * l - m * m)};
        return ray;
    }

  private:
    /// Axis of the table: equal steps over [first, last].
    struct Axis {
        float first, last;
        int size;
        [[nodiscard]] float at(int i) const;
    };
    /// Direction cosines at kNodes_nm: l in the first four lanes, m in the others.
    struct Node {
        f8 lm{};
        Node() = default;
        Node(f4 l, f4 m) : lm(joined(l, m)) {}
        [[nodiscard]] f4 l() const { return __builtin_shufflevector(lm, lm, 0, 1, 2, 3); }
        [[nodiscard]] f4 m() const { return __builtin_shufflevector(lm, lm, 4, 5, 6, 7); }
    };
    [[nodiscard]] FoundRays newton(const PlanePoint<f8>& film_mm, const PlanePoint<f8>& stop_mm,
                                   const PlanePoint<f8>& cosines, const LensIndices<f8>&) const;
    [[nodiscard]] Node settled(V2f film_point_mm, V2f stop_point_mm, const Node& guess,
                               const LensIndices<f4>&) const;
    [[nodiscard]] V2f between(V2f film_point_mm, V2f stop_point_mm, float nm) const;
    [[nodiscard]] V2f guess(V2f film_point_mm, V2f stop_point_mm, float nm) const;
    void solve_table();
    [[nodiscard]] size_t place(int column, int row, int i, int j) const {
        return static_cast<size_t>(((column * rows_.size + row) * across_.size + i) * up_.size + j);
    }

    const Lens& lens_;
    double film_mm_;
    float stop_radius_mm_;
    bool symmetric_;       ///< about the axis: film points on the +y axis suffice
    Axis columns_, rows_;  ///< x and y of film points, >= 0
    Axis across_, up_;     ///< x and y of stop points
    std::vector<Node> table_;
};

}  // namespace petzval::camera
