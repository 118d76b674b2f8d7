// SPDX-License-Identifier: Apache-2.0
// What is learned before a render that is to reach a noise: from the full frame, before its first
// sample.
#pragma once

#include <memory>

#include "apps/setup/render_setup.h"
#include "integrator/path/path_options.h"
#include "integrator/render/executor.h"
#include "integrator/render/noise_target.h"

namespace petzval::apps {

/// Target of a render. Its floor is that of the measure of plans (io/image/symmetric_mse.h), from a
/// pilot. A cell on which the light of a lamp lands takes as many samples as kEnoughPaths paths to
/// the lamp need, by camera rays alone; of what is seldom found otherwise nothing is known.
[[nodiscard]] std::shared_ptr<const integrator::NoiseTarget> noise_target(
    const RenderSetup&, const integrator::RenderJob&, const integrator::PathOptions&, V2i size_px,
    double noise, integrator::TbbExecutor&);

}  // namespace petzval::apps
