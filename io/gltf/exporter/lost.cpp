// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/exporter/lost.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "io/base/ascii.h"
#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

bool is_from_blender(const json& root) {
    return lower(text_of(member(root, "asset"), "generator")).find("blender") != std::string::npos;
}

const json& lights_of(const json& root) {
    return member(member(member(root, "extensions"), "KHR_lights_punctual"), "lights");
}

std::string counted(uint64_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

bool says(const json& owner, const char* key) {
    return !member(member(member(owner, "extras"), "petzval"), key).is_null();
}

std::set<uint64_t> joints_of(const json& root) {
    std::set<uint64_t> joints;
    for (const json& skin : member(root, "skins"))
        for (const json& joint : member(skin, "joints")) joints.insert(joint.get<uint64_t>());
    return joints;
}

bool is_empty(const json& node) {
    return std::none_of(node.items().begin(), node.items().end(), [](const auto& item) {
        const std::string& key = item.key();
        return key == "mesh" || key == "camera" || key == "skin" || key == "extensions" ||
               (key == "children" && !item.value().empty());
    });
}

// The first names of nodes, and how many more there are.
std::string names_of(const json& root, const std::vector<int>& nodes) {
    constexpr size_t most = 5;
    std::string text;
    for (size_t i = 0; i < std::min(most, nodes.size()); ++i) {
        const std::string name =
            text_of(member(root, "nodes")[static_cast<size_t>(nodes[i])], "name");
        text += fmt::format("{}{} \"{}\"", text.empty() ? "" : ", ", nodes[i], printable(name));
    }
    return nodes.size() > most ? fmt::format("{} and {} more", text, nodes.size() - most) : text;
}

void add_empty_nodes(const json& root, std::span<const int> shown,
                     std::vector<std::string>& lines) {
    const std::set<uint64_t> joints = joints_of(root);
    std::vector<int> lamps, others;
    for (const int number : shown) {
        const json& node = member(root, "nodes")[static_cast<size_t>(number)];
        if (!is_empty(node) || says(node, "area") || joints.contains(uint64_t(number))) continue;
        const bool by_name = lower(text_of(node, "name")).find("area") != std::string::npos;
        (by_name ? lamps : others).push_back(number);
    }
    constexpr const char* remedy =
        "a custom property of the object makes one: {\"petzval\": {\"area\": [width, height], "
        "\"intensity_cd\": ...}}";
    if (!lamps.empty())
        lines.push_back(fmt::format("area lamps: by their names, empty nodes were some: {}; {}",
                                    names_of(root, lamps), remedy));
    if (!others.empty())
        lines.push_back(
            fmt::format("perhaps area lamps: the exporter writes them as empty nodes, "
                        "as it does Empties: {}{}",
                        names_of(root, others), lamps.empty() ? fmt::format("; {}", remedy) : ""));
}

void add_lamps(const json& root, std::vector<std::string>& lines) {
    const json& lights = lights_of(root);
    if (lights.empty()) {
        lines.emplace_back(
            "lamps, if there were any: they are written with Include > Punctual Lights only");
        return;
    }
    uint64_t suns = 0, points = 0;
    for (const json& light : lights) {
        const bool is_sun = text_of(light, "type") == "directional";
        suns += is_sun && !says(light, "angle_deg");
        points += !is_sun && !says(light, "radius_m") &&
                  member(member(light, "extras"), "radius").is_null();
    }
    if (suns > 0)
        lines.push_back(fmt::format(
            "the angle of {}: shadows are sharp; {{\"petzval\": {{\"angle_deg\": 0.53}}}} as a "
            "custom property of the light's data gives it",
            counted(suns, "sun")));
    if (points > 0)
        lines.push_back(fmt::format(
            "the radius of {}: shadows are sharp, and the lamp is not seen; a custom property "
            "radius of the light's data gives it, in metres",
            counted(points, "point or spot lamp")));
}

void add_cameras(const json& root, std::vector<std::string>& lines) {
    const json& cameras = member(root, "cameras");
    if (cameras.empty()) {
        lines.emplace_back(
            "cameras, if there were any: they are written with Include > Cameras only");
        return;
    }
    const auto count = std::count_if(cameras.begin(), cameras.end(), [](const json& camera) {
        return text_of(camera, "type") == "perspective" && !says(camera, "lens") &&
               !says(camera, "fstop");
    });
    if (count > 0)
        lines.push_back(fmt::format("depth of field of {}: ⟨lens⟩, ⟨fstop⟩ and ⟨focus⟩ give it",
                                    counted(static_cast<uint64_t>(count), "camera")));
}

}  // namespace

std::vector<std::string> lost_by_exporter(const json& root, std::span<const int> shown,
                                          bool has_sky) {
    std::vector<std::string> lines;
    if (!is_from_blender(root)) return lines;
    add_empty_nodes(root, shown, lines);
    add_lamps(root, lines);
    if (!has_sky)
        lines.emplace_back("the world: the exporter writes none; ⟨env⟩ SKY.hdr gives one");
    add_cameras(root, lines);
    const json& used = member(root, "extensionsUsed");
    if (std::find(used.begin(), used.end(), "KHR_node_visibility") == used.end())
        lines.emplace_back(
            "that objects were hidden: the exporter writes them as if they were seen, unless "
            "Include > Visible Objects or Renderable Objects is ticked");
    return lines;
}

std::string lamp_unit_doubt(const json& root) {
    if (!is_from_blender(root) || lights_of(root).empty()) return "";
    return "Blender wrote the file: with its exporter's Lighting Mode \"Standard\", the default, "
           "lamps are 683 times too bright beside emissive surfaces; export with \"Unitless\" "
           "(Data > Lighting)";
}

}  // namespace petzval::io
