// SPDX-License-Identifier: Apache-2.0
// Photometric files of the Illuminating Engineering Society, LM-63 (1986 to 2019).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/light_profile.h"

namespace petzval::io {

struct IesFile {
    LightProfile profile;
    std::vector<std::string> remarks;  ///< what of the file is not rendered, in words
};

/// Profile of a file's text: photometry of type C or B, with the symmetries that its angles stand
/// for written out. Intensities are the file's times its candela multiplier and its ballast
/// factor, and up to LM-63-1995 the ballast-lamp photometric factor. file, place: for messages,
/// which also name the line. Throws InputError for what is no such file, and for type A.
[[nodiscard]] IesFile parse_ies(std::string_view text, const std::string& file,
                                const std::string& place);

}  // namespace petzval::io
