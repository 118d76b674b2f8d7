// SPDX-License-Identifier: Apache-2.0
// Colour statements of an image that glTF tells programs to ignore.
#pragma once

#include <string>

namespace petzval::io {

struct ColourRemarks {
    bool inks = false;  ///< its texels were made of CMYK, by the simplest formula
    /// Colour space that the file says it is in, where that is not sRGB: "the profile Adobe RGB
    /// (1998)". glTF takes it for sRGB all the same (glTF 2.0, section 3.8.3).
    std::string other_space;
};

}  // namespace petzval::io
