// SPDX-License-Identifier: Apache-2.0
// Formats of vertex attributes (glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization).
#pragma once

#include <string>

#include "io/gltf/mend/semantic.h"

namespace petzval::io {

/// Format of an accessor's elements.
struct GltfFormat {
    int component_type = 0;  ///< as GltfAccessor's, io/gltf/validate/accessor.h
    std::string type;        ///< "SCALAR", "VEC3" ...
    bool normalized = false;
};

/// Component type in a word: "float", "uint8", "uint8n" (normalized) ...
[[nodiscard]] std::string component_name(const GltfFormat&);

/// Whether an attribute may have the format. quantized: the file uses
/// KHR_mesh_quantization; is_target: in a morph target.
[[nodiscard]] bool is_allowed_format(const GltfSemantic&, const GltfFormat&, bool quantized,
                                     bool is_target);

}  // namespace petzval::io
