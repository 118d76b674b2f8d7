// SPDX-License-Identifier: Apache-2.0
// The options of petzval render that are about the camera and its lens.
#pragma once

#include "apps/setup/request.h"

namespace CLI {
class App;
}

namespace petzval {

/// As given; resolve() reads the texts.
struct CameraOptions {
    CameraRequest request;
    std::string look_at, sensor, focus, shutter;
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_camera_options(CLI::App&, CameraOptions&);

/// frame: the picture, in pixels. Throws CLI::ValidationError.
[[nodiscard]] CameraRequest resolve(CameraOptions&, V2i frame);

}  // namespace petzval
