// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/info.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/console.h"
#include "apps/cli/reading_options.h"
#include "apps/setup/auto_focus.h"
#include "apps/setup/glass_remarks.h"
#include "io/gltf/gltf.h"

namespace petzval {
namespace {

/// Number of cameras for which the focus is looked for.
constexpr size_t kMostCameras = 10;

void print_list(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    fmt::print("{}\n", title);
    for (const std::string& line : lines) print_line("  " + line);
}

std::string bounds_line(const Box3f& b) {
    const V3f size = b.max - b.min;
    return fmt::format(
        "bounds: {:.4g} x {:.4g} x {:.4g} m, from {:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g}",
        size.x, size.y, size.z, b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
}

std::string focus_line(const std::string& camera, const FoundFocus& found) {
    return fmt::format("--focus auto{}: {}", camera,
                       found.m > 0 ? fmt::format("{:.4g} m", found.m) : found.why_none);
}

// What of a file shows only in its finished scene: where it lies, what cameras would focus on, and
// what its glass does.
void append_placement(const std::string& path, FileScope scope, GltfFile& file) {
    Scene& scene = file.scene;
    if (scene.instances.empty()) return;
    flush_denormals();
    finish_scene(scene);
    file.contents.push_back(bounds_line(scene.bounds));
    const Bvh bvh(scene, Traversal::Robust);
    for (size_t i = 0; i < file.cameras.size() && i < kMostCameras; ++i)
        if (!file.cameras[i].orthographic)
            file.contents.push_back(
                focus_line(fmt::format(", camera {}", i),
                           find_auto_focus(&file.cameras[i], path, scope, scene, bvh)));
    if (file.cameras.empty())
        file.contents.push_back(focus_line("", find_auto_focus(nullptr, path, scope, scene, bvh)));
    for (std::string& remark : glass_remarks(scene, lost_light(scene, bvh)))
        file.warnings.push_back(std::move(remark));
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
        GltfFile file =
            load_gltf(options->scene, options->reading.scope(), pictures, options->reading.choice);
        append_placement(options->scene.string(), options->reading.scope(), file);
        print_list("holds", file.contents);
        print_list("honoured", file.honoured);
        print_list("ignored", file.ignored);
        print_list("warnings", file.warnings);
    });
}

}  // namespace petzval
