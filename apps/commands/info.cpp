// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/info.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

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
    auto path = std::make_shared<std::filesystem::path>();
    CLI::App* command =
        app.add_subcommand("info", "print what a glTF file holds and what of it is honoured");
    command->add_option("scene", *path, "glTF scene, .gltf or .glb")->required();
    command->callback([path] {
        const GltfFile file = load_gltf(*path);
        print_list("holds", file.contents);
        print_list("honoured", file.honoured);
        print_list("ignored", file.ignored);
        print_list("warnings", file.warnings);
    });
}

}  // namespace petzval
