// SPDX-License-Identifier: Apache-2.0
// Texture slots of glTF materials, and the images behind them.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "io/base/json_cursor.h"
#include "io/gltf/document/model.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/schema/schema.h"
#include "io/picture/colour_remarks.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// Images of a file that are decoded already, by their number there.
struct DecodedImages {
    struct One {
        Image image;
        ColourRemarks remarks;
    };
    std::map<size_t, One> images;
};

/// Makes texture slots, and decodes an image when the first slot asks for it.
class GltfTextures {
  public:
    /// decoded: images that need not be decoded again; they are taken from there.
    GltfTextures(const GltfModel&, std::vector<Image>& images, GltfTally&, PictureBudget&,
                 DecodedImages& decoded);

    /// Texture slot of a material, with KHR_texture_transform; one without a texture where there is
    /// none. Throws InputError where the image cannot be decoded.
    [[nodiscard]] TextureSlot slot(const JsonCursor& material, const GltfProperty&);
    /// Origin of each decoded image of the scene, for when the images come back: its number in the
    /// file and its remarks.
    struct Origin {
        size_t number;
        ColourRemarks remarks;
    };
    [[nodiscard]] const std::vector<Origin>& origins() const { return origins_; }
    /// Numbers of the TEXCOORD_n that slots made since the last call have as their sets from 2 on.
    [[nodiscard]] std::vector<uint64_t> take_more_sets() { return std::exchange(more_sets_, {}); }

  private:
    /// Record of an image of the file.
    struct Used {
        int32_t place = -1;  ///< in images_; -1: not needed yet
        ColourRemarks remarks;
        std::string colour_slot, data_slot;  ///< the first that reads it as colours, as numbers
        bool normals_checked = false;
    };

    [[nodiscard]] uint8_t set_of(uint64_t texcoord);
    [[nodiscard]] int32_t use_image(size_t image);
    [[nodiscard]] TextureSlot read_slot(const JsonCursor& info, const GltfProperty&);
    /// Warns of what is likely a mistake in an image that a slot reads, each once. slot: its path.
    void check_colours(size_t image, const std::string& slot, const GltfProperty&);

    const GltfModel& gltf_;
    std::vector<Image>& images_;
    GltfTally& tally_;
    PictureBudget& pictures_;
    DecodedImages& decoded_;
    std::vector<Origin> origins_;  ///< by image of the scene
    std::vector<uint64_t> more_sets_;
    std::vector<Used> used_;  ///< by image of the file
};

}  // namespace petzval::io
