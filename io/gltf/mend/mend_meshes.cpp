// SPDX-License-Identifier: Apache-2.0
// BufferViews, accessors and meshes, as far as their JSON alone can tell.
#include <fmt/format.h>

#include <algorithm>

#include "io/base/json_parse.h"
#include "io/gltf/mend/attributes.h"
#include "io/gltf/mend/mend.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr const char* kQuantization = "KHR_mesh_quantization";

void mend_view(const JsonEditor& view) {
    view.value().erase("target");  // a hint for graphics cards
    if (view.integer("byteStride") == 0u)
        view.drop("byteStride", "is 0; the elements are taken as tightly packed");
}

void mend_accessor(const JsonEditor& accessor) {
    accessor.value().erase("min");  // bounds come from the data
    const json* most = accessor.find("max");
    const bool one = most && most->is_array() && most->size() == 1 && (*most)[0].is_number();
    if (!one) accessor.value().erase("max");  // one number may be the end of an animation
    json* normalized = accessor.find("normalized");
    if (normalized && normalized->is_number()) *normalized = *normalized != 0;
    const auto type = accessor.integer("componentType");
    if (normalized && *normalized == true && (type == 5126u || type == 5125u))
        accessor.drop("normalized", "goes with 8- and 16-bit integers only; it is ignored");
    const auto sparse = accessor.find_object("sparse");
    if (sparse && sparse->integer("count") == 0u)
        accessor.drop("sparse", "replaces no element; it is ignored");
}

/// Mends the primitives of a file with the facts of its accessors.
class MeshMender {
  public:
    explicit MeshMender(const JsonEditor& root)
        : root_(root), accessors_(root.array("accessors")) {}

    void mend(const JsonEditor& mesh) {
        if (!mesh.find("primitives")) {
            mesh.warn("has no primitives; it shows nothing");
            mesh.value()["primitives"] = json::array();
        }
        size_t targets = 0;
        mesh.each("primitives", [&](const JsonEditor& primitive) {
            mend_primitive(primitive);
            if (const json* list = primitive.array("targets"))
                targets = std::max(targets, list->size());
        });
        mend_weights(mesh, targets);
    }

    static void mend_weights(const JsonEditor& owner, size_t targets) {
        json* weights = owner.array("weights");
        if (!weights || weights->size() == targets) return;
        owner.warn("weights", fmt::format("holds {} numbers for {} morph targets; 0 is taken where "
                                          "one is missing",
                                          weights->size(), targets));
        while (weights->size() > targets) weights->erase(weights->end() - 1);
        while (weights->size() < targets) weights->push_back(0);
    }

  private:
    json* accessor(const json& index) const {
        if (!accessors_ || !index.is_number_integer() || index.get<double>() < 0) return nullptr;
        const auto at = index.get<uint64_t>();
        return at < accessors_->size() && (*accessors_)[at].is_object() ? &(*accessors_)[at]
                                                                        : nullptr;
    }
    static uint64_t count_of(const json& accessor) {
        const auto at = accessor.find("count");
        return at != accessor.end() && at->is_number_unsigned()              ? at->get<uint64_t>()
               : at != accessor.end() && at->is_number_integer() && *at >= 0 ? at->get<uint64_t>()
                                                                             : uint64_t(-1);
    }

    void mend_primitive(const JsonEditor& primitive) {
        if (!primitive.find("attributes")) primitive.value()["attributes"] = json::object();
        const auto attributes = primitive.find_object("attributes");
        if (!attributes) return;
        if (is_empty(primitive, *attributes)) {
            primitive.value()["attributes"] = json::object();
            primitive.value().erase("indices");
            primitive.value().erase("targets");
            return;
        }
        if (const json* index = primitive.find("indices"))
            if (json* list = accessor(*index)) drop_normalized(*list, *index);
        const json* positions = attributes->find("POSITION");
        const json* base = positions ? accessor(*positions) : nullptr;
        mend_attributes(*attributes, base, false);
        primitive.each("targets", [&](const JsonEditor& target) {
            mend_attributes(target, base, true);
            drop_if(target, [&](const std::string& name, const json&) {
                return attributes->value().contains(name) ? ""
                                                          : "morphs an attribute that is not there";
            });
        });
    }

    /// A primitive without vertices or without indices, as exporters write empty meshes.
    bool is_empty(const JsonEditor& primitive, const JsonEditor& attributes) const {
        for (const json* index : {attributes.find("POSITION"), primitive.find("indices")})
            if (const json* list = index ? accessor(*index) : nullptr; list && count_of(*list) == 0)
                return true;
        return false;
    }

    void drop_normalized(json& list, const json& index) {
        if (list.value("normalized", json()) != true) return;
        root_.warn(fmt::format("/accessors/{}/normalized: is ignored: indices are whole numbers",
                               index.get<uint64_t>()));
        list.erase("normalized");
    }

