// SPDX-License-Identifier: Apache-2.0
// Names and formats of vertex attributes (glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/gltf/validate/accessor.h"

namespace petzval {

/// Parts of an attribute's name, "TEXCOORD_1" say. A name of an application's own begins with '_'.
struct GltfSemantic {
    std::string base;             ///< "TEXCOORD"; the whole name where it is custom
    std::optional<uint64_t> set;  ///< 1
    bool custom = false;
};

/// Parts of a name; nothing where it is no attribute of glTF.
[[nodiscard]] std::optional<GltfSemantic> parse_gltf_semantic(const std::string& name);

/// Component type in a word: "float", "uint8", "uint8n" (normalized) ...
[[nodiscard]] std::string component_name(const GltfAccessor&);

/// Whether an attribute may have the accessor's format. quantized: the file uses
/// KHR_mesh_quantization; is_target: in a morph target.
[[nodiscard]] bool is_allowed_format(const GltfSemantic&, const GltfAccessor&, bool quantized,
                                     bool is_target);

}  // namespace petzval
