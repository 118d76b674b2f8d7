// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/display_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "io/base/error.h"
#include "io/image/display_files.h"

namespace petzval {

std::vector<CLI::Option*> add_display_options(CLI::App& app, DisplayOptions& o) {
    const auto not_empty = [](const std::string& text) {
        return text.empty() ? "is empty" : std::string();
    };
    return {app.add_option("--view", o.view,
                           "display transform of PNG and JPEG: sRGB (default), ACES, raw; with "
                           "--ocio a view of its default display, or DISPLAY/VIEW")
                ->check(not_empty),
            app.add_option("--ocio", o.config,
                           "OpenColorIO configuration for PNG and JPEG (default: the one that "
                           "$OCIO names, else Petzval's own)")
                ->check(not_empty)};
}

std::string resolve_display(DisplayOptions& o) {
    const char* from_environment = o.config.empty() ? std::getenv("OCIO") : nullptr;
    if (from_environment) o.config = from_environment;
    const bool foreign = !o.config.empty();
    try {
        // By its name first, to tell what is wrong with the configuration from what with the view.
        if (foreign) static_cast<void>(find_view("", o.config));
    } catch (const InputError& error) {
        throw CLI::ValidationError(from_environment ? "$OCIO" : "--ocio", error.what());
    }
    try {
        o.view = find_view(o.view, o.config);
    } catch (const InputError& error) {
        throw CLI::ValidationError("--view", error.what());
    }
    if (!foreign) return "";
    return fmt::format("display: view {} of {}{}", o.view, o.config.string(),
                       from_environment ? ", which $OCIO names" : "");
}

std::vector<NamedFile> input_files(const DisplayOptions& o) {
    const char* from_environment = std::getenv("OCIO");
    std::filesystem::path config = o.config;
    if (config.empty() && from_environment) config = from_environment;
    std::vector<NamedFile> files;
    if (config.empty()) return files;
    for (const auto& file : display_files(config))
        files.push_back({files.empty() ? "the OpenColorIO configuration"
                                       : "a table of the OpenColorIO configuration",
                         file});
    return files;
}

}  // namespace petzval
