// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/base/json_parse.h"
#include "io/gltf/schema/extensions.h"

namespace petzval::io {
namespace {

std::string plural(uint64_t count, std::string_view one, std::string_view more) {
    return fmt::format("{} {}", count, count == 1 ? one : more);
}

std::string plural(uint64_t count, std::string_view what) {
    return plural(count, what, fmt::format("{}s", what));
}

std::string named(const std::string& name) {
    return name.empty() ? "(unnamed)" : printable(name);
}

std::string describe(const GltfSummary::Lights& lights) {
    return fmt::format(
        "lights: {} point, {} spot, {} directional{}{}{}, {}{}", lights.point, lights.spot,
        lights.directional,
        lights.balls > 0 ? fmt::format(" ({} with a radius)", lights.balls) : "",
        lights.flat > 0 ? fmt::format(", {} with an area", lights.flat) : "",
        lights.profiles > 0 ? fmt::format(", {} by IES profiles", lights.profiles) : "",
        plural(lights.emissive_meshes, "emissive mesh", "emissive meshes"),
        lights.emissive_meshes > 0
            ? fmt::format(" ({})", plural(lights.emissive_triangles, "triangle"))
            : "");
}

std::string describe_extras(const CameraExtras& extras) {
    std::string text;
    if (extras.lens) text += ", lens " + printable(*extras.lens);
    if (extras.fstop) text += fmt::format(", f/{:g}", *extras.fstop);
    if (extras.focus_m) text += fmt::format(", focus {:g} m", *extras.focus_m);
    if (extras.aperture) text += ", iris " + printable(*extras.aperture);
    if (extras.sensor_mm)
        text += fmt::format(", sensor {:g} x {:g} mm", extras.sensor_mm->x, extras.sensor_mm->y);
    return text;
}

std::string describe_camera(size_t index, const GltfCamera& camera) {
    const std::string head = fmt::format("camera {}: {}, ", index, named(camera.name));
    if (camera.orthographic)
        return head +
               fmt::format("orthographic, {:g} x {:g} m", 2 * camera.xmag_m, 2 * camera.ymag_m);
    const std::string aspect =
        camera.aspect ? fmt::format(", aspect {:.4g}", *camera.aspect) : std::string();
    return head + fmt::format("perspective, {:.4g} deg vertical", camera.yfov_rad * 180 / kPi) +
           aspect + describe_extras(camera.extras);
}

// Number of things, and a line for each with its name.
void list_names(const char* one, const char* more, const std::vector<std::string>& names,
                std::vector<std::string>& lines) {
    constexpr size_t kMost = 100;
    if (names.empty()) return;
    lines.push_back(fmt::format("{}: {}", more, names.size()));
    for (size_t i = 0; i < std::min(kMost, names.size()); ++i)
        lines.push_back(fmt::format("{} {}: {}", one, i, named(names[i])));
}

void describe_animations(const GltfSummary& holds, std::vector<std::string>& lines) {
    if (holds.animation_count == 0) return;
    lines.push_back(fmt::format("animations: {}", holds.animation_count));
    for (size_t i = 0; i < holds.animations.size(); ++i) {
        const GltfSummary::Animation& one = holds.animations[i];
        lines.push_back(fmt::format(
            "animation {}: {}, {}{}", i, named(one.name), plural(one.channels, "channel"),
            one.duration_s ? fmt::format(", {:.4g} s", *one.duration_s) : ""));
    }
}

void describe_contents(GltfFile& file) {
    const GltfSummary& holds = file.holds;
    auto& lines = file.contents;
    if (!holds.generator.empty()) lines.push_back("generator: " + printable(holds.generator));
    lines.push_back(fmt::format("nodes: {}", holds.nodes));
    if (holds.scenes.size() > 1) list_names("scene", "scenes", holds.scenes, lines);
    lines.push_back(
        fmt::format("meshes: {}, placed {} times", holds.meshes_stored, holds.meshes_placed));
    lines.push_back(fmt::format("triangles: {} stored, {} placed", holds.triangles_stored,
                                holds.triangles_placed));
    lines.push_back(fmt::format("materials: {}", holds.materials));
    list_names("variant", "variants", holds.variants, lines);
    lines.push_back(fmt::format("images: {}", holds.pictures.size()));
    for (size_t i = 0; i < holds.pictures.size(); ++i)
        lines.push_back(fmt::format("image {}: {}, {}x{}", i, named(holds.pictures[i].name),
                                    holds.pictures[i].width_px, holds.pictures[i].height_px));
    lines.push_back(describe(holds.lights));
    const SceneExtras& asked = file.extras;
    if (asked.sky)
        lines.push_back(fmt::format("sky: {}, turned by {:g} degrees", printable(*asked.sky),
                                    asked.sky_rotation_deg));
    if (asked.exposure_ev) lines.push_back(fmt::format("exposure: {:g} EV", *asked.exposure_ev));
    if (asked.view) lines.push_back("view: " + printable(*asked.view));
    describe_animations(holds, lines);
    lines.push_back(fmt::format("cameras: {}", file.cameras.size()));
    for (size_t i = 0; i < file.cameras.size(); ++i)
        lines.push_back(describe_camera(i, file.cameras[i]));
}

void describe_support(const GltfModel& gltf, const GltfTally& tally, GltfFile& file) {
    file.honoured.assign(tally.honoured.begin(), tally.honoured.end());
    const auto ignore = [&](uint64_t count, const char* what, const char* why) {
        if (count > 0) file.ignored.push_back(fmt::format("{} ({})", plural(count, what), why));
    };
    if (gltf.source.clips.empty())
        ignore(file.holds.animation_count, "animation",
               "the stored pose is shown; ⟨at⟩ TIME plays them");
    else
        ignore(file.holds.animation_count - gltf.source.clips.size(), "animation",
               "⟨animation⟩ plays them");
    ignore(tally.occlusion_textures, "occlusion texture", "path tracing finds occlusion itself");
    ignore(tally.scattering_volumes, "scattering volume", "light goes straight through them");
    ignore(tally.ranged_lights, "light range", "light falls off with the squared distance");
    ignore(tally.idle_dispersions, "dispersion", "the material refracts nothing");
    constexpr const char* no_surface = "they have no surface; ⟨point-line-radius⟩ gives one";
    ignore(tally.point_primitives, "point primitive", no_surface);
    ignore(tally.line_primitives, "line primitive", no_surface);
}

/// Makes a bound that is said in two digits hold: they may be less than it by a twentieth.
constexpr double kRoundedUp = 1.05;

// Tells what moves while the shutter is open, and how well that is followed.
void describe_motion(const GltfTally& tally, GltfFile& file) {
    std::string text;
    const auto add = [&](uint64_t count, std::string_view what) {
        if (count > 0) text += (text.empty() ? "" : ", ") + plural(count, what);
    };
    add(tally.moving_instances, "moving instance");
    if (tally.deforming_meshes > 0)
        text += (text.empty() ? "" : ", ") +
                plural(tally.deforming_meshes, "deforming mesh", "deforming meshes");
    add(tally.moving_lights, "moving light");
    add(tally.moving_cameras, "moving camera");
    add(tally.zooming_cameras, "zooming camera");
    const std::string unseen =
        tally.motion_unseen
            ? "; keys lie closer together than time steps, or something turns by more than half "
              "a turn between them: such motion is not seen"
            : "";
    if (text.empty() && tally.held.empty()) {
        file.remarks.emplace_back("nothing moves while the shutter is open" + unseen);
        return;
    }
    if (tally.moving_instances + tally.deforming_meshes > 0)
        text += fmt::format(
            "; between time steps, meshes are off by at most {:.2g} m, {:.2g} % of their extent",
            kRoundedUp * tally.motion_off_m, kRoundedUp * 100 * tally.motion_off);
    if (!tally.held.empty())
        text += fmt::format("{}not blurred but shown as in the middle: {}",
                            text.empty() ? "" : "; ", fmt::join(tally.held, ", "));
    file.remarks.push_back("while the shutter is open: " + text + unseen);
}

// Tells which moment of which animations is shown.
void describe_time(const GltfModel& gltf, const GltfTally& tally,
                   const std::optional<AnimationChoice>& animation, GltfFile& file) {
    const uint64_t count = file.holds.animation_count;
    if (!animation) {
        if (count > 0)
            file.remarks.push_back(
                fmt::format("the file holds {}; the pose that it stores is shown (⟨at⟩ 1s shows "
                            "that moment)",
                            plural(count, "animation")));
        return;
    }
    if (count == 0)
        file.remarks.emplace_back("the file holds no animation, so that ⟨at⟩ changes nothing");
    for (const GltfClip& clip : gltf.source.clips) {
        const double local_s =
            clip.local_s(animation->time_s, animation->time_s, animation->repeats);
        file.remarks.push_back(fmt::format("animation: {} at {:.6g} s of {:.6g}", named(clip.name),
                                           local_s, clip.duration_s));
        file.honoured.push_back("animation " + named(clip.name));
    }
    if (animation->open_s > 0) describe_motion(tally, file);
    if (count > gltf.source.clips.size() && animation->names.empty())
        file.remarks.push_back(fmt::format(
            "{} not played, as they move the same things (⟨animation⟩ NAME plays one)",
            plural(count - gltf.source.clips.size(), "more animation is", "more animations are")));
}

void append_warnings(const GltfTally& tally, std::vector<std::string>& warnings) {
    const auto lines = tally.warnings.lines();
    warnings.insert(warnings.end(), lines.begin(), lines.end());
    const auto warn = [&](uint64_t count, const char* what, const char* outcome) {
        if (count > 0) warnings.push_back(plural(count, what) + " " + outcome);
    };
    warn(tally.zero_area_triangles, "triangle", "without area skipped");
    warn(tally.point_primitives + tally.line_primitives, "point or line primitive", "skipped");
    warn(tally.primitives_without_positions, "primitive", "without positions skipped");
    warn(tally.incomplete_primitives, "primitive",
         "with vertices left over after the last whole triangle");
    warn(tally.broken_triangles, "triangle", "with a corner that is not a finite number skipped");
    warn(tally.broken_values, "texture coordinate or colour",
         "that is not a finite number replaced by 0 or 1");
    warn(tally.unmapped_primitives, "primitive",
         "without texture coordinates for its textures; 0,0 is taken");
    warn(tally.singular_nodes, "node", "scaled to nothing skipped");
    warn(tally.hidden_instances, "instance", "scaled to nothing, or nowhere, skipped");
    warn(tally.broken_strokes, "point or line segment", "without a finite place skipped");
    warn(tally.replaced_normals, "normal", "without a length replaced by those of the faces");
}

}  // namespace

void describe(const GltfModel& gltf, const GltfTally& tally,
              const std::optional<AnimationChoice>& animation, GltfFile& file) {
    file.holds = summarise(gltf, tally, file.scene);
    describe_contents(file);
    describe_support(gltf, tally, file);
    describe_time(gltf, tally, animation, file);
    append_warnings(tally, file.warnings);
}

std::string word_of(const ExtensionInFile& extension) {
    if (extension.refused()) return "refused";
    switch (extension.use) {
        case ExtensionUse::Rendered:
            return "rendered";
        case ExtensionUse::Approximated:
            return "approximated";
        default:
            return "ignored";
    }
}

std::vector<std::string> table_of(const std::vector<ExtensionInFile>& extensions) {
    size_t width = 0;
    for (const ExtensionInFile& one : extensions)
        width = std::max(width, printable(one.name).size());
    std::vector<std::string> lines;
    for (const ExtensionInFile& one : extensions) {
        std::string rest = one.required ? "required" : "";
        if (one.objects > 0)
            rest += (rest.empty() ? "" : ", ") + ("in " + plural(one.objects, "object"));
        if (!one.effect.empty()) rest += (rest.empty() ? "" : ": ") + one.effect;
        std::string line =
            fmt::format("{:{}}  {:12}  {}", printable(one.name), width, word_of(one), rest);
        line.erase(line.find_last_not_of(' ') + 1);
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace petzval::io
