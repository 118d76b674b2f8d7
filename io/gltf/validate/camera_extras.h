// SPDX-License-Identifier: Apache-2.0
// Camera settings in extras.petzval of a camera.
#pragma once

#include <optional>
#include <string>

#include "core/math/math.h"

namespace petzval::io {

/// Settings that a camera of the file asks for; io/gltf/validate/extras.h has the keys.
struct CameraExtras {
    std::optional<std::string> lens, aperture;
    std::optional<float> fstop, focus_m;
    std::optional<V2f> sensor_mm;

    [[nodiscard]] bool any() const { return lens || aperture || fstop || focus_m || sensor_mm; }
};

}  // namespace petzval::io
