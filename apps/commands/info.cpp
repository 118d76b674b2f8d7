// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/info.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/reading_options.h"
#include "io/gltf/gltf.h"

namespace petzval {
namespace {

void print_list(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    fmt::print("{}\n", title);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
}

}  // namespace

void add_info_command(CLI::App& app) {
    struct InfoOptions {
        std::filesystem::path scene;
        ReadingOptions reading;
    };
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command =
        app.add_subcommand("info", "print what a glTF file holds and what of it is honoured");
    command->add_option("scene", options->scene, "glTF scene, .gltf or .glb")->required();
    add_reading_options(*command, options->reading);
    command->callback([options] {
        PictureBudget pictures = options->reading.pictures();
        const GltfFile file = load_gltf(options->scene, options->reading.scope(), pictures);
        print_list("holds", file.contents);
        print_list("honoured", file.honoured);
        print_list("ignored", file.ignored);
        print_list("warnings", file.warnings);
    });
}

}  // namespace petzval
