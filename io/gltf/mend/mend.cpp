// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Members that are an index and may be absent.
constexpr std::array<std::string_view, 11> kReferences = {
    "bufferView", "camera", "indices", "inverseBindMatrices",
    "material",   "mesh",   "sampler", "scene",
    "skeleton",   "skin",   "source"};

/// Members that are objects, and lists: some languages write an empty one as the other.
constexpr std::array<std::string_view, 14> kObjects = {"attributes",
                                                       "baseColorTexture",
                                                       "emissiveTexture",
                                                       "extensions",
                                                       "metallicRoughnessTexture",
                                                       "normalTexture",
                                                       "occlusionTexture",
                                                       "orthographic",
                                                       "pbrMetallicRoughness",
                                                       "perspective",
                                                       "sparse",
                                                       "spot",
                                                       "specularTexture",
                                                       "specularColorTexture"};
constexpr std::array<std::string_view, 4> kLists = {"children", "primitives", "targets", "weights"};

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
        const size_t length = place_.size();
        if (value.is_array()) {
            for (size_t i = 0; i < value.size(); ++i)
                if (value[i].is_structured()) {
                    place_ += '/' + std::to_string(i);
                    visit(value[i]);
                    place_.resize(length);
                }
            return;
        }
        for (auto& [key, child] : value.items()) {
            if (!child.is_structured() || key == "extras") continue;
            place_ += '/' + printable(key);
            in_attributes_ = key == "attributes";
            visit(child);
            in_attributes_ = false;
            place_.resize(length);
        }
    }

  private:
    void mend(json& object) {
        for (auto at = object.begin(); at != object.end();) {
            const char* const fault =
                in_attributes_ && at.value() == -1 ? "is -1" : fault_of(at.key(), at.value());
            if (fault)
                root_.warn(fmt::format("{}: a member \"{}\" {}; it is taken as absent",
                                       place_.empty() ? "/" : place_, printable(at.key()), fault));
            at = fault ? object.erase(at) : std::next(at);
        }
    }

    static const char* fault_of(const std::string& key, const json& value) {
        if (key == "extras") return nullptr;
        if (value.is_null()) return "is null";
        if (value.is_number_integer() && value == -1 && is_one_of(kReferences, key)) return "is -1";
        if (value.is_array() && value.empty() && is_one_of(kObjects, key))
            return "is an empty list instead of an object";
        if (value.is_object() && value.empty() && is_one_of(kLists, key))
            return "is an empty object instead of a list";
        if (key == "name" && !value.is_string()) return "is no text";
        return nullptr;
    }

    const JsonEditor& root_;
    std::string place_;           ///< JSON path of what is visited
    bool in_attributes_ = false;  ///< it is a list of vertex attributes by name
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

}  // namespace petzval::io
