// SPDX-License-Identifier: Apache-2.0
// Labels of a contact sheet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/picture/picture.h"

namespace petzval::io {

/// Size of letters at which the widest of these labels is as wide as a cell: letter_px where it
/// fits as it is, and never so small that it cannot be read.
[[nodiscard]] int fitting_letters_px(const std::vector<std::string>& labels, int letter_px,
                                     int width_px, const std::filesystem::path& font);

/// Letters of a label as draw_text() has them, at most width_px wide: of one that is too long the
/// beginning and an ellipsis.
[[nodiscard]] Picture fitting_label(const std::string& utf8, int letter_px, int width_px,
                                    const std::filesystem::path& font);

}  // namespace petzval::io
