// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace petzval::io {

/// Which objects of a glTF file something refers to that is shown: a broken one that nothing needs
/// is no reason to refuse the file. Meshes, skins, instances and animations that are played need
/// accessors, accessors and images need bufferViews, textures need images.
struct GltfUse {
    std::vector<bool> accessors, views, images;
};

/// Finds them in a file that is not yet checked: what is no reference is passed over. played:
/// numbers of the animations.
[[nodiscard]] GltfUse find_used(const nlohmann::json& root, std::span<const size_t> played);

}  // namespace petzval::io
