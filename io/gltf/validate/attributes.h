// SPDX-License-Identifier: Apache-2.0
// Formats of vertex attributes (glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization).
#pragma once

#include <string>

#include "io/gltf/mend/semantic.h"
#include "io/gltf/validate/accessor.h"

namespace petzval {

/// Component type in a word: "float", "uint8", "uint8n" (normalized) ...
[[nodiscard]] std::string component_name(const GltfAccessor&);

/// Whether an attribute may have the accessor's format. quantized: the file uses
/// KHR_mesh_quantization; is_target: in a morph target.
[[nodiscard]] bool is_allowed_format(const GltfSemantic&, const GltfAccessor&, bool quantized,
                                     bool is_target);

}  // namespace petzval
