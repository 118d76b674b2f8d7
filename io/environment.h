// SPDX-License-Identifier: Apache-2.0
// An environment picture on disk as a sky.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/sky.h"

namespace petzval {

struct SkyFile {
    Sky sky;
    std::vector<std::string> warnings;  ///< one line each
};

/// Equirectangular Radiance (.hdr) or OpenEXR (.exr) picture, linear sRGB in nits or grey (Y).
/// rotate_deg turns it about +y, counter-clockwise seen from above; strength multiplies it. Values
/// below zero become 0 with a warning, a picture not twice as wide as high has one too. Throws
/// InputError for any other file and for a texel that is not finite, which it names.
[[nodiscard]] SkyFile load_sky(const std::filesystem::path&, float rotate_deg, float strength);

}  // namespace petzval
