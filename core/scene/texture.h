// SPDX-License-Identifier: Apache-2.0
// Images in memory and how a material reads them.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/math/lanes.h"
#include "core/math/math.h"

namespace petzval {

/// Decoded RGBA texels, row 0 at the top (glTF's v = 0).
struct Image {
    std::string name;
    int width = 0, height = 0;
    /// Four numbers a texel: 8 bits as in the file, or floats where it has more.
    std::variant<std::vector<uint8_t>, std::vector<float>> texels;
};

enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge };
enum class Encoding : uint8_t { Linear, Srgb };  ///< of the colour channels; alpha is linear

/// One texture slot of a material. Colour encodings are decoded before filtering, as glTF asks.
struct TextureSlot {
    int32_t image = -1;  ///< -1: no texture, reads as 1
    Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
    bool nearest = false;
    Encoding encoding = Encoding::Linear;
    uint8_t uv_set = 0;  ///< as Mesh::uv_of counts them
    /// Place number: slots of a material with the same one above 0 find their texels at the same
    /// places of pictures of one size. finish_scene sets it.
    uint8_t place = 0;
    /// KHR_texture_transform: (u, v, 1) times these two rows.
    std::array<float, 3> u_row{1, 0, 0}, v_row{0, 1, 0};

    [[nodiscard]] bool present() const { return image >= 0; }
};

/// Memory location of a slot's value: the four texels about uv (the same one four times where the
/// slot asks for the nearest). Locating several slots before reading the first lets their cache
/// misses overlap.
struct TextureLookup {
    enum class Format : uint8_t { None, Bytes, SrgbBytes, Floats, SrgbFloats };
    const void* texels = nullptr;
    std::array<uint32_t, 4> texel{};  ///< upper left, upper right, lower left, lower right
    float right = 0, lower = 0;       ///< weights of the right and of the lower texels
    Format format = Format::None;
};
/// Finds the texels and asks the processor to fetch them. Defined for any finite uv.
[[nodiscard]] TextureLookup locate_texture(const std::vector<Image>& images,
                                           const TextureSlot& slot, V2f uv);
/// Finds and fetches the texels likewise, from another slot of the same `place` that is located
/// already.
[[nodiscard]] TextureLookup locate_beside(const std::vector<Image>& images, const TextureSlot& slot,
                                          const TextureLookup& located);
/// Value of a slot: RGBA, decoded to linear, then filtered; 1 where the slot has no texture.
[[nodiscard]] f4 read_texture(const TextureLookup&);

/// Value of a slot at uv: both steps at once.
[[nodiscard]] inline f4 sample_texture(const std::vector<Image>& images, const TextureSlot& slot,
                                       V2f uv) {
    return read_texture(locate_texture(images, slot, uv));
}

}  // namespace petzval
