// SPDX-License-Identifier: Apache-2.0
// Texture slots of glTF materials, and the images behind them.
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "io/base/json_cursor.h"
#include "io/gltf/model.h"
#include "io/gltf/tally.h"
#include "io/picture/picture_budget.h"

namespace petzval {

/// Makes texture slots, and decodes an image when the first slot asks for it.
class GltfTextures {
  public:
    GltfTextures(const GltfModel&, std::vector<Image>& images, GltfTally&, PictureBudget&);

    /// Texture slot from the textureInfo object at `key`, with KHR_texture_transform; a slot
    /// without a texture where there is none. Throws InputError where the image cannot be decoded.
    [[nodiscard]] TextureSlot slot(const JsonCursor& parent, const char* key, Encoding);

  private:
    [[nodiscard]] int32_t use_image(size_t image);

    const GltfModel& gltf_;
    std::vector<Image>& images_;
    GltfTally& tally_;
    PictureBudget& pictures_;
    std::vector<int32_t> used_;  ///< place in images_ of each image of the file, -1: not needed yet
};

}  // namespace petzval
