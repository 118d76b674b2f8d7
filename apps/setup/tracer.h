// SPDX-License-Identifier: Apache-2.0
// The path tracer of a setup.
#pragma once

#include "apps/setup/render_setup.h"
#include "integrator/path/path.h"

namespace petzval::apps {

/// Path tracer of a view: it shows behind the scene what the view says. The setup must outlive it.
[[nodiscard]] inline integrator::PathTracer<> tracer_of(const RenderSetup& setup,
                                                        integrator::PathOptions options) {
    options.visible_background = setup.view.visible_background;
    const PreparedScene& prepared = setup.prepared;
    return {*prepared.scene, *prepared.bvh, *prepared.lights, options};
}

}  // namespace petzval::apps
