// SPDX-License-Identifier: Apache-2.0
// A checked glTF file in tinygltf's types, beside its JSON and its bytes.
#pragma once

#include <string>

#include "io/gltf/validate/source.h"

namespace tinygltf {
class Model;
}

namespace petzval::io {

/// Input of the loader's parts. What parse_model() names comes from `typed`, the rest from
/// `source.json`, bytes from `source`.
struct GltfModel {
    const GltfSource& source;
    const tinygltf::Model& typed;
    const std::string& file;  ///< name of the file, for messages
};

/// Parses with tinygltf meshes, skins, textures, samplers, scenes and punctual lights; the model's
/// other arrays hold nothing of the file's. Throws InputError where tinygltf refuses the JSON.
[[nodiscard]] tinygltf::Model parse_model(const GltfSource&);

/// A JSON path: json_path("meshes", 3, "primitives", 0) is "/meshes/3/primitives/0".
template <class... Parts>
[[nodiscard]] std::string json_path(const Parts&... parts) {
    std::string path;
    const auto append = [&path](const auto& part) {
        path += '/';
        if constexpr (std::is_integral_v<std::decay_t<decltype(part)>>)
            path += std::to_string(part);
        else
            path += part;
    };
    (append(parts), ...);
    return path;
}

}  // namespace petzval::io
