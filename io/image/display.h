// SPDX-License-Identifier: Apache-2.0
// Display transform of scene-linear pictures, as assets/color/config.ocio has it.
#pragma once

#include <string>
#include <vector>

#include "io/image/picture.h"

namespace petzval {

/// Default view, the plain sRGB curve: a picture shows what its numbers say. ACES must be asked
/// for.
inline constexpr const char* kDefaultView = "sRGB";

/// Names of the views, the default one first. Throws InputError if the config is missing.
[[nodiscard]] std::vector<std::string> display_views();

/// Checks that there is a view of that name. Throws InputError, which lists the views.
void check_view(const std::string& view);

enum class AlphaUse : uint8_t {
    Keep,    ///< colours divided by alpha, and alpha as it is: for PNG
    OnBlack  ///< colours as they are, no alpha
};

/// Display picture: R, G, B (and A) of a linear picture with premultiplied alpha, times
/// 2^exposure_ev, through the view; a grey picture (Y) counts as R = G = B. Values are those a
/// display shows in [0, 1], not yet clamped. Throws InputError for an unknown view.
[[nodiscard]] PictureRows to_display(const PictureRows& linear, float exposure_ev,
                                     const std::string& view, AlphaUse alpha);

}  // namespace petzval
