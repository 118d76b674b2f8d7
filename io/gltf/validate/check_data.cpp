// SPDX-License-Identifier: Apache-2.0
// Values in the buffers that would lead a loader astray. Messages do not show them: a buffer may be
// any file of the machine.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/gltf/validate/check.h"

namespace petzval {
namespace {

/// The greatest component of an accessor of unsigned integers, and its first index.
struct Greatest {
    uint64_t value = 0, at = 0;
};

Greatest greatest_of(const GltfAccessor& accessor) {
    const std::vector<uint32_t> values = read_unsigned(accessor);
    const auto at = std::max_element(values.begin(), values.end());
    return {*at, uint64_t(at - values.begin())};
}

bool has_data(const GltfAccessor& accessor) {
    return accessor.components > 0 && (!accessor.bytes.empty() || accessor.sparse);
}

void check_floats(const GltfCheck& check) {
    const auto cursors = check.root.objects("accessors");
    for (size_t i = 0; i < cursors.size(); ++i) {
        const GltfAccessor& accessor = check.accessors[i];
        if (accessor.component_type != 5126 || !has_data(accessor) ||
            accessor.type.starts_with("MAT"))
            continue;
        const std::vector<float> values = read_floats(accessor);
        const auto bad = std::find_if(values.begin(), values.end(),
                                      [](float value) { return !std::isfinite(value); });
        if (bad != values.end())
            cursors[i].fail(fmt::format("element {} is not a finite number",
                                        (bad - values.begin()) / accessor.components));
    }
}

class IndexCheck {
  public:
    explicit IndexCheck(const GltfCheck& check)
        : check_(check), greatest_(check.accessors.size()) {}

    void check_vertex_indices(const JsonCursor& primitive) {
        const auto& attributes = primitive.value()["attributes"];
        if (!primitive.has("indices") || attributes.empty()) return;
        const size_t index = primitive.integer("indices");
        const GltfAccessor& accessor = check_.accessors[index];
        const uint64_t vertices = check_.accessors[attributes.front().get<size_t>()].count;
        const Greatest found = greatest(index);
        const uint64_t restart = (uint64_t(1) << 8 * component_size(accessor.component_type)) - 1;
        if (found.value == restart)
            primitive.fail("indices",
                           fmt::format("index {} of accessor {} has all bits set, which would "
                                       "restart the primitive and is not allowed",
                                       found.at, index));
        if (found.value >= vertices)
            primitive.fail("indices",
                           fmt::format("index {} of accessor {} is beyond the {} vertices",
                                       found.at, index, vertices));
    }

    /// The greatest joint that the vertices of a mesh name; nothing where they name none.
    std::optional<uint64_t> greatest_joint(const JsonCursor& mesh) {
        std::optional<uint64_t> joint;
        for (const JsonCursor& primitive : mesh.objects("primitives"))
            for (const auto& [name, index] : primitive.value()["attributes"].items())
                if (name.starts_with("JOINTS_"))
                    joint = std::max(joint.value_or(0), greatest(index.get<size_t>()).value);
        return joint;
    }

  private:
    Greatest greatest(size_t accessor) {
        if (!has_data(check_.accessors[accessor])) return {};
        if (!greatest_[accessor]) greatest_[accessor] = greatest_of(check_.accessors[accessor]);
        return *greatest_[accessor];
    }

    const GltfCheck& check_;
    std::vector<std::optional<Greatest>> greatest_;  ///< of each accessor, once asked for
};

void check_joints(const GltfCheck& check, const std::vector<std::optional<uint64_t>>& greatest) {
    const auto skins = check.root.objects("skins");
    for (const JsonCursor& node : check.root.objects("nodes")) {
        if (!node.has("skin")) continue;
        const size_t skin = node.integer("skin"), mesh = node.integer("mesh");
        if (greatest[mesh] && *greatest[mesh] >= skins[skin].length("joints"))
            node.fail("skin", fmt::format("mesh {} names a joint beyond the {} of skin {}", mesh,
                                          skins[skin].length("joints"), skin));
    }
}

}  // namespace

void check_data(const GltfCheck& check) {
    check_floats(check);
    IndexCheck indices(check);
    std::vector<std::optional<uint64_t>> joints;
    for (const JsonCursor& mesh : check.root.objects("meshes")) {
        for (const JsonCursor& primitive : mesh.objects("primitives"))
            indices.check_vertex_indices(primitive);
        joints.push_back(indices.greatest_joint(mesh));
    }
    check_joints(check, joints);
}

}  // namespace petzval
