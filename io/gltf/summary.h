// SPDX-License-Identifier: Apache-2.0
// Summary of a glTF file, in numbers and names: for `petzval info`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/schema/extensions.h"

namespace petzval::io {

/// Names are as in the file; an unnamed thing has an empty one.
struct GltfSummary {
    struct Animation {
        std::string name;
        size_t channels = 0;
        std::optional<double> duration_s;  ///< where the file says it
    };
    struct Picture {
        std::string name;
        int width_px = 0, height_px = 0;
        uint64_t bytes = 0;  ///< decoded
    };
    struct Lights {
        uint64_t point = 0, spot = 0, directional = 0;
        uint64_t balls = 0;     ///< of the points and spots: those with a radius
        uint64_t flat = 0;      ///< nodes with an area
        uint64_t profiles = 0;  ///< lights by IES profiles
        uint64_t emissive_meshes = 0, emissive_triangles = 0;
    };

    std::string generator;
    std::vector<ExtensionInFile> extensions;
    std::vector<std::string> scenes, variants;
    std::vector<Animation> animations;  ///< the first hundred
    uint64_t animation_count = 0;
    uint64_t nodes = 0, materials = 0;
    uint64_t meshes_stored = 0, meshes_placed = 0, triangles_stored = 0, triangles_placed = 0;
    uint64_t mesh_bytes = 0;
    std::vector<Picture> pictures;  ///< those that the scene uses
    Lights lights;
};

}  // namespace petzval::io
