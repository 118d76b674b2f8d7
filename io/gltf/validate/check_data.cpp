// SPDX-License-Identifier: Apache-2.0
// Values in the buffers that would lead a loader astray. Messages do not show them: a buffer may be
// any file of the machine.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// The greatest component of an accessor of unsigned integers, and its first index.
struct Greatest {
    uint64_t value = 0, at = 0;
};

Greatest greatest_of(const GltfAccessor& accessor) {
    const std::vector<uint32_t> values = read_all<uint32_t>(accessor);
    const auto at = std::max_element(values.begin(), values.end());
    return {*at, uint64_t(at - values.begin())};
}

bool has_data(const GltfAccessor& accessor) {
    return accessor.components > 0 && (!accessor.bytes.empty() || accessor.sparse);
}

class IndexCheck {
  public:
    explicit IndexCheck(const GltfCheck& check)
        : check_(check), greatest_(check.accessors.size()) {}

    void check_vertex_indices(const JsonCursor& primitive) {
        const auto& attributes = primitive.value()["attributes"];
        if (!primitive.has("indices") || attributes.empty()) return;
        const size_t index = primitive.integer("indices");
        const auto positions = attributes.find("POSITION");
        const json& first = positions == attributes.end() ? attributes.front() : *positions;
        const uint64_t vertices = check_.accessors[first.get<size_t>()].count;
        const Greatest found = greatest(index);
        const uint64_t restart =
            (uint64_t(1) << 8 * component_size(check_.accessors[index].component_type)) - 1;
        if (found.value == restart)
            primitive.fail("indices",
                           "index {} of accessor {} has all bits set, which restarts the primitive "
                           "in other programs; use larger integers, or leave the index out",
                           found.at, index);
        if (found.value >= vertices)
            primitive.fail("indices", "index {} of accessor {} is beyond the {} vertices", found.at,
                           index, vertices);
    }

    /// The greatest joint that has a weight at a vertex of the mesh; nothing where there is none.
    /// Joints without a weight may be any number: exporters leave rubbish there.
    std::optional<uint64_t> greatest_joint(const JsonCursor& mesh) {
        std::optional<uint64_t> joint;
        for (const JsonCursor& primitive : mesh.objects("primitives")) {
            const json& attributes = primitive.value()["attributes"];
            for (const auto& [name, index] : attributes.items())
                if (name.starts_with("JOINTS_"))
                    if (const auto found = weighted(attributes, name, index.get<size_t>()))
                        joint = std::max(joint.value_or(0), *found);
        }
        return joint;
    }

  private:
    std::optional<uint64_t> weighted(const json& attributes, const std::string& name,
                                     size_t joints_index) {
        const GltfAccessor& joints = check_.accessors[joints_index];
        if (!has_data(joints)) return std::nullopt;
        const auto at = attributes.find("WEIGHTS_" + name.substr(name.find('_') + 1));
        if (at == attributes.end()) return std::nullopt;  // never read
        const auto weights_index = at->get<size_t>();
        const auto [known, is_new] = weighted_.try_emplace({joints_index, weights_index});
        if (!is_new) return known->second;
        const std::vector<bool> weighs = not_zero(check_.accessors[weights_index]);
        const std::vector<uint32_t> values = read_all<uint32_t>(joints);
        for (size_t i = 0; i < std::min(values.size(), weighs.size()); ++i)
            if (weighs[i]) known->second = std::max<uint64_t>(known->second.value_or(0), values[i]);
        return known->second;
    }

    static std::vector<bool> not_zero(const GltfAccessor& accessor) {
        const auto flags = [](const auto& values) {
            std::vector<bool> out;
            for (const auto value : values) out.push_back(value != 0);
            return out;
        };
        if (!has_data(accessor)) return {};
        return accessor.component_type == 5126 ? flags(read_all<float>(accessor))
                                               : flags(read_all<uint32_t>(accessor));
    }

    Greatest greatest(size_t accessor) {
        if (!has_data(check_.accessors[accessor])) return {};
        if (!greatest_[accessor]) greatest_[accessor] = greatest_of(check_.accessors[accessor]);
        return *greatest_[accessor];
    }

    const GltfCheck& check_;
    std::vector<std::optional<Greatest>> greatest_;  ///< of each accessor, once asked for
    /// The greatest joint with a weight, by accessors of joints and weights.
    std::map<std::pair<size_t, size_t>, std::optional<uint64_t>> weighted_;
};

void check_joints(const GltfCheck& check, const std::vector<std::optional<uint64_t>>& greatest) {
    const auto skins = check.root.objects("skins");
    for (const JsonCursor& node : check.root.objects("nodes")) {
        if (!node.has("skin")) continue;
        const size_t skin = node.integer("skin"), mesh = node.integer("mesh");
        if (greatest[mesh] && *greatest[mesh] >= skins[skin].length("joints"))
            node.fail("skin", "mesh {} names a joint beyond the {} of skin {}", mesh,
                      skins[skin].length("joints"), skin);
    }
}

}  // namespace

void check_data(const GltfCheck& check) {
    IndexCheck indices(check);
    std::vector<std::optional<uint64_t>> joints;
    for (const JsonCursor& mesh : check.root.objects("meshes")) {
        for (const JsonCursor& primitive : mesh.objects("primitives"))
            indices.check_vertex_indices(primitive);
        joints.push_back(indices.greatest_joint(mesh));
    }
    check_joints(check, joints);
}

}  // namespace petzval::io
