// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/info.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/console.h"
#include "apps/cli/field_options.h"
#include "apps/commands/info_report.h"
#include "apps/setup/camera/camera_model.h"
#include "apps/setup/glass_remarks.h"
#include "io/base/error.h"
#include "io/gltf/info.h"

namespace petzval::apps {
namespace {

/// Number of cameras for which the focus is looked for.
constexpr size_t kMostCameras = 10;

struct InfoOptions {
    RenderOrder order;
    bool json = false;
};

// What of a file shows only in its finished scene: where it lies, what cameras would focus on, and
// what its glass does.
void append_placement(io::FileScope scope, InfoReport& report) {
    io::GltfFile& file = report.file;
    Scene& scene = file.scene;
    if (scene.instances.empty()) return;
    flush_denormals();
    finish_scene(scene);
    report.bounds = scene.bounds;
    const Bvh bvh(scene, Traversal::Robust);
    report.bvh_bytes = bvh.bytes();
    const auto find = [&](const io::GltfCamera* camera) {
        report.focus.push_back(find_auto_focus(camera, report.path.string(), scope, scene, bvh));
    };
    for (size_t i = 0; i < file.cameras.size() && i < kMostCameras; ++i)
        file.cameras[i].orthographic ? void(report.focus.emplace_back()) : find(&file.cameras[i]);
    if (file.cameras.empty()) find(nullptr);
    for (std::string& remark : glass_remarks(scene, integrator::lost_light(scene, bvh)))
        file.warnings.push_back(std::move(remark));
}

// The extensions of a file that was refused for one of them; none where something else is wrong.
std::vector<io::ExtensionInFile> refused_extensions(const std::filesystem::path& scene) {
    try {
        std::vector<io::ExtensionInFile> all = io::read_gltf_extensions(scene);
        for (const io::ExtensionInFile& one : all)
            if (one.refused()) return all;
    } catch (const io::InputError&) {  // the error of the reading itself is told
    }
    return {};
}

void tell_refusal(const InfoOptions& o, const std::string& error) {
    const std::vector<io::ExtensionInFile> extensions =
        refused_extensions(o.order.render.scene.scene);
    if (o.json) {
        print_refusal_json(o.order.render.scene.scene, error, extensions);
    } else if (!extensions.empty()) {
        fmt::print("extensions\n");
        for (const std::string& line : io::table_of(extensions)) print_line("  " + line);
    }
}

void info_command(const InfoOptions& o) {
    check(o.order.render);
    const SceneRequest scene = resolved_scene(o.order.render);
    io::PictureBudget pictures = scene.pictures();
    io::GltfChoices choices = scene.choices;
    choices.checks_all_animations = true;
    InfoReport report;
    report.path = scene.scene;
    report.variant = choices.variant;
    try {
        report.file = io::load_gltf(scene.scene, scene.scope, pictures, choices);
        check_camera_files(scene.scene, scene.scope, report.file.cameras);
    } catch (const io::ArgumentError&) {
        throw;
    } catch (const io::InputError& error) {
        tell_refusal(o, error.what());
        throw;
    }
    append_placement(scene.scope, report);
    o.json ? print_info_json(report) : print_info(report);
}

}  // namespace

void add_info_command(CLI::App& app) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command =
        app.add_subcommand("info", "print what a glTF file holds and what of it is honoured");
    command->add_flag("--json", options->json, "print it for programs");
    add_field_options(*command, options->order, kInfo);
    command->callback([options] { info_command(*options); });
}

}  // namespace petzval::apps
