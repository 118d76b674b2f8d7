// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/mask_map.h"

#include <algorithm>

namespace petzval {
namespace {

enum Answer : uint8_t { Hole = 1, Covered = 2, All = 3 };

// Rounding of a float, relative.
constexpr float kRound = 0x1p-24f;
// Error of u and v for L D |direction| / |ng . direction|, where L is the longest edge, D the way
// to the farthest corner and ng the product of two edges. Embree's robust test (Pluecker
// coordinates from the ray's origin) rounds corners, edges, products and sums once each: in all 29
// times, its fast test (Moeller and Trumbore) 37 times, where the ray passes a corner.
constexpr float kRoundings = 40 * kRound;
// Texels of the margin that are left for the rounding of texture coordinates, and how much that is
// at most, relative.
constexpr float kForUv = 0.25f, kUvRoundings = 40 * kRound;

// Texels along an axis, with those beyond its ends that wrapping leads to. Within kMargin texels of
// a place whose upper left texel is number i, those from i to i + kReaches of these are read.
constexpr int kMargin = MaskMap::kMargin, kReaches = 2 * kMargin + 1;
std::vector<size_t> wrapped_texels(int size, Wrap wrap) {
    std::vector<size_t> at;
    for (int i = -kMargin; i < size + kMargin + 1; ++i)
        at.push_back(wrap == Wrap::Repeat ? (i + kMargin * size) % size
                                          : std::clamp(i, 0, size - 1));
    return at;
}

}  // namespace

std::optional<MaskMap> MaskMap::of(const Scene& scene, const Material& material) {
    const TextureSlot& slot = material.base_color_texture;
    if (material.alpha_mode != AlphaMode::Mask || !slot.present()) return std::nullopt;
    const Image& image = scene.images[slot.image];
    const auto* const texels = std::get_if<std::vector<uint8_t>>(&image.texels);
    if (!texels) return std::nullopt;
    // What is filtered lies between texels, but for rounding: one code to spare on each side.
    std::array<uint8_t, 256> of_code{};
    for (int code = 0; code < 256; ++code) {
        const auto [least, most] = std::minmax(
            {material.alpha * float(code - 1) / 255.f, material.alpha * float(code + 1) / 255.f});
        of_code[code] = (least >= material.alpha_cutoff ? Covered : 0) |
                        (most < material.alpha_cutoff ? Hole : 0);
    }
    MaskMap map(scene.images, slot);
    const auto width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
    const auto across = wrapped_texels(image.width, slot.wrap_u);
    const auto down = wrapped_texels(image.height, slot.wrap_v);
    std::vector<uint8_t> rows(width * height, All), row(across.size());
    for (size_t y = 0; y < height; ++y) {
        for (size_t i = 0; i < row.size(); ++i)
            row[i] = of_code[(*texels)[4 * (y * width + across[i]) + 3]];
        for (size_t k = 0; k <= kReaches; ++k)
            for (size_t x = 0; x < width; ++x) rows[y * width + x] &= row[x + k];
    }
    map.answers_.resize(width * height / 4 + 1);
    for (size_t y = 0; y < height; ++y) {
        std::fill(row.begin(), row.end(), All);
        for (size_t k = 0; k <= kReaches; ++k)
            for (size_t x = 0; x < width; ++x) row[x] &= rows[down[y + k] * width + x];
        for (size_t x = 0, texel = y * width; x < width; ++x, ++texel)
            map.answers_[texel / 4] |= static_cast<uint8_t>(row[x] << (texel % 4 * 2));
    }
    return map;
}

std::optional<MaskedMesh> MaskedMesh::of(const Scene& scene, const Mesh& mesh, const MaskMap& map) {
    const TextureSlot& slot = map.slot();
    const std::vector<V2f>& uv = mesh.uv_of(slot.uv_set);
    if (!mesh.steps.empty() || !mesh.colours.empty() || uv.empty()) return std::nullopt;
    MaskedMesh masked(scene, map);
    // Texels along an axis, less what the row adds; not a number where floats resolve them badly.
    const auto place = [&](const std::array<float, 3>& row, uint32_t corner, int size) {
        const float u = uv[corner].x * row[0], v = uv[corner].y * row[1];
        const float most = (std::fabs(u) + std::fabs(v) + std::fabs(row[2])) * float(size);
        return most * kUvRoundings < kForUv ? (u + v) * float(size) : NAN;
    };
    masked.corners_.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        float texels = 64;  // so that the bounds, of first order, are good
        for (const auto& [row, size] : {std::pair(slot.u_row, map.image().width),
                                        std::pair(slot.v_row, map.image().height)}) {
            const float from = place(row, a, size);
            const float both =
                std::fabs(place(row, b, size) - from) + std::fabs(place(row, c, size) - from);
            if (!(both < kInfinity)) return std::nullopt;
            texels = std::max(texels, both);
        }
        const V3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const float edge = std::max({(q - p).length(), (r - p).length(), (r - q).length()});
        const float one = kRoundings * texels * edge / (MaskMap::kMargin - kForUv);
        // The corners are up to an edge farther than the hit; more for bounds of first order.
        masked.corners_.push_back({{uv[a], uv[b], uv[c]}, one, 16 * one * edge});
    }
    return masked;
}

// Embree inverts the matrix by its adjoint. That, and moving origin and direction, rounds 8 (skew +
// 1) times, where skew is 1 for columns at right angles.
V2f MaskedMesh::rounding_of(const Instance& instance) {
    const M44f& m = instance.to_world;
    const V3f x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]);
    const float volume = std::fabs(x.cross(y).dot(z));
    const float skew = x.length() * y.length() * z.length() / volume;
    const auto squares = [](const V3f& a, const V3f& b, const V3f& c) {
        return a.dot(a) + b.dot(b) + c.dot(c);
    };
    const float inverse = std::sqrt(squares(x.cross(y), y.cross(z), z.cross(x))) / volume;
    const float stretch = inverse * std::sqrt(squares(x, y, z));  // 3 for a similarity
    if (instance.moves || !(skew < 4 && stretch < 12)) return V2f(kInfinity);
    const float rounding = 8 * (skew + 1) * kRound / kRoundings * inverse;
    return {rounding, rounding * V3f(m[3][0], m[3][1], m[3][2]).length()};
}

}  // namespace petzval
