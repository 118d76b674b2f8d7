// SPDX-License-Identifier: Apache-2.0
// Lower rungs of the ladder of cameras that come nearest to a lens.
#pragma once

#include "apps/setup/render_setup.h"

namespace petzval {

/// A thin lens in the entrance pupil of the session's lens: with its iris and focus, its angle of
/// view at the plane of focus (a lens that is focused near sees less than its focal length says),
/// and nothing of its glass. The request is the session's, with the wishes of the file's camera.
[[nodiscard]] SceneRequest equivalent_thin_lens(SceneRequest, const Session&);

/// A pinhole in the same place. Of a session with a lens of any kind; no photographic exposure.
[[nodiscard]] SceneRequest equivalent_pinhole(SceneRequest, const Session&);

/// The session's request with all that was chosen for it fixed: wishes of the file's camera, and
/// the distance in focus.
[[nodiscard]] SceneRequest resolved_request(const Session&);

}  // namespace petzval
