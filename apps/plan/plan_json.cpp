// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_json.h"

#include "apps/plan/plan_wording.h"
#include "apps/request/option_text.h"

namespace petzval::apps {

nlohmann::ordered_json json_of(const Plan& plan) {
    nlohmann::ordered_json out;
    for (const PlanLine& line : lines_of(plan)) {
        nlohmann::ordered_json one{{"chosen", line.chosen}, {"reason", as_options(line.reason)}};
        one["predicted_error"] = line.error ? nlohmann::ordered_json(*line.error) : nullptr;
        out[line.choice] = one;
    }
    out["samples"] = plan.samples;
    if (const auto times = times_without_targets(plan))
        out["targets"] = {{"lamps", plan.rare.targeted}, {"times_samples_without", *times}};
    out["predicted_error"] = plan.error();
    out["predicted_bias"] = plan.bias;
    out["predicted_noise"] = plan.noise;
    out["noise_at_least"] = plan.noise_at_least;
    if (plan.noise_at_least) out["noise_at_least_because"] = rare_text(plan);
    out["predicted_cpu_s"] = plan.cpu_s;
    out["predicted_wall_s"] = {Plan::kLeastTime * plan.wall_s(), plan.wall_s(),
                               Plan::kMostTime * plan.wall_s()};
    return out;
}

}  // namespace petzval::apps
