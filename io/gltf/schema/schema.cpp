// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/schema/schema.h"

namespace petzval::io {
namespace {

using namespace schema;

/// Where the things of a table stand in a file.
struct Things {
    std::string_view list;
    std::span<const GltfProperty> table;
};

constexpr Things kThings[] = {
    {"nodes", kNodeRows},
    {"meshes", kMeshRows},
    {"cameras", kCameraRows},
    {"materials", kMaterialRows},
    {"extensions/KHR_lights_punctual/lights", kLightRows},
    {"extensions/EXT_lights_image_based/lights", kImageLightRows},
};

bool is_number(std::string_view word) {
    return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

/// Takes a beginning away, where the text has it and a slash behind.
bool take(std::string_view& text, std::string_view beginning) {
    if (!text.starts_with(beginning) || text.substr(beginning.size(), 1) != "/") return false;
    text.remove_prefix(beginning.size() + 1);
    return true;
}

const GltfProperty* find(std::span<const GltfProperty> table, std::string_view path) {
    const size_t cut = path.rfind('/') + 1;  // 0 where there is none
    const std::string_view key = path.substr(cut), place = path.substr(0, cut > 0 ? cut - 1 : 0);
    if (place == kWeightRow.place && is_number(key))
        return find(table, place) ? &kWeightRow : nullptr;
    for (const GltfProperty& row : table)
        if (row.place == place && key == row.key) return &row;
    return nullptr;
}

}  // namespace

std::span<const GltfProperty> rows_at(std::span<const GltfProperty> table, std::string_view place) {
    const auto from = std::ranges::find(table, place, &GltfProperty::place);
    const auto is_elsewhere = [&](const GltfProperty& row) { return row.place != place; };
    return {from, std::find_if(from, table.end(), is_elsewhere)};
}

const GltfProperty* animated_property(std::string_view pointer) {
    if (!take(pointer, "")) return nullptr;
    const GltfProperty* found = nullptr;
    for (const Things& things : kThings) {
        std::string_view path = pointer;
        if (!take(path, things.list)) continue;
        const std::string_view index = path.substr(0, path.find('/'));
        if (is_number(index) && take(path, index)) found = find(things.table, path);
    }
    constexpr std::string_view slot = "Texture/";
    if (const size_t at = pointer.rfind(slot); !found && at != pointer.npos)
        found = find(kSlotRows, pointer.substr(at + slot.size()));
    return found && found->animated() ? found : nullptr;
}

double number_of(const JsonCursor& thing, const GltfProperty& property) {
    double number = property.preset;
    at_place(thing, property.place,
             [&](const JsonCursor& owner) { number = owner.number_or(property.key, number); });
    return number;
}

std::array<double, 4> presets_of(const GltfProperty& property) {
    const double one = property.preset;
    return property.kind == PropertyKind::Turn ? std::array{0., 0., 0., 1.}
                                               : std::array{one, one, one, one};
}

std::array<double, 4> numbers_of(const JsonCursor& thing, const GltfProperty& property) {
    std::array<double, 4> numbers = presets_of(property);
    at_place(thing, property.place, [&](const JsonCursor& owner) {
        std::ranges::copy(owner.numbers(property.key, property.width()), numbers.begin());
    });
    return numbers;
}

}  // namespace petzval::io
