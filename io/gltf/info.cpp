// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/info.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

#include "io/base/json_cursor.h"
#include "io/base/json_parse.h"
#include "io/gltf/validate/extensions.h"

namespace petzval {
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

std::string describe_lights(const Scene& scene) {
    const auto count = [&](size_t kind) {
        return std::count_if(scene.lights.begin(), scene.lights.end(),
                             [&](const Light& light) { return light.index() == kind; });
    };
    uint64_t meshes = 0, triangles = 0;
    for (const Instance& instance : scene.instances) {
        if (!emits(scene, instance)) continue;
        ++meshes;
        triangles += scene.meshes[instance.mesh].triangles.size();
    }
    return fmt::format("lights: {} point, {} spot, {} directional, {}{}", count(0), count(1),
                       count(2), plural(meshes, "emissive mesh", "emissive meshes"),
                       meshes > 0 ? fmt::format(" ({})", plural(triangles, "triangle")) : "");
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

std::string describe_triangles(const Scene& scene) {
    uint64_t stored = 0, placed = 0;
    for (const Mesh& mesh : scene.meshes) stored += mesh.triangles.size();
    for (const Instance& instance : scene.instances)
        placed += scene.meshes[instance.mesh].triangles.size();
    return fmt::format("triangles: {} stored, {} placed", stored, placed);
}

void describe_contents(const GltfModel& gltf, GltfFile& file) {
    const Scene& scene = file.scene;
    auto& lines = file.contents;
    if (!gltf.typed.asset.generator.empty())
        lines.push_back("generator: " + printable(gltf.typed.asset.generator));
    lines.push_back(
        fmt::format("nodes: {}", JsonCursor(gltf.source.json, gltf.file).length("nodes")));
    lines.push_back(
        fmt::format("meshes: {}, placed {} times", scene.meshes.size(), scene.instances.size()));
    lines.push_back(describe_triangles(scene));
    lines.push_back(fmt::format("materials: {}", scene.materials.size()));
    lines.push_back(fmt::format("images: {}", scene.images.size()));
    for (size_t i = 0; i < scene.images.size(); ++i)
        lines.push_back(fmt::format("image {}: {}, {}x{}", i, named(scene.images[i].name),
                                    scene.images[i].width, scene.images[i].height));
    lines.push_back(describe_lights(scene));
    lines.push_back(fmt::format("cameras: {}", file.cameras.size()));
    for (size_t i = 0; i < file.cameras.size(); ++i)
        lines.push_back(describe_camera(i, file.cameras[i]));
}

void describe_support(const GltfModel& gltf, const GltfTally& tally, GltfFile& file) {
    file.honoured.assign(tally.honoured.begin(), tally.honoured.end());
    for (const ExtensionInFile& extension : gltf.source.extensions) {
        const bool rendered =
            extension.use == ExtensionUse::Rendered || extension.use == ExtensionUse::Approximated;
        (rendered ? file.honoured : file.ignored).push_back(printable(extension.name));
    }
    const auto ignore = [&](uint64_t count, const char* what, const char* why) {
        if (count > 0) file.ignored.push_back(fmt::format("{} ({})", plural(count, what), why));
    };
    const auto animations = gltf.source.json.find("animations");
    ignore(animations == gltf.source.json.end() ? 0 : animations->size(), "animation",
           "the stored pose is shown");
    ignore(tally.occlusion_textures, "occlusion texture", "path tracing finds occlusion itself");
    ignore(tally.ranged_lights, "light range", "light falls off with the squared distance");
    ignore(tally.idle_dispersions, "dispersion", "the material refracts nothing");
    ignore(tally.point_primitives, "point primitive", "points have no surface");
    ignore(tally.line_primitives, "line primitive", "lines have no surface");
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
    warn(tally.replaced_normals, "normal", "without a length replaced by those of the faces");
}

}  // namespace

void describe(const GltfModel& gltf, const GltfTally& tally, GltfFile& file) {
    describe_contents(gltf, file);
    describe_support(gltf, tally, file);
    append_warnings(tally, file.warnings);
}

}  // namespace petzval
