// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/output_checks.h"

#include "apps/cli/keep_options.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"

namespace petzval {

std::string complaint_about_picture_name(const std::string& name) {
    try {
        static_cast<void>(picture_format(name));
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

std::string complaint_about_render_name(const std::string& name) {
    return is_state_name(name) ? "" : complaint_about_picture_name(name);
}

std::string complaint_about_display_name(const std::string& name) {
    const std::string complaint = complaint_about_picture_name(name);
    if (complaint.empty() && picture_format(name) == PictureFormat::Exr)
        return name + ": a view is written as .png, .jpg or .jpeg";
    return complaint;
}

}  // namespace petzval
