// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/cli/or_null.h"
#include "apps/commands/info_report.h"
#include "apps/request/option_text.h"
#include "io/gltf/info.h"

namespace petzval::apps {
namespace {

using nlohmann::ordered_json;

ordered_json head_of(const std::filesystem::path& path) {
    return {{"schema", "petzval.info"}, {"version", 1}, {"file", path.string()}};
}

ordered_json json_of(const std::vector<io::ExtensionInFile>& extensions) {
    ordered_json list = ordered_json::array();
    for (const io::ExtensionInFile& one : extensions)
        list.push_back({{"name", one.name},
                        {"use", io::word_of(one)},
                        {"changes_picture", one.use != io::ExtensionUse::Rendered &&
                                                one.use != io::ExtensionUse::Harmless},
                        {"effect", one.effect},
                        {"objects", one.objects},
                        {"required", one.required}});
    return list;
}

ordered_json json_of(const std::vector<io::GltfSummary::Animation>& animations) {
    ordered_json list = ordered_json::array();
    for (const io::GltfSummary::Animation& one : animations)
        list.push_back({{"name", one.name},
                        {"channels", one.channels},
                        {"duration_s", or_null(one.duration_s)}});
    return list;
}

ordered_json json_of(const std::vector<io::GltfSummary::Picture>& pictures) {
    ordered_json list = ordered_json::array();
    for (const io::GltfSummary::Picture& one : pictures)
        list.push_back({{"name", one.name},
                        {"size_px", {one.width_px, one.height_px}},
                        {"memory_bytes", one.bytes}});
    return list;
}

ordered_json json_of(const io::GltfSummary::Lights& lights) {
    return {{"point", lights.point},
            {"spot", lights.spot},
            {"directional", lights.directional},
            {"with_radius", lights.balls},
            {"with_area", lights.flat},
            {"profiles", lights.profiles},
            {"emissive_meshes", lights.emissive_meshes},
            {"emissive_triangles", lights.emissive_triangles}};
}

ordered_json json_of(const FoundFocus& focus) {
    return focus.m > 0 ? ordered_json(focus.m) : ordered_json(nullptr);
}

ordered_json json_of(const io::GltfCamera& camera) {
    constexpr double kDegrees_per_rad = 180 / static_cast<double>(kPi);
    ordered_json out{{"name", camera.name},
                     {"type", camera.orthographic ? "orthographic" : "perspective"}};
    if (camera.orthographic)
        out["size_m"] = {2 * camera.xmag_m, 2 * camera.ymag_m};
    else
        out["fov_deg"] = camera.yfov_rad * kDegrees_per_rad;
    out["aspect"] = or_null(camera.aspect);
    out["lens"] = or_null(camera.extras.lens);
    out["fstop"] = or_null(camera.extras.fstop);
    out["focus_m"] = or_null(camera.extras.focus_m);
    return out;
}

ordered_json cameras_of(const InfoReport& report) {
    ordered_json list = ordered_json::array();
    const auto& cameras = report.file.cameras;
    for (size_t i = 0; i < cameras.size(); ++i) {
        ordered_json one = json_of(cameras[i]);
        one["auto_focus_m"] = i < report.focus.size() ? json_of(report.focus[i]) : nullptr;
        list.push_back(std::move(one));
    }
    return list;
}

ordered_json json_of(const V3f& v) {
    return {v.x, v.y, v.z};
}

// JSON whose texts spell fields as options.
ordered_json spelled(const ordered_json& json) {
    if (json.is_string()) return as_options(json.get<std::string>());
    ordered_json out = json;
    if (json.is_structured())
        for (auto& [key, value] : out.items()) value = spelled(value);
    return out;
}

void print(const ordered_json& json) {
    const ordered_json out = spelled(json);
    // Names of files need not be UTF-8, and names in files may hold anything.
    fmt::print("{}\n", out.dump(2, ' ', true, ordered_json::error_handler_t::replace));
}

}  // namespace

void print_info_json(const InfoReport& report) {
    const io::GltfFile& file = report.file;
    const io::GltfSummary& holds = file.holds;
    uint64_t picture_bytes = 0;
    for (const io::GltfSummary::Picture& one : holds.pictures) picture_bytes += one.bytes;
    ordered_json out = head_of(report.path);
    out["error"] = nullptr;
    out["generator"] = holds.generator;
    out["extensions"] = json_of(holds.extensions);
    out["scenes"] = holds.scenes;
    out["variants"] = holds.variants;
    out["variant"] = or_null(report.variant);
    out["animation_count"] = holds.animation_count;
    out["animations"] = json_of(holds.animations);
    out["cameras"] = cameras_of(report);
    out["auto_focus_m"] =
        file.cameras.empty() && !report.focus.empty() ? json_of(report.focus[0]) : nullptr;
    out["nodes"] = holds.nodes;
    out["meshes"] = {{"stored", holds.meshes_stored}, {"placed", holds.meshes_placed}};
    out["triangles"] = {{"stored", holds.triangles_stored}, {"placed", holds.triangles_placed}};
    out["materials"] = holds.materials;
    out["images"] = json_of(holds.pictures);
    out["lights"] = json_of(holds.lights);
    out["scene_extras"] = {{"sky", or_null(file.extras.sky)},
                           {"sky_rotation_deg", file.extras.sky_rotation_deg},
                           {"exposure_ev", or_null(file.extras.exposure_ev)},
                           {"view", or_null(file.extras.view)}};
    out["memory_bytes"] = {
        {"meshes", holds.mesh_bytes}, {"images", picture_bytes}, {"bvh", report.bvh_bytes}};
    out["bounds_m"] = nullptr;
    if (report.bounds)
        out["bounds_m"] = {{"min", json_of(report.bounds->min)},
                           {"max", json_of(report.bounds->max)}};
    out["honoured"] = file.honoured;
    out["ignored"] = file.ignored;
    out["probably_lost"] = file.lost;
    out["warnings"] = file.warnings;
    print(out);
}

void print_refusal_json(const std::filesystem::path& path, const std::string& error,
                        const std::vector<io::ExtensionInFile>& extensions) {
    ordered_json out = head_of(path);
    out["error"] = error;
    out["extensions"] = json_of(extensions);
    print(out);
}

}  // namespace petzval::apps
