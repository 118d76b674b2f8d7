// SPDX-License-Identifier: Apache-2.0
// Names and formats of vertex attributes (glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/gltf/validate/accessor.h"

namespace petzval {

/// "TEXCOORD_1" taken apart. A name of an application's own begins with '_'.
struct GltfSemantic {
    std::string base;             ///< "TEXCOORD"; the whole name where it is custom
    std::optional<uint64_t> set;  ///< 1
    bool custom = false;
};

/// Nothing where the name is no attribute of glTF.
[[nodiscard]] std::optional<GltfSemantic> parse_gltf_semantic(const std::string& name);

/// "float", "uint8", "uint8n" (normalized) ...
[[nodiscard]] std::string component_name(const GltfAccessor&);

/// quantized: the file uses KHR_mesh_quantization; is_target: in a morph target.
[[nodiscard]] bool is_allowed_format(const GltfSemantic&, const GltfAccessor&, bool quantized,
                                     bool is_target);

}  // namespace petzval
