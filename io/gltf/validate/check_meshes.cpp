// SPDX-License-Identifier: Apache-2.0
// Meshes: glTF 2.0, section 3.7.2, and KHR_mesh_quantization.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "io/base/json_parse.h"
#include "io/gltf/mend/attributes.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

class MeshCheck {
  public:
    explicit MeshCheck(GltfCheck& check)
        : check_(check),
          accessors_(check.root.objects("accessors")),
          views_(check.root.objects("bufferViews")),
          materials_(check.count("materials")) {
        const auto used = check.root.value().find("extensionsUsed");
        quantized_ = used != check.root.value().end() &&
                     std::find(used->begin(), used->end(), "KHR_mesh_quantization") != used->end();
    }

    void check_mesh(const JsonCursor& mesh) {
        mesh.require("primitives");
        std::optional<size_t> targets;
        for (const JsonCursor& primitive : mesh.objects("primitives")) {
            check_primitive(primitive);
            const size_t count = primitive.length("targets");
            if (targets.value_or(count) != count)
                check_.warn(primitive, "has another number of morph targets than the mesh's first");
            targets = std::max(targets.value_or(0), count);
        }
        if (mesh.has("weights")) (void)mesh.numbers("weights", targets.value_or(0));
    }

  private:
    using Attributes = std::map<std::string, size_t>;  ///< accessor by name

    void check_primitive(const JsonCursor& primitive) {
        const JsonCursor attributes = primitive.object("attributes");
        const Attributes found = read_attributes(attributes, false);
        const uint64_t vertices = vertex_count(found);
        check_counts(attributes, found, vertices);
        if (primitive.has("indices")) check_indices(primitive);
        ask_for_shared(primitive, found, vertices);
        if (primitive.integer_or("mode", 4) > 6) check_.warn(primitive, "mode is unknown");
        (void)primitive.index("material", materials_, "material");
        for (const JsonCursor& target : primitive.objects("targets"))
            check_target(target, found, vertices);
    }

    uint64_t vertex_count(const Attributes& found) const {
        if (found.empty()) return 0;
        const auto positions = found.find("POSITION");
        return check_.accessors[(positions == found.end() ? found.begin() : positions)->second]
            .count;
    }

    Attributes read_attributes(const JsonCursor& attributes, bool is_target) {
        Attributes found;
        for (const auto& [name, unused] : attributes.value().items()) {
            const auto semantic = parse_gltf_semantic(name);
            if (!semantic)
                attributes.fail(name, "is no attribute of glTF; names of your own begin with _");
            const size_t index =
                attributes.required_index(name.c_str(), accessors_.size(), "accessor");
            const GltfAccessor& accessor = check_.accessors[index];
            check_format(attributes, name, *semantic, accessor, is_target);
            found[name] = index;
        }
        return found;
    }

    void check_format(const JsonCursor& attributes, const std::string& name,
                      const GltfSemantic& semantic, const GltfAccessor& accessor,
                      bool is_target) const {
        if (!is_allowed_format(semantic, format_of(accessor), quantized_, is_target))
            attributes.fail(
                name, fmt::format("is {} of {}, which {} must not be", printable(accessor.type),
                                  component_name(format_of(accessor)), name));
    }

    /// Counts shared vertices against the budget: a loader may keep a copy of them for each
    /// primitive that shares them.
    void ask_for_shared(const JsonCursor& primitive, const Attributes& found, uint64_t vertices) {
        bool shared = false;
        uint64_t size = 0;
        for (const auto& [unused, index] : found) {
            const GltfAccessor& accessor = check_.accessors[index];
            size += element_size(accessor.type, accessor.component_type, true);
            shared |= !seen_.insert(index).second;
        }
        if (!shared) return;
        const auto indices = primitive.index("indices", accessors_.size(), "accessor");
        const uint64_t used = indices ? check_.accessors[*indices].count : vertices;
        check_.budget.ask(std::min(used, vertices) * size, primitive);
    }

    void check_counts(const JsonCursor& attributes, const Attributes& found, uint64_t vertices) {
        for (const auto& [name, index] : found)
            if (check_.accessors[index].count != vertices)
                attributes.fail(name, fmt::format("accessor {} has {} elements, but another "
                                                  "attribute has {}",
                                                  index, check_.accessors[index].count, vertices));
    }

    void check_indices(const JsonCursor& primitive) {
        const size_t index = primitive.required_index("indices", accessors_.size(), "accessor");
        const GltfAccessor& accessor = check_.accessors[index];
        const std::string component = component_name(format_of(accessor));
        if (accessor.type != "SCALAR" ||
            (component != "uint8" && component != "uint16" && component != "uint32"))
            primitive.fail("indices", fmt::format("accessor {} is {} of {}, not SCALAR of an "
                                                  "unsigned integer",
                                                  index, printable(accessor.type), component));
        if (accessor.stride != component_size(accessor.component_type))
            primitive.fail("indices", "their bufferView must not have a byteStride");
    }

    void check_target(const JsonCursor& target, const Attributes& base, uint64_t vertices) {
        const Attributes found = read_attributes(target, true);
        check_counts(target, found, vertices);
        for (const auto& [name, unused] : found)
            if (!base.contains(name)) target.fail(name, "morphs an attribute that is not there");
    }

    GltfCheck& check_;
    const std::vector<JsonCursor> accessors_, views_;
    const size_t materials_;  ///< how many there are
    bool quantized_ = false;
    std::set<size_t> seen_;  ///< accessors that a primitive has used
};

}  // namespace

size_t morph_target_count(const nlohmann::json& mesh) {
    size_t most = 0;
    for (const nlohmann::json& primitive : member(mesh, "primitives"))
        most = std::max(most, member(primitive, "targets").size());
    return most;
}

void check_meshes(GltfCheck& check) {
    MeshCheck meshes(check);
    for (const JsonCursor& mesh : check.root.objects("meshes")) meshes.check_mesh(mesh);
}

}  // namespace petzval::io
