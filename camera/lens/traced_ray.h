// SPDX-License-Identifier: Apache-2.0
// Traced ray: one ray through a lens, with its points, direction and optical path.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "camera/lens/lens.h"
#include "camera/lens/lens_ray.h"
#include "core/math/math.h"

namespace petzval::camera {

/// Ray through a lens, millimetres; z = 0 at the first vertex, +z towards the film.
struct TracedRay {
    std::vector<V3d> points;  ///< on each surface that it met, the one that blocked it too
    V3d point, direction;     ///< at which it leaves; only of a ray that passed
    double path_mm = 0;       ///< optical path from the origin to `point`
    RayStatus status = RayStatus::Passed;
    int end_surface = -1;  ///< surface that blocked it

    /// Point (x, y) at which a ray that passed meets a plane across the axis; nothing where it does
    /// not lead there.
    [[nodiscard]] std::optional<std::array<double, 2>> at_plane(double z_mm) const;
};

/// Traces a ray in doubles with the glasses' own formulas. direction: of any length but 0.
[[nodiscard]] TracedRay trace_ray(const Lens&, const V3d& origin_mm, const V3d& direction,
                                  double nm, Towards, Clip);

/// Rays that are traced together. As many directions as origins, of any length but 0, and as many
/// wavelengths, or one for all.
struct RaysIn {
    std::span<const V3d> origins_mm, directions;
    std::span<const double> nm;
};
/// What becomes of them, as TracedRay has it; NaN where a ray did not pass. As long as what is
/// traced.
struct RaysOut {
    std::span<V3d> points_mm, directions;
    std::span<double> paths_mm;
    std::span<RayStatus> status;
    std::span<int> end_surfaces;
};
/// Traces many rays, each as trace_ray() does, in a fraction of its time.
void trace_rays(const Lens&, const RaysIn&, Towards, Clip, const RaysOut&);

}  // namespace petzval::camera
