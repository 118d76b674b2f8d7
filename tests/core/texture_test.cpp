// SPDX-License-Identifier: Apache-2.0
#include "core/scene/texture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/spectrum/colour.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Random;

Image byte_image(int width, int height, uint32_t seed) {
    Image image{"test", width, height, std::vector<uint8_t>(4 * width * height)};
    for (uint32_t i = 0; i < 4u * width * height; ++i)
        std::get<std::vector<uint8_t>>(image.texels)[i] = static_cast<uint8_t>(hash32(seed, i));
    return image;
}

Image float_image(int width, int height, uint32_t seed) {
    Image image{"test", width, height, std::vector<float>(4 * width * height)};
    Random random(seed);
    for (float& texel : std::get<std::vector<float>>(image.texels)) texel = 3 * random.next();
    return image;
}

// The index that glTF's wrap modes give a texel outside the image.
int wrapped(int i, int size, Wrap wrap) {
    const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
    if (wrap == Wrap::Repeat) return modulo(i, size);
    if (wrap == Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
    const int j = modulo(i, 2 * size);
    return j < size ? j : 2 * size - 1 - j;
}

double channel(const Image& image, const TextureSlot& slot, int x, int y, int c) {
    const size_t at =
        4 * (static_cast<size_t>(wrapped(y, image.height, slot.wrap_v)) * image.width +
             wrapped(x, image.width, slot.wrap_u)) +
        c;
    const auto* bytes = std::get_if<std::vector<uint8_t>>(&image.texels);
    const float value =
        bytes ? (*bytes)[at] / 255.f : std::get<std::vector<float>>(image.texels)[at];
    return slot.encoding == Encoding::Srgb && c < 3 ? srgb_to_linear(value) : value;
}

// Texel by texel, without any shortcut.
double reference(const Image& image, const TextureSlot& slot, double u, double v, int c) {
    const double x = u * image.width, y = v * image.height;
    if (slot.nearest)
        return channel(image, slot, static_cast<int>(std::floor(x)),
                       static_cast<int>(std::floor(y)), c);
    const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5);
    const double wx = x - 0.5 - fx, wy = y - 0.5 - fy;
    const int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
    return (1 - wy) * ((1 - wx) * channel(image, slot, x0, y0, c) +
                       wx * channel(image, slot, x0 + 1, y0, c)) +
           wy * ((1 - wx) * channel(image, slot, x0, y0 + 1, c) +
                 wx * channel(image, slot, x0 + 1, y0 + 1, c));
}

TEST(Texture, AgreesWithTheReferenceInEveryMode) {
    const std::vector<Image> images{byte_image(16, 8, 1), byte_image(13, 7, 2), byte_image(1, 5, 3),
                                    float_image(9, 4, 4)};
    Random random(5);
    for (int i = 0; i < 60000; ++i) {
        TextureSlot slot;
        slot.image = i % 4;
        slot.wrap_u = static_cast<Wrap>(i / 4 % 3);
        slot.wrap_v = static_cast<Wrap>(i / 12 % 3);
        slot.nearest = i / 36 % 2;
        slot.encoding = static_cast<Encoding>(i / 72 % 2);
        const float u = 6 * random.next() - 3, v = 6 * random.next() - 3;
        const Image& image = images[slot.image];
        const f4 got = sample_texture(images, slot, {u, v});
        const double margin = 1e-5;  // nearest may round to the other side of a texel's edge
        const auto near_edge = [&](double a) { return std::fabs(a - std::round(a)) < margin; };
        if (slot.nearest && (near_edge(u * image.width) || near_edge(v * image.height))) continue;
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(got[c], reference(image, slot, u, v, c), 1e-4)
                << "image " << slot.image << " u " << u << " v " << v << " channel " << c
                << " wrap " << i / 4 % 3 << ", " << i / 12 % 3 << " nearest " << slot.nearest;
    }
}

TEST(Texture, DecodesEverySrgbCode) {
    Image image{"codes", 256, 1, std::vector<uint8_t>(4 * 256)};
    auto& bytes = std::get<std::vector<uint8_t>>(image.texels);
    for (int i = 0; i < 256; ++i) std::fill_n(&bytes[4 * i], 4, static_cast<uint8_t>(i));
    const std::vector<Image> images{image};
    TextureSlot slot;
    slot.image = 0;
    slot.encoding = Encoding::Srgb;
    slot.nearest = true;
    for (int i = 0; i < 256; ++i) {
        const f4 got = sample_texture(images, slot, {(i + 0.5f) / 256, 0.5f});
        const float code = static_cast<float>(i) / 255;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], srgb_to_linear(code), 2e-7) << i;
        ASSERT_NEAR(got[3], code, 1e-7);  // alpha is linear
    }
}

TEST(Texture, DecodesBeforeFiltering) {
    Image image{"edge", 2, 1, std::vector<uint8_t>{0, 0, 0, 255, 255, 255, 255, 255}};
    const std::vector<Image> images{image};
    TextureSlot slot;
    slot.image = 0;
    slot.encoding = Encoding::Srgb;
    EXPECT_NEAR(sample_texture(images, slot, {0.5f, 0.5f})[0], 0.5, 1e-6);
}

TEST(Texture, AppliesTheTransform) {
    const std::vector<Image> images{byte_image(8, 8, 6)};
    TextureSlot plain, moved;
    plain.image = moved.image = 0;
    moved.u_row = {0.5f, -2.f, 0.25f};
    moved.v_row = {1.5f, 0.75f, -0.5f};
    const V2f uv(0.3f, 0.8f);
    const V2f there(0.5f * uv.x - 2.f * uv.y + 0.25f, 1.5f * uv.x + 0.75f * uv.y - 0.5f);
    const f4 a = sample_texture(images, moved, uv), b = sample_texture(images, plain, there);
    for (int c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(a[c], b[c]);
}

TEST(Texture, NoneReadsAsOne) {
    const f4 got = sample_texture({}, TextureSlot{}, {0.3f, 0.4f});
    for (int c = 0; c < 4; ++c) EXPECT_EQ(got[c], 1.f);
}

TEST(Texture, AnyFiniteCoordinateIsDefined) {
    const std::vector<Image> images{byte_image(16, 8, 7), float_image(3, 5, 8)};
    const float huge = std::numeric_limits<float>::max();
    for (const float u : {0.f, -0.f, 1.f, -1.f, kOneMinus, -1e-9f, 1e-9f, 1e9f, -1e9f, huge, -huge})
        for (const float v : {0.f, 1.f, -1e-9f, 12345678.f, -huge})
            for (int i = 0; i < 12; ++i) {
                TextureSlot slot;
                slot.image = i % 2;
                slot.nearest = i / 2 % 2;
                slot.wrap_u = slot.wrap_v = static_cast<Wrap>(i / 4);
                slot.u_row[2] = i % 3 ? 0.f : huge;  // may overflow on the way
                const f4 got = sample_texture(images, slot, {u, v});
                for (int c = 0; c < 4; ++c)
                    ASSERT_TRUE(got[c] >= 0 && got[c] <= 3) << u << " " << v;
            }
}

}  // namespace
}  // namespace petzval
