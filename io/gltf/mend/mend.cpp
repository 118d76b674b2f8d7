// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/base/json_parse.h"

namespace petzval {
namespace {

using nlohmann::json;

/// Members that are an index and may be absent.
constexpr std::array<std::string_view, 11> kReferences = {
    "bufferView", "camera", "indices", "inverseBindMatrices",
    "material",   "mesh",   "sampler", "scene",
    "skeleton",   "skin",   "source"};

/// Members that are objects: some languages write an empty list for an empty object.
constexpr std::array<std::string_view, 2> kObjects = {"attributes", "extensions"};

template <size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Walks through the document, but not into "extras". Its depth is limited, so recursion is safe.
class Walk {
  public:
    explicit Walk(const JsonEditor& root) : root_(root) {}

    void visit(json& value) {
        if (value.is_object()) mend(value);
        if (value.is_array()) {
            for (json& child : value)
                if (child.is_structured()) visit(child);
            return;
        }
        for (auto& [key, child] : value.items())
            if (child.is_structured() && key != "extras") visit(child);
    }

  private:
    void mend(json& object) {
        for (auto at = object.begin(); at != object.end();) {
            const char* const fault = fault_of(at.key(), at.value());
            if (fault)
                root_.warn(fmt::format("a member \"{}\" {}; it is taken as absent",
                                       printable(at.key()), fault));
            at = fault ? object.erase(at) : std::next(at);
        }
    }

    static const char* fault_of(const std::string& key, const json& value) {
        if (key == "extras") return nullptr;
        if (value.is_null()) return "is null";
        if (value.is_number_integer() && value == -1 && is_one_of(kReferences, key)) return "is -1";
        if (value.is_array() && value.empty() && is_one_of(kObjects, key))
            return "is an empty list instead of an object";
        if (key == "name" && !value.is_string()) return "is no text";
        return nullptr;
    }

    const JsonEditor& root_;
};

}  // namespace

void mend_members(const JsonEditor& root) {
    Walk(root).visit(root.value());
    for (const char* kind : {"accessors", "animations", "buffers", "bufferViews", "cameras",
                             "images", "materials", "meshes", "nodes", "samplers", "scenes",
                             "skins", "textures", "extensionsUsed", "extensionsRequired"})
        root.drop_unless(
            kind, [](const json& value) { return !value.is_object() || !value.empty(); },
            "is an empty object instead of a list; it is taken as absent");
}

void mend_gltf(json& document, WarningLog& warnings) {
    if (!document.is_object()) return;
    const JsonEditor root(document, warnings);
    mend_members(root);
    mend_header(root);
    mend_accessors(root);
    mend_textures(root);
    mend_materials(root);
    mend_meshes(root);
    mend_cameras(root);
    mend_lights(root);
    mend_nodes(root);
}

}  // namespace petzval
