// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/make_target_camera.h"

#include "camera/targets/stop_target_camera.h"

namespace petzval::camera {

std::unique_ptr<TargetCamera> target_camera(const std::shared_ptr<const Camera>& camera) {
    auto lens = stop_camera(camera);
    return lens ? std::make_unique<StopTargetCamera>(*std::move(lens)) : nullptr;
}

}  // namespace petzval::camera
