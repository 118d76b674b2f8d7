// SPDX-License-Identifier: Apache-2.0
// Choices of a plan that change little, each by what it was found to change.
#pragma once

#include <optional>

#include "apps/plan/plan_comparison.h"

namespace petzval::apps {

/// Whether rays through the lens need doubles.
struct PrecisionFound {
    camera::Precision precision;
    double apart_px;  ///< most that rays in floats and in doubles part, RMS over a part of the film
    double square;    ///< upper bound of the symmetric MSE of floats, by where the rays go
};
/// Precision for the lens of a request; nothing where there is no glass, or doubles were asked for.
[[nodiscard]] std::optional<PrecisionFound> find_precision(const PlanRequest&,
                                                           const RenderSetup& first,
                                                           const SceneRequest& chosen,
                                                           integrator::TbbExecutor&);

/// How lights are chosen at a path's vertices.
struct LightsFound {
    LightChoiceKind kind;
    double effort_of_other;  ///< of Tree or Power, over that of `kind`
};
/// Light choice for a candidate of a comparison, Tree or Power; nothing where there are less than
/// two lights, or no noise was seen.
[[nodiscard]] std::optional<LightsFound> find_lights(const PlanComparison&,
                                                     const RenderSetup& first,
                                                     const SceneRequest& chosen, size_t candidate);

/// Ghosts of a lens that is traced.
struct GhostsFound {
    bool shown;                   ///< its surfaces reflect, and they are not left out
    size_t lamps;                 ///< that shine into the lens, whatever it reflects
    std::optional<double> share;  ///< of the picture's light, about; nothing: not shown, or dark
};
/// Ghosts of a candidate of a comparison.
[[nodiscard]] GhostsFound find_ghosts(const PlanComparison&, const RenderSetup& first,
                                      const SceneRequest& chosen, size_t candidate);

}  // namespace petzval::apps
