// SPDX-License-Identifier: Apache-2.0
// Names of vertex attributes (glTF 2.0, section 3.7.2.1).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace petzval::io {

/// Parts of an attribute's name, "TEXCOORD_1" say. A name of an application's own begins with '_'.
struct GltfSemantic {
    std::string base;             ///< "TEXCOORD"; the whole name where it is custom
    std::optional<uint64_t> set;  ///< 1
    bool custom = false;
};

/// Parts of a name; nothing where it is no attribute of glTF.
[[nodiscard]] std::optional<GltfSemantic> parse_gltf_semantic(const std::string& name);

}  // namespace petzval::io
