// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/make_target_camera.h"

#include "camera/targets/stop_target_camera.h"

namespace petzval {

std::unique_ptr<TargetCamera> target_camera(const std::shared_ptr<const Camera>& camera) {
    if (auto lens = std::dynamic_pointer_cast<const LensCamera>(camera))
        return std::make_unique<StopTargetCamera>(std::move(lens));
    if (auto lens = std::dynamic_pointer_cast<const AberratedLensCamera>(camera))
        return std::make_unique<StopTargetCamera>(std::move(lens));
    if (auto lens = std::dynamic_pointer_cast<const ThinLensCamera>(camera); lens && lens->iris())
        return std::make_unique<StopTargetCamera>(std::move(lens));
    return nullptr;
}

}  // namespace petzval
