// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/auto_focus.h"

#include "apps/setup/camera/camera_setup.h"
#include "io/base/error.h"

namespace petzval::apps {

FoundFocus find_auto_focus(const io::GltfCamera* camera, const std::string& scene_file,
                           io::FileScope scope, const Scene& scene, const Bvh& bvh) {
    SceneRequest request;
    CameraRequest& asked = request.camera;
    if (!camera || !camera->extras.lens || *camera->extras.lens == "pinhole") asked.lens = "thin";
    asked.fstop = 8.f;  // any: the focus does not depend on it, nor on the iris
    asked.aperture = "circle";
    asked.focus = FocusAuto{};
    const std::vector<io::GltfCamera> cameras =
        camera ? std::vector<io::GltfCamera>{*camera} : std::vector<io::GltfCamera>{};
    try {
        const float aspect =
            static_cast<float>(request.size.x) / static_cast<float>(request.size.y);
        const CameraModel model = choose_camera_model(asked, scene_file, scope, cameras, aspect);
        const CameraSetup found =
            set_up_camera(model, scene_file, request.size, scene, bvh, [](const std::string&) {});
        return {found.report.focus_m, ""};
    } catch (const io::InputError& error) {
        const std::string what = error.what(), prefix = scene_file + ": ";
        return {0, what.starts_with(prefix) ? what.substr(prefix.size()) : what};
    }
}

}  // namespace petzval::apps
