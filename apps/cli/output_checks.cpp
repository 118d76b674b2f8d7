// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/output_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/base/error.h"
#include "io/image/display.h"

namespace petzval {

std::string complaint_about_picture_name(const std::string& name) {
    try {
        static_cast<void>(picture_format(name));
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

std::string complaint_about_display_name(const std::string& name) {
    const std::string complaint = complaint_about_picture_name(name);
    if (complaint.empty() && picture_format(name) == PictureFormat::Exr)
        return name + ": a view is written as .png, .jpg or .jpeg";
    return complaint;
}

std::string complaint_about_view(const std::string& name) {
    const std::vector<std::string> views = display_views();
    if (std::find(views.begin(), views.end(), name) != views.end()) return "";
    return fmt::format("there is no view \"{}\"; there are {}", name, fmt::join(views, ", "));
}

}  // namespace petzval
