// SPDX-License-Identifier: Apache-2.0
// Reads the bytes that a glTF file's JSON refers to.
#pragma once

#include <optional>
#include <span>

#include "io/gltf/validate/budget.h"
#include "io/gltf/validate/source.h"
#include "io/gltf/validate/use.h"

namespace petzval::io {

/// Container of the JSON: text, or a .glb with or without a binary chunk.
struct GltfContainer {
    bool binary = false;
    std::optional<std::span<const uint8_t>> bin;
};

/// Fills source.buffers from data URIs, side files and the binary chunk, and checks their lengths.
void read_buffers(GltfSource& source, const GltfContainer&, GltfBudget&);

/// Fills source.images from data URIs, side files and bufferViews (which must be checked already),
/// one that is not there, or is broken and not used, stays empty.
void read_images(GltfSource& source, const GltfUse&, GltfBudget&);

/// Fills source.light_profiles with the files of EXT_lights_ies likewise; one that is not there
/// stays empty.
void read_light_profiles(GltfSource& source, GltfBudget&);

/// Adds to source.reflectances the one that a material's extras.petzval name, if any.
void fetch_reflectance(GltfSource& source, const JsonCursor& extras, GltfBudget&);

}  // namespace petzval::io
