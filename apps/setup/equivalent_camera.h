// SPDX-License-Identifier: Apache-2.0
// Requests for the simpler cameras that come nearest to a lens.
#pragma once

#include "apps/setup/render_setup.h"

namespace petzval::apps {

/// A thin lens in the entrance pupil of the setup's lens: with its iris and focus, its angle of
/// view at the plane of focus (a lens that is focused near sees less than its focal length says),
/// and nothing of its glass. The request is the setup's, with the settings of the file's camera.
[[nodiscard]] SceneRequest equivalent_thin_lens(SceneRequest, const RenderSetup&);

/// A pinhole in the same place. For a setup with a lens of any kind; not for photographic exposure.
[[nodiscard]] SceneRequest equivalent_pinhole(SceneRequest, const RenderSetup&);

/// The setup's request with all that was chosen for it fixed: settings of the file's camera, and
/// the distance in focus.
[[nodiscard]] SceneRequest resolved_request(const RenderSetup&);

}  // namespace petzval::apps
