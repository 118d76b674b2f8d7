// SPDX-License-Identifier: Apache-2.0
// Which camera a render uses: the file's, the user's, or one framed from the scene's bounds.
#pragma once

#include "io/gltf.h"
#include "io/session.h"

namespace petzval {

struct CameraSetup {
    std::unique_ptr<Camera> camera;
    CameraReport report;
};

/// The scene is finished and in bvh. Whatever `notice` is told in the form of options gives the
/// same camera when it is passed back. Throws ArgumentError for a camera that the file does not
/// have, for a lens that it cannot take, and where there is nothing to focus on.
[[nodiscard]] CameraSetup set_up_camera(const SceneRequest&, const std::vector<GltfCamera>&,
                                        const std::optional<LoadedLens>&, const Scene&, const Bvh&,
                                        const std::function<void(const std::string&)>& notice);

}  // namespace petzval
