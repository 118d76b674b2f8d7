// SPDX-License-Identifier: Apache-2.0
// Checks of what the command line says about pictures, in the form that CLI11 asks for: what is
// wrong, or an empty text.
#pragma once

#include <string>

namespace petzval {

/// Complaint about the name of a picture to write.
[[nodiscard]] std::string complaint_about_picture_name(const std::string&);
/// Complaint about the name of a picture, or of a state, to write.
[[nodiscard]] std::string complaint_about_render_name(const std::string&);
/// Complaint about the name of a picture to write for a display: no EXR.
[[nodiscard]] std::string complaint_about_display_name(const std::string&);

}  // namespace petzval
