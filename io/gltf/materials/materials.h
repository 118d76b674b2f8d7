// SPDX-License-Identifier: Apache-2.0
// glTF materials with the extensions that Petzval honours.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/scene/scene.h"
#include "io/gltf/materials/spectral.h"
#include "io/gltf/materials/textures.h"
#include "io/gltf/schema/schema.h"

namespace petzval::io {

/// Where the loader puts a property of a material.
struct MaterialField {
    MaterialRow name;
    std::variant<float Material::*, Rgb Material::*, TextureSlot Material::*> member;
    /// Where it is set, the rest of the extension is read only where this property is above 0. What
    /// the extension is called among what is honoured.
    const char* layer = nullptr;
};

/// Converts materials as primitives ask for them, so that what no primitive uses is never read.
class GltfMaterials {
  public:
    GltfMaterials(const GltfModel&, Scene&, GltfTally&, PictureBudget&, DecodedImages&);

    /// Index in the scene of a material of the file; of glTF's default material for -1.
    [[nodiscard]] uint32_t use(int material);
    /// Numbers of the TEXCOORD_n that a material of the scene reads as its sets from 2 on.
    [[nodiscard]] const std::vector<uint64_t>& more_sets(uint32_t of_scene) const {
        return more_sets_[of_scene];
    }

    [[nodiscard]] const GltfTextures& textures() const { return textures_; }

  private:
    [[nodiscard]] Material read(size_t index);
    /// Reads what has a field of its own.
    void read(const JsonCursor&, std::span<const MaterialField>, Material&);
    [[nodiscard]] TextureSlot slot(const JsonCursor&, MaterialRow);
    void read_surface(const JsonCursor&, Material&);
    void count(const JsonCursor&, const Material&);

    const GltfModel& gltf_;
    Scene& scene_;
    GltfTally& tally_;
    GltfTextures textures_;
    GltfSpectral spectral_;
    std::vector<JsonCursor> json_;
    std::vector<std::vector<uint64_t>> more_sets_;  ///< of each material of the scene
    std::vector<std::optional<uint32_t>> used_;  ///< by material of the file; the default is last
};

}  // namespace petzval::io
