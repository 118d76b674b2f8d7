// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "apps/plan/plan.h"

namespace petzval::apps {

/// Plan for programs: each choice with its reason, the samples, and what error, CPU time and wall
/// time (least, mean, most) are predicted.
[[nodiscard]] nlohmann::ordered_json json_of(const Plan&);

}  // namespace petzval::apps
