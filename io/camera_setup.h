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

/// file.scene is finished and in bvh. Throws InputError for a camera that the file does not have
/// and for a lens that cannot be (focal length or f-number not above 0 ...).
[[nodiscard]] CameraSetup set_up_camera(const SceneRequest&, const std::vector<GltfCamera>&,
                                        const Scene&, const Bvh&,
                                        const std::function<void(const std::string&)>& notice);

}  // namespace petzval
