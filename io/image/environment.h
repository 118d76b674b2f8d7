// SPDX-License-Identifier: Apache-2.0
// An environment picture on disk as a sky.
#pragma once

#include <filesystem>

#include "core/scene/sky.h"
#include "io/base/notice.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// Sky from an equirectangular Radiance (.hdr) or OpenEXR (.exr) picture, linear sRGB in nits or
/// grey (Y). rotate_deg turns it about +y, counter-clockwise seen from above; strength multiplies
/// it. Values below zero become 0, a picture not twice as wide as high is stretched; notice gets
/// one line for each. Throws InputError for any other file and for a texel that is not finite,
/// which it names, and where the budget is too small.
[[nodiscard]] Sky load_sky(const std::filesystem::path&, float rotate_deg, float strength,
                           const Notice& notice, PictureBudget&);

}  // namespace petzval::io
