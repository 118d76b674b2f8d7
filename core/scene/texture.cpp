// SPDX-License-Identifier: Apache-2.0
#include "core/scene/texture.h"

#include <algorithm>
#include <cstring>

#include "core/spectrum/colour.h"

namespace petzval {
namespace {

typedef uint8_t u8x4 __attribute__((vector_size(4)));

// Readers turn texel i into linear RGBA.
struct FloatReader {
    const float* texels;
    f4 operator()(size_t i) const {
        f4 texel;
        std::memcpy(&texel, texels + 4 * i, sizeof texel);
        return texel;
    }
};

struct ByteReader {  // gives codes, 255 times the number
    const uint8_t* texels;
    f4 operator()(size_t i) const {
        u8x4 texel;
        std::memcpy(&texel, texels + 4 * i, sizeof texel);
        return __builtin_convertvector(texel, f4);
    }
};

// Fifth root by Newton's iteration, for 0 <= a <= 1.
constexpr double fifth_root(double a) {
    double root = 1;
    for (int i = 0; i < 100; ++i) root = (4 * root + a / (root * root * root * root)) / 5;
    return root;
}

// The curve of srgb_to_linear at the 256 codes, by arithmetic that a compiler can do: x^2.4 is the
// fifth root of x^12.
constexpr std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) {
        const double encoded = i / 255.0, x = (encoded + 0.055) / 1.055;
        const double x4 = x * x * x * x;
        table[i] =
            static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : fifth_root(x4 * x4 * x4));
    }
    return table;
}
constexpr std::array<float, 256> kSrgbToLinear = make_srgb_table();

struct SrgbByteReader {
    const uint8_t* texels;
    f4 operator()(size_t i) const {
        const uint8_t* t = texels + 4 * i;
        return f4{kSrgbToLinear[t[0]], kSrgbToLinear[t[1]], kSrgbToLinear[t[2]],
                  t[3] * (1.f / 255.f)};
    }
};

struct SrgbFloatReader {
    FloatReader encoded;
    f4 operator()(size_t i) const {
        const f4 t = encoded(i);
        return f4{srgb_to_linear(t[0]), srgb_to_linear(t[1]), srgb_to_linear(t[2]), t[3]};
    }
};

// Position along one axis in texels, 0 to size; what is not a number reads the first texel.
float wrapped_position(float coordinate, Wrap wrap, int size) {
    float unit = coordinate;
    if (wrap == Wrap::Repeat) unit = coordinate - std::floor(coordinate);
    if (wrap == Wrap::MirroredRepeat)
        unit = 1.f - std::fabs(coordinate - 2.f * std::floor(0.5f * coordinate) - 1.f);
    unit = unit > 0.f ? unit : 0.f;
    return (unit < 1.f ? unit : 1.f) * static_cast<float>(size);
}

struct Pair {
    int first, second;
    float weight;  // of the second texel
};

// The two texels whose centres lie about a position.
Pair neighbours(float position, Wrap wrap, int size) {
    const float shifted = position + 0.5f;  // at least 0, so that truncation is floor
    const int above = static_cast<int>(shifted);
    const bool repeat = wrap == Wrap::Repeat;
    const int first = above > 0 ? above - 1 : (repeat ? size - 1 : 0);
    const int second = above < size ? above : (repeat ? 0 : size - 1);
    return {first, second, shifted - static_cast<float>(above)};
}

// The one texel that holds a position, as a pair.
Pair nearest(float position, int size) {
    const int texel = std::min(static_cast<int>(position), size - 1);
    return {texel, texel, 0.f};
}

template <class Reader>
f4 filtered(const Reader& read, const TextureLookup& at) {
    const f4 a = read(at.texel[0]), b = read(at.texel[1]);
    const f4 c = read(at.texel[2]), d = read(at.texel[3]);
    const f4 upper = a + (b - a) * at.right, lower = c + (d - c) * at.right;
    return upper + (lower - upper) * at.lower;
}

// Sets the address and format of the texels, and prefetches them.
void fetch(const Image& image, const TextureSlot& slot, TextureLookup& at) {
    using Format = TextureLookup::Format;
    const auto* bytes = std::get_if<std::vector<uint8_t>>(&image.texels);
    const bool srgb = slot.encoding == Encoding::Srgb;
    if (bytes) {
        at.texels = bytes->data();
        at.format = srgb ? Format::SrgbBytes : Format::Bytes;
    } else {
        at.texels = std::get<std::vector<float>>(image.texels).data();
        at.format = srgb ? Format::SrgbFloats : Format::Floats;
    }
    const size_t texel_bytes = bytes ? 4 : 16;
    for (const int row : {0, 2})
        __builtin_prefetch(static_cast<const char*>(at.texels) + at.texel[row] * texel_bytes);
}

}  // namespace

TextureLookup locate_texture(const std::vector<Image>& images, const TextureSlot& slot, V2f uv) {
    if (!slot.present()) return {};
    const Image& image = images[slot.image];
    const float u = uv.x * slot.u_row[0] + uv.y * slot.u_row[1] + slot.u_row[2];
    const float v = uv.x * slot.v_row[0] + uv.y * slot.v_row[1] + slot.v_row[2];
    const float x = wrapped_position(u, slot.wrap_u, image.width);
    const float y = wrapped_position(v, slot.wrap_v, image.height);
    const Pair across =
        slot.nearest ? nearest(x, image.width) : neighbours(x, slot.wrap_u, image.width);
    const Pair down =
        slot.nearest ? nearest(y, image.height) : neighbours(y, slot.wrap_v, image.height);
    const auto width = static_cast<uint32_t>(image.width);
    const uint32_t row0 = down.first * width, row1 = down.second * width;

    TextureLookup at;
    at.texel = {row0 + across.first, row0 + across.second, row1 + across.first,
                row1 + across.second};
    at.right = across.weight;
    at.lower = down.weight;
    fetch(image, slot, at);
    return at;
}

TextureLookup locate_beside(const std::vector<Image>& images, const TextureSlot& slot,
                            const TextureLookup& located) {
    TextureLookup at = located;
    fetch(images[slot.image], slot, at);
    return at;
}

f4 read_texture(const TextureLookup& at) {
    const auto* bytes = static_cast<const uint8_t*>(at.texels);
    const auto* floats = static_cast<const float*>(at.texels);
    switch (at.format) {
        case TextureLookup::Format::None:
            break;
        case TextureLookup::Format::Bytes:
            return filtered(ByteReader{bytes}, at) * (1.f / 255.f);
        case TextureLookup::Format::SrgbBytes:
            return filtered(SrgbByteReader{bytes}, at);
        case TextureLookup::Format::Floats:
            return filtered(FloatReader{floats}, at);
        case TextureLookup::Format::SrgbFloats:
            return filtered(SrgbFloatReader{{floats}}, at);
    }
    return splat(1.f);
}

}  // namespace petzval
