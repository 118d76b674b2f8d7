// SPDX-License-Identifier: Apache-2.0
// Nodes and scenes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "io/gltf/mend/mend.h"
#include "io/gltf/schema/schema.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Distance of a rotation's length from 1 that is rounding: eight-bit normalized quaternions are
/// off by up to sqrt(4) / 2 / 127 = 0.8 %.
constexpr double kUnitTolerance = 0.01;

bool all_numbers(const json* list, size_t count) {
    if (!list || list->size() != count) return false;
    for (const json& item : *list)
        if (!item.is_number()) return false;
    return true;
}

/// The loader scales rotations to unit length; here it is only said.
void mend_rotation(const JsonEditor& node) {
    const json* rotation = node.array("rotation");
    if (!all_numbers(rotation, 4)) return;
    double square = 0;
    for (const json& component : *rotation) square += std::pow(component.get<double>(), 2);
    if (square == 0)
        node.drop("rotation", "is a quaternion of length 0; no rotation is taken");
    else if (std::abs(std::sqrt(square) - 1) > kUnitTolerance)
        node.warn("rotation", fmt::format("is a quaternion of length {:.4g}; it is scaled to 1",
                                          std::sqrt(square)));
}

/// The last row of a matrix of the glTF kind: its columns end with 0, 0, 0, 1.
void mend_last_row(const JsonEditor& node) {
    json* matrix = node.array("matrix");
    if (!all_numbers(matrix, 16)) return;
    double worst = 0;
    for (size_t column = 0; column < 4; ++column) {
        json& last = (*matrix)[4 * column + 3];
        const double wanted = column == 3 ? 1 : 0;
        worst = std::max(worst, std::abs(last.get<double>() - wanted));
        last = wanted;
    }
    if (worst > 1e-3) node.warn("matrix", "has a last row other than 0, 0, 0, 1; that is taken");
}

/// The value of a part of a transform that does nothing.
json idle(std::string_view part) {
    const GltfProperty& row = *std::ranges::find(schema::kNodeRows, part, &GltfProperty::key);
    const auto presets = presets_of(row);
    return std::vector<double>(presets.begin(), presets.begin() + row.width());
}

void mend_transform(const JsonEditor& node) {
    mend_rotation(node);
    if (!node.array("matrix")) return;
    mend_last_row(node);
    bool moves = false;
    for (const char* key : {"translation", "rotation", "scale"}) {
        const json* part = node.find(key);
        if (!part) continue;
        moves |= *part != idle(key);
        node.value().erase(key);
    }
    if (moves) node.warn("has a matrix and translation, rotation or scale; the matrix is taken");
}

/// Leaves out what is -1 in a list of indices: some exporters write it for what they skipped.
void mend_absent(const JsonEditor& owner, const char* key) {
    json* list = owner.array(key);
    if (!list) return;
    const auto kept = std::remove(list->begin(), list->end(), json(-1));
    if (kept == list->end()) return;
    owner.warn(key, "names node -1, which is none; it is left out");
    list->erase(kept, list->end());
}

/// Takes the light -1 of a node as none.
void mend_light_index(const JsonEditor& node) {
    constexpr const char* kLights = "KHR_lights_punctual";
    const auto light = node.extension(kLights);
    if (!light || !light->find("light") || *light->find("light") != -1) return;
    light->warn("light", "is -1; the node is taken as one without a light");
    node.find("extensions")->erase(kLights);
}

/// Leaves each number of a list once.
void mend_repeats(const JsonEditor& owner, const char* key, const char* what) {
    json* list = owner.array(key);
    if (!list) return;
    const auto falls = [](const json& a, const json& b) { return !(a < b); };
    if (std::adjacent_find(list->begin(), list->end(), falls) == list->end()) return;
    std::set<json> seen;
    json once = json::array();
    for (const json& item : *list)
        if (seen.insert(item).second) once.push_back(item);
    if (once.size() == list->size()) return;
    owner.warn(key, fmt::format("names a {} twice; it is taken once", what));
    *list = std::move(once);
}

/// Mends EXT_mesh_gpu_instancing: instances that are none, as exporters write them, and rotations
/// that are not said to be shares of 1.
void mend_instancing(const JsonEditor& root, const JsonEditor& node) {
    const auto many = node.extension("EXT_mesh_gpu_instancing");
    const auto attributes = many ? many->find_object("attributes") : std::nullopt;
    json* const accessors = root.array("accessors");
    if (!attributes || !accessors) return;
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
        const auto index = attributes->integer(name);
        if (!index || *index >= accessors->size() || !(*accessors)[*index].is_object()) continue;
        json& accessor = (*accessors)[*index];
        if (accessor.value("count", json()) == 0) {
            many->warn(fmt::format("has no instances in {}; the node shows nothing", name));
            node.value().erase("mesh");
            node.find("extensions")->erase("EXT_mesh_gpu_instancing");
            return;
        }
        const json type = accessor.value("componentType", json());
        if ((type != 5120 && type != 5122) || accessor.value("normalized", json()) == true)
            continue;
        if (std::string_view(name) != "ROTATION") continue;
        root.warn(fmt::format("/accessors/{}/normalized: must be true for ROTATION; it is taken so",
                              *index));
        accessor["normalized"] = true;
    }
}

void mend_node(const JsonEditor& root, const JsonEditor& node) {
    if (node.value().empty()) return;
    mend_instancing(root, node);
    mend_transform(node);
    mend_absent(node, "children");
    mend_repeats(node, "children", "node");
    mend_light_index(node);
    if (node.find("mesh")) return;
    for (const char* key : {"skin", "weights"})
        node.drop(key, "has no meaning on a node without a mesh; it is ignored");
}

}  // namespace

void mend_nodes(const JsonEditor& root) {
    root.each("nodes", [&](const JsonEditor& node) { mend_node(root, node); });
    root.each("scenes", [](const JsonEditor& scene) {
        mend_absent(scene, "nodes");
        mend_repeats(scene, "nodes", "node");
    });
}

}  // namespace petzval::io
