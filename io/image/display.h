// SPDX-License-Identifier: Apache-2.0
// From scene-linear light to what a display is sent, as assets/color/config.ocio says.
#pragma once

#include <string>
#include <vector>

#include "io/image/picture.h"

namespace petzval {

/// The plain sRGB curve: a picture shows what its numbers say, ACES is a look that one asks for.
inline constexpr const char* kDefaultView = "sRGB";

/// The views that there are, the default one first. Throws InputError if the config is missing.
[[nodiscard]] std::vector<std::string> display_views();

/// Throws InputError, naming the views there are, for any other.
void check_view(const std::string& view);

enum class AlphaUse : uint8_t {
    Keep,    ///< colours divided by alpha, and alpha as it is: for PNG
    OnBlack  ///< colours as they are, no alpha
};

/// R, G, B (and A) of a linear picture with premultiplied alpha, times 2^exposure_ev, through the
/// view; a grey picture (Y) counts as R = G = B. Values are those a display shows in [0, 1], not
/// yet clamped. Throws InputError for an unknown view.
[[nodiscard]] PictureRows to_display(const PictureRows& linear, float exposure_ev,
                                     const std::string& view, AlphaUse alpha);

}  // namespace petzval
