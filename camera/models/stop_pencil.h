// SPDX-License-Identifier: Apache-2.0
// Pencil of a thin lens: the rays of one film point and wavelength, by where they cross the stop;
// and how rays of it are aimed at a target.
#pragma once

#include <optional>
#include <span>

#include "camera/camera.h"
#include "camera/iris/iris.h"

namespace petzval {

/// Rays of a film point through a lens without thickness at the origin, which looks along -z. A ray
/// through the stop at s, h = |s|, has the slope tangents - s v(h), with the vergence
/// v(h) = 1 / (focal_m - half_k_per_m h^2) - film_vergence_per_m. All in metres, of the camera's
/// space.
struct StopPencil {
    V2d tangents;  ///< right and up, of the ray through the middle
    double focal_m, half_k_per_m = 0, film_vergence_per_m = 0;
    double reach_m;  ///< radius of the stop

    [[nodiscard]] double vergence_per_m(double h) const {
        return 1 / (focal_m - half_k_per_m * h * h) - film_vergence_per_m;
    }
    /// Direction of the ray through a point of the stop; z is -1.
    [[nodiscard]] V3d direction(V2d s) const;
};

/// Position of a camera and its axes in world space, unit, as its matrix says.
struct Pose {
    V3f origin, right, up, back;
    explicit Pose(const M44f& matrix);
    [[nodiscard]] V3f to_world(const V3f& v) const { return right * v.x + up * v.y + back * v.z; }
    /// Target in the space that the camera looks along -z in.
    [[nodiscard]] LocalTarget local(const Target&) const;
};

/// Film point, as FilmPoint has it, at which the middle of a stop sees a point in front of it.
/// tan_half: of the angles from the axis to the film's right and upper edges.
[[nodiscard]] inline V2f pictured(const V3d& point, V2f tan_half) {
    return {static_cast<float>(0.5 - 0.5 * point.x / point.z / double(tan_half.x)),
            static_cast<float>(0.5 + 0.5 * point.y / point.z / double(tan_half.y))};
}

/// Density with which `aim` draws a point of the stop, 1/m2; 0 where its ray passes beside the
/// target, or is not one that `aim` finds.
[[nodiscard]] double aimed_density(const StopPencil&, const LocalTarget&, V2d stop_m);

/// Point of the stop whose ray passes the target at an even random point of it. Where spherical
/// aberration folds the pencil, up to three do, and each is as likely. Nothing where none does.
/// point in [0, 1)^2, pick in [0, 1).
[[nodiscard]] std::optional<V2d> aim(const StopPencil&, const LocalTarget&, V2f point, float pick);

/// Stop of a film point with targets, and the pencils of the lanes whose rays share what is drawn.
struct TargetedStop {
    const Iris& iris;
    std::span<const StopPencil> pencils;

    /// Share of the light that a ray through a drawn point of the stop counts: the density of that
    /// draw over the sum of it and of those of rays that are aimed (balance heuristic, Veach and
    /// Guibas 1995, "Optimally combining sampling techniques for Monte Carlo rendering").
    [[nodiscard]] float mis_weight(V2f stop_mm, TargetList) const;
    /// Point of the stop from which a ray passes one of the targets, and its weight, above 0;
    /// nothing where there is none, or the iris is closed there.
    struct Aimed {
        V2f stop_mm;
        float mis_weight;
    };
    [[nodiscard]] std::optional<Aimed> aim_at_one(const FilmPoint&, TargetList) const;
    /// The target with the share of ordinary rays that pass it; nothing where no ray of the first
    /// pencil passes its middle, nor nearly.
    [[nodiscard]] std::optional<ListedTarget> listed(const LocalTarget&, V2f place) const;
};

}  // namespace petzval
