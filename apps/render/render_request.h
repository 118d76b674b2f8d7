// SPDX-License-Identifier: Apache-2.0
// Request for a render: all that its picture follows from, as one value.
#pragma once

#include <optional>
#include <vector>

#include "apps/plan/plan_types.h"
#include "apps/setup/request.h"
#include "core/film/film.h"
#include "integrator/path_options.h"
#include "integrator/render_job.h"
#include "io/image/output.h"

namespace petzval {

/// Numbers, names and files; nothing is read yet. A RenderSession makes a picture of it.
struct RenderRequest {
    SceneRequest scene;
    std::optional<Rect> crop;  ///< pixels of the full frame; absent: all of them
    std::vector<Aov> layers;
    /// Samples, sampler, filter. The session sets observer, velocity and replicates.
    RenderJob job;
    PathOptions path;
    double tolerance = kUsualTolerance;  ///< of what is chosen for the user, above 0
    double fps = 24;                     ///< the layer of velocities looks a frame ahead
    DisplayOptions display;
    bool asks_exposure = false;   ///< display.exposure_ev goes before that of the scene's file
    bool asks_view = false;       ///< display.view goes before that of the scene's file
    bool finds_exposure = false;  ///< a pilot finds it, whatever the display and the file say
};

}  // namespace petzval
