// SPDX-License-Identifier: Apache-2.0
// Points of a thin lens's stop from which rays pass targets.
#pragma once

#include <optional>
#include <span>

#include "camera/camera.h"
#include "camera/iris/iris.h"
#include "camera/models/stop_pencil.h"
#include "camera/target.h"

namespace petzval {

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
