// SPDX-License-Identifier: Apache-2.0
// The sentences in which a plan is told, and the options that carry it out. Nothing is decided
// here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/plan/plan.h"
#include "apps/request/option_names.h"
#include "integrator/render/noise_target.h"

namespace petzval::apps {

template <>
inline constexpr auto kOptionNames<PlanModel> =
    std::to_array<OptionName<PlanModel>>({{"pinhole", PlanModel::Pinhole},
                                          {"thin", PlanModel::Thin},
                                          {"rgb", PlanModel::Rgb},
                                          {"shared", PlanModel::Shared},
                                          {"hero", PlanModel::Hero},
                                          {"split", PlanModel::Split},
                                          {"full", PlanModel::Full}});

/// Reason why the noise may be larger than a plan says; empty where it is known.
[[nodiscard]] std::string rare_text(const Plan&);
/// What a render has reached of a noise that was asked for.
[[nodiscard]] std::string text_of(const integrator::NoiseReport&, double asked);
/// Warning of lamps that few paths of a render meet; none where there are none.
[[nodiscard]] std::optional<std::string> warning_of(const SmallLamps&);
/// Times the samples that the same noise would take without rays to targets; nothing where that is
/// below 4: then they are not what makes the picture possible.
[[nodiscard]] std::optional<double> times_without_targets(const Plan&);

struct PlanLine {
    std::string choice, chosen, reason;
    std::optional<double> error;  ///< predicted, of what was chosen; absent: nothing is lost
};
/// A line for each choice: camera, spectral, dispersion, precision, ghosts, diffraction,
/// lights.
[[nodiscard]] std::vector<PlanLine> lines_of(const Plan&);

/// Request that the plan leads to, with its choices in place of those that were asked for.
[[nodiscard]] RenderRequest carried_out(const Plan&, RenderRequest);

/// The reason of what `auto` chose for a render; empty where nothing was open.
[[nodiscard]] std::string reason_of(const AutoChoice&);
/// The line that tells the dispersion mode with its reason; nothing where it was not open.
[[nodiscard]] std::optional<std::string> line_of(const AutoChoice&);

}  // namespace petzval::apps
