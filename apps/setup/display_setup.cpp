// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/display_setup.h"

#include <fmt/format.h>

#include <cstdlib>

#include "apps/request/value_error.h"
#include "io/image/display.h"
#include "io/image/display_files.h"

namespace petzval::apps {

std::string resolve_display(DisplayRequest& o) {
    const char* from_environment = o.config.empty() ? std::getenv("OCIO") : nullptr;
    if (from_environment) o.config = from_environment;
    const bool foreign = !o.config.empty();
    try {
        // By its name first, to tell what is wrong with the configuration from what with the view.
        if (foreign) static_cast<void>(io::find_view("", o.config));
    } catch (const io::InputError& error) {
        throw ValueError(from_environment ? "$OCIO" : "⟨ocio⟩", error.what());
    }
    std::string view;
    try {
        view = io::find_view(o.view, o.config);
    } catch (const io::InputError& error) {
        throw ValueError("⟨view⟩", error.what());
    }
    if (!foreign) return "";
    return fmt::format("display: view {} of {}{}", view, o.config.string(),
                       from_environment ? ", which $OCIO names" : "");
}

std::vector<io::NamedFile> input_files(const DisplayRequest& o) {
    const char* from_environment = std::getenv("OCIO");
    std::filesystem::path config = o.config;
    if (config.empty() && from_environment) config = from_environment;
    std::vector<io::NamedFile> files;
    if (config.empty()) return files;
    for (const auto& file : io::display_files(config))
        files.push_back({files.empty() ? "the OpenColorIO configuration"
                                       : "a table of the OpenColorIO configuration",
                         file});
    return files;
}

}  // namespace petzval::apps