    /// base: the accessor of the positions; nullptr where there is none.
    void mend_attributes(const JsonEditor& attributes, const json* base, bool is_target) {
        for (const auto& [name, index] : attributes.value().items())
            if (const auto semantic = parse_gltf_semantic(name))
                if (json* list = accessor(index)) mend_format(*semantic, *list, index, is_target);
        drop_if(attributes, [&](const std::string& name, const json& index) {
            const auto semantic = parse_gltf_semantic(name);
            if (!semantic) return "is no attribute of glTF; names of one's own begin with _";
            const json* list = accessor(index);
            if (!list || is_needed(*semantic, is_target)) return "";
            if (base && count_of(*list) != count_of(*base))
                return "has another number of elements than POSITION";
            return is_allowed_format(*semantic, summary_of(*list), true, is_target)
                       ? ""
                       : "has a format that it must not have";
        });
    }

    /// Whether a mesh without the attribute would be another one.
    static bool is_needed(const GltfSemantic& semantic, bool is_target) {
        return !is_target && (semantic.base == "POSITION" || semantic.base == "JOINTS" ||
                              semantic.base == "WEIGHTS");
    }

    /// What tells an accessor's format.
    static GltfFormat summary_of(const json& list) {
        GltfFormat out;
        if (const auto type = list.find("componentType");
            type != list.end() && type->is_number_integer())
            out.component_type = int(std::clamp(type->get<double>(), 0., 9999.));
        if (const auto type = list.find("type"); type != list.end() && type->is_string())
            out.type = type->get<std::string>();
        out.normalized = list.value("normalized", json()) == true;
        return out;
    }

    void mend_format(const GltfSemantic& semantic, json& list, const json& index, bool is_target) {
        GltfFormat summary = summary_of(list);
        if (semantic.base == "JOINTS" && summary.normalized) {
            drop_normalized(list, index);
            summary.normalized = false;
        }
        const bool is_unit = semantic.base == "COLOR" || semantic.base == "WEIGHTS" ||
                             (semantic.base == "TEXCOORD" && !quantized());
        const bool unsigned_integer =
            summary.component_type == 5121 || summary.component_type == 5123;
        if (is_unit && unsigned_integer && !summary.normalized) {
            root_.warn(fmt::format("/accessors/{}/normalized: must be true for {}; it is taken so",
                                   index.get<uint64_t>(), semantic.base));
            list["normalized"] = true;
            return;
        }
        if (quantized() || is_allowed_format(semantic, summary, false, is_target) ||
            !is_allowed_format(semantic, summary, true, is_target))
            return;
        // What is no list cannot take a name; it is refused later.
        if (root_.find("extensionsUsed") && !root_.array("extensionsUsed")) return;
        root_.value()["extensionsUsed"].push_back(kQuantization);
        root_.warn("extensionsUsed",
                   fmt::format("does not list {}, which accessor {} needs; it is added",
                               kQuantization, index.get<uint64_t>()));
    }

    [[nodiscard]] bool quantized() const {
        const json* used = root_.array("extensionsUsed");
        return used && std::find(used->begin(), used->end(), kQuantization) != used->end();
    }

    /// Takes away the attributes for which why(name, index) is a reason.
    template <class Why>
    static void drop_if(const JsonEditor& attributes, Why why) {
        std::vector<std::pair<std::string, std::string>> dropped;
        for (const auto& [name, index] : attributes.value().items())
            if (const std::string reason = why(name, index); !reason.empty())
                dropped.emplace_back(name, reason);
        for (const auto& [name, reason] : dropped)
            attributes.drop(name.c_str(), reason + "; it is left out");
    }

    const JsonEditor& root_;
    json* accessors_;
};

/// Morph weights of nodes; those of a mesh are mended with it.
void mend_node_weights(const JsonEditor& root) {
    const json* meshes = root.array("meshes");
    root.each("nodes", [&](const JsonEditor& node) {
        const auto mesh = node.integer("mesh");
        if (!node.find("weights") || !mesh || !meshes || *mesh >= meshes->size()) return;
        const json* primitives = nullptr;
        if (const json& at = (*meshes)[*mesh]; at.is_object() && at.contains("primitives"))
            primitives = &at["primitives"];
        size_t targets = 0;
        if (primitives && primitives->is_array())
            for (const json& primitive : *primitives)
                if (primitive.is_object() && primitive.contains("targets") &&
                    primitive["targets"].is_array())
                    targets = std::max(targets, primitive["targets"].size());
        MeshMender::mend_weights(node, targets);
    });
}

}  // namespace

void mend_accessors(const JsonEditor& root) {
    root.each("bufferViews", mend_view);
    root.each("accessors", mend_accessor);
}

void mend_meshes(const JsonEditor& root) {
    MeshMender mender(root);
    root.each("meshes", [&](const JsonEditor& mesh) { mender.mend(mesh); });
    mend_node_weights(root);
}

}  // namespace petzval::io
