// SPDX-License-Identifier: Apache-2.0
// Display transform of scene-linear pictures by OpenColorIO: as assets/color/config.ocio has it, or
// another configuration. An empty name of a configuration is Petzval's own, an empty view the
// default one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/picture/picture.h"

namespace petzval::io {

/// Default view of Petzval's configuration, the plain sRGB curve: a picture shows what its numbers
/// say. ACES must be asked for.
inline constexpr const char* kDefaultView = "sRGB";

/// Names of the views, the default one first: VIEW of the default display, DISPLAY/VIEW of others.
/// Throws InputError if the configuration is missing.
[[nodiscard]] std::vector<std::string> display_views(const std::filesystem::path& config = {});

/// Name of the view that a text means, as display_views() has it: the case need not agree, nor need
/// a view of a single other display name it. Checks that pixels can go through it. Throws
/// InputError, which lists the views.
[[nodiscard]] std::string find_view(const std::string& text,
                                    const std::filesystem::path& config = {});

enum class AlphaUse : uint8_t {
    Keep,    ///< colours divided by alpha, and alpha as it is: for PNG
    OnBlack  ///< colours as they are, no alpha
};

/// Display picture: R, G, B (and A) of a linear picture with premultiplied alpha, times
/// 2^exposure_ev, through the view; a grey picture (Y) counts as R = G = B. Values are those a
/// display shows in [0, 1], not yet clamped. Throws InputError for an unknown view.
[[nodiscard]] PictureRows to_display(const PictureRows& linear, float exposure_ev,
                                     const std::string& view, AlphaUse alpha,
                                     const std::filesystem::path& config = {});

/// Display picture of one that holds values for a display already (Picture::for_display): its R, G
/// and B, or Y as each of them, and its A. Throws InputError where it has none of these colours.
[[nodiscard]] PictureRows as_display(const PictureRows& shown);

}  // namespace petzval::io
