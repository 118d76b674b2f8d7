// SPDX-License-Identifier: Apache-2.0
// From a camera model and a scene to a camera: where it stands, what it is focused on, and its
// exposure.
#pragma once

#include "apps/setup/camera/camera_model.h"
#include "apps/setup/camera/camera_report.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"
#include "io/base/notice.h"

namespace petzval::apps {

struct CameraSetup {
    std::unique_ptr<camera::Camera> camera;  ///< in the middle of the exposure
    std::unique_ptr<camera::Camera> finder;  ///< pictures the same with a narrow iris
    bool zooms = false;  ///< the camera's view changes while the shutter is open
    std::shared_ptr<const camera::Shutter> shutter{};  ///< nullptr: nothing moves
    CameraReport report;
};

/// A shutter for a camera of a file, or for one that stands still (nullptr), whose rays start from
/// in_the_middle: where the camera is in the middle of an exposure, maybe of another frame.
[[nodiscard]] std::shared_ptr<const camera::Shutter> shutter_with(const camera::ShutterCurve&,
                                                                  const io::GltfCamera*,
                                                                  const M44f& in_the_middle);

/// Camera of a model in a scene, which must be finished and in bvh; scene_file is its name, for
/// errors. Whatever `notice` is told in the form of options gives the same camera when it is passed
/// back. Throws ArgumentError for a lens that cannot do what is asked, and where there is nothing
/// to focus on.
[[nodiscard]] CameraSetup set_up_camera(const CameraModel&, const std::string& scene_file, V2i size,
                                        const Scene&, const Bvh&, const io::Notice& notice);

}  // namespace petzval::apps
