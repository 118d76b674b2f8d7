// SPDX-License-Identifier: Apache-2.0
// Settings in extras.petzval of a scene.
#pragma once

#include <optional>
#include <string>

namespace petzval::io {

/// Settings that a scene of the file asks for; io/gltf/validate/extras.h has the keys.
struct SceneExtras {
    std::string path;                ///< of the extras in the JSON
    std::optional<std::string> sky;  ///< a picture beside the file
    float sky_rotation_deg = 0;      ///< as --env-rotate
    std::optional<float> exposure_ev;
    std::optional<std::string> view;
};

}  // namespace petzval::io
