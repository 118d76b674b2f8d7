// SPDX-License-Identifier: Apache-2.0
// Camera and lens options of petzval render.
#pragma once

#include "apps/cli/time_options.h"
#include "apps/setup/request.h"

namespace CLI {
class App;
}

namespace petzval {

/// Camera options as given; resolve() reads the texts.
struct CameraOptions {
    CameraRequest request;
    std::string look_at, orbit_about, sensor, focus, shutter, shutter_curve;
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_camera_options(CLI::App&, CameraOptions&);

/// Camera request with its texts read. frame: size of the picture in pixels. Throws
/// CLI::ValidationError, and InputError for the file of a shutter curve.
[[nodiscard]] CameraRequest resolve(CameraOptions&, V2i frame, const TimeOptions&);

}  // namespace petzval
