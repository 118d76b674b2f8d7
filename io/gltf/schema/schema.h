// SPDX-License-Identifier: Apache-2.0
// Use of the rows: finds, reads, and walks through the properties of an object.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "io/gltf/schema/rows.h"

namespace petzval::io {

/// Whether a row is that of a name: its key, or the end of its path where that is not enough
/// ("KHR_materials_specular/specularFactor").
[[nodiscard]] constexpr bool is_named(const GltfProperty& row, std::string_view name) {
    const std::string_view key = row.key, place = row.place;
    if (!name.ends_with(key)) return false;
    name.remove_suffix(key.size());
    if (name.empty()) return true;
    if (!name.ends_with('/')) return false;
    name.remove_suffix(1);
    return place.ends_with(name) && (place == name || place[place.size() - name.size() - 1] == '/');
}

/// The row of a name among some: MaterialRow("ior"). It does not compile where there is none, or
/// more than one.
template <const auto& table>
struct RowOf {
    const GltfProperty& row;

    consteval RowOf(const char* name) : row(*find(name)) {}
    operator const GltfProperty&() const { return row; }

  private:
    static consteval const GltfProperty* find(std::string_view name) {
        const GltfProperty* found = nullptr;
        for (const GltfProperty& one : table) {
            if (!is_named(one, name)) continue;
            if (found) throw "the name is of two properties";
            found = &one;
        }
        return found;
    }
};
using MaterialRow = RowOf<schema::kMaterialRows>;
using CameraRow = RowOf<schema::kCameraRows>;
using LightRow = RowOf<schema::kLightRows>;
using SlotRow = RowOf<schema::kSlotRows>;

/// Rows of one place.
[[nodiscard]] std::span<const GltfProperty> rows_at(std::span<const GltfProperty>,
                                                    std::string_view place);
/// Property that an animation pointer names ("/materials/3/alphaCutoff"): the glTF object model and
/// KHR_animation_pointer. Null for one that Petzval does not read, or that cannot be animated.
[[nodiscard]] const GltfProperty* animated_property(std::string_view pointer);

/// Numbers of an array that a thing has, else their defaults.
[[nodiscard]] std::array<double, 4> numbers_of(const JsonCursor& thing, const GltfProperty&);
/// The defaults: the first are those of the array.
[[nodiscard]] std::array<double, 4> presets_of(const GltfProperty&);
/// Number that a thing has, else its default.
[[nodiscard]] double number_of(const JsonCursor& thing, const GltfProperty&);

/// Calls visit(object) for the object at a place of a JsonCursor or JsonEditor, where there is one.
template <class Object, class Visit>
void at_place(const Object& thing, std::string_view place, const Visit& visit) {
    if (place.empty()) return visit(thing);
    const size_t end = std::min(place.find('/'), place.size());
    const std::string key(place.substr(0, end));  // an editor keeps a view of it
    const auto next = thing.find_object(key.c_str());
    if (next) at_place(*next, place.substr(std::min(end + 1, place.size())), visit);
}

/// Calls visit(object, row) for each row whose object is there. Rows of a place stand together.
template <class Object, class Visit>
void each_property(const Object& thing, std::span<const GltfProperty> table, const Visit& visit) {
    for (size_t i = 0, end = 0; i < table.size(); i = end) {
        while (end < table.size() && table[end].place == table[i].place) ++end;
        at_place(thing, table[i].place, [&](const Object& object) {
            for (const GltfProperty& row : table.subspan(i, end - i)) visit(object, row);
        });
    }
}

}  // namespace petzval::io
