// SPDX-License-Identifier: Apache-2.0
// Choice of the dispersion mode where nothing may be left out: by noise and cost, as measured.
#pragma once

#include <array>
#include <optional>

#include "apps/plan/plan_types.h"
#include "integrator/render/executor.h"

namespace petzval::apps {

/// Dispersion mode without a bias, and how much it takes to bring the noise down.
struct ModeCost {
    camera::DispersionMode mode;
    /// Variance of a sample, typical over the frame and relative to that of split rays, times its
    /// cost in rays (PilotModel::rays_per_sample): in proportion to the time that a given noise
    /// takes.
    double effort;
};

struct ModeChoice {
    double dispersion_px;               ///< RMS lateral dispersion
    std::array<ModeCost, 2> by_effort;  ///< the least first
    SceneRequest scene;                 ///< the request with the first of them

    [[nodiscard]] camera::DispersionMode mode() const { return by_effort[0].mode; }
    /// Effort of the other over that; nothing where no noise was seen.
    [[nodiscard]] std::optional<double> effort_of_next() const {
        if (!(by_effort[0].effort > 0)) return std::nullopt;
        return by_effort[1].effort / by_effort[0].effort;
    }
};

/// Mode for a setup through a lens that disperses, by a pilot of about a quarter of a sample for
/// each pixel of the frame, within 16,384 to 65,536 samples where there are pixels enough. It
/// follows from the scene and how its frame is rendered: neither the number of samples nor seed nor
/// crop matter.
[[nodiscard]] ModeChoice choose_mode(const PlanRequest&, const RenderSetup& first,
                                     integrator::TbbExecutor&);

}  // namespace petzval::apps
