// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/mask_map.h"

#include <algorithm>

namespace petzval {
namespace {

constexpr float kRound = 0x1p-24f;  // of a float, relative
// Error of Embree's u and v for L D |direction| / |ng . direction|: L the longest edge, D the way
// to the farthest corner. Its robust test (Pluecker coordinates from the ray's origin) rounds
// corners, edges, products and sums, in all at most 29 times; its fast one (Moeller, Trumbore) 37
// times.
constexpr float kRoundings = 40 * kRound;
// Texels of the margin that are left for rounding of texture coordinates, and that, relative.
constexpr float kForUv = 0.25f, kUvRoundings = 40 * kRound;

constexpr int kMargin = MaskMap::kMargin, kReaches = 2 * kMargin + 1;
// Texels along an axis, with those beyond its ends that wrapping leads to. Within kMargin texels of
// a place whose upper left texel is number i, those from i to i + kReaches of these are read.
std::vector<size_t> wrapped_texels(int size, Wrap wrap) {
    std::vector<size_t> at;
    for (int i = -kMargin; i < size + kMargin + 1; ++i)
        at.push_back(wrap == Wrap::Repeat ? (i + kMargin * size) % size
                                          : std::clamp(i, 0, size - 1));
    return at;
}

}  // namespace

MaskMap::MaskMap(const Scene& scene, const Material& m)
    : images(scene.images), slot(m.base_color_texture) {
    if (m.alpha_mode != AlphaMode::Mask || !slot.present()) return;
    const Image& image = images[slot.image];
    const auto* const texels = std::get_if<std::vector<uint8_t>>(&image.texels);
    if (!texels) return;
    // What is filtered lies between texels, but for rounding: one code to spare on each side.
    std::array<uint8_t, 256> of_code{};
    for (int code = 0; code < 256; ++code) {
        const auto alpha = [&](int c) { return m.alpha * static_cast<float>(c) / 255.f; };
        const auto [least, most] = std::minmax({alpha(code - 1), alpha(code + 1)});
        of_code[code] =
            (least >= m.alpha_cutoff ? Covered : 0) | (most < m.alpha_cutoff ? Hole : 0);
    }
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
    answers.resize(width * height / 4 + 1);
    for (size_t y = 0; y < height; ++y) {
        std::fill(row.begin(), row.end(), All);
        for (size_t k = 0; k <= kReaches; ++k)
            for (size_t x = 0; x < width; ++x) row[x] &= rows[down[y + k] * width + x];
        for (size_t x = 0, texel = y * width; x < width; ++x, ++texel)
            answers[texel / 4] |= static_cast<uint8_t>(row[x] << (texel % 4 * 2));
    }
}

MaskedMesh::MaskedMesh(const Scene& scene, const Mesh& mesh, const MaskMap& map)
    : scene_(scene), map_(map) {
    const TextureSlot& slot = map.slot;
    if (map.answers.empty() || !mesh.steps.empty() || !mesh.colours.empty()) return;
    const std::vector<V2f>& uv = mesh.uv_of(slot.uv_set);
    if (uv.empty()) return;
    const Image& image = map.images[slot.image];
    // In texels, less what the row adds; not a number where floats resolve it badly.
    const auto place = [&](const std::array<float, 3>& row, uint32_t corner, int size) {
        const float u = uv[corner].x * row[0], v = uv[corner].y * row[1];
        const float most = (std::fabs(u) + std::fabs(v) + std::fabs(row[2])) * float(size);
        return most * kUvRoundings < kForUv ? (u + v) * float(size) : NAN;
    };
    corners_.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        float texels = 64;  // so that the bounds, of first order, are good
        for (const auto& [row, size] :
             {std::pair(slot.u_row, image.width), std::pair(slot.v_row, image.height)}) {
            const float from = place(row, a, size);
            const float both =
                std::fabs(place(row, b, size) - from) + std::fabs(place(row, c, size) - from);
            if (!(both < kInfinity)) {
                corners_.clear();
                return;
            }
            texels = std::max(texels, both);
        }
        const V3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const float edge = std::max({(q - p).length(), (r - p).length(), (r - q).length()});
        const float doubt = kRoundings * texels * edge / (kMargin - kForUv);
        // The corners are up to an edge farther than the hit; more for bounds of first order.
        corners_.push_back({{uv[a], uv[b], uv[c]}, doubt, 16 * doubt * edge});
    }
}

// Embree inverts the matrix by its adjoint and moves the ray: of matrices that stretch lengths by
// less than 4 or so, that rounds at most as often as its test of a triangle.
float MaskedMesh::rounding_of(const Instance& instance, const Ray& in_world, float t) {
    const M44f& m = instance.to_world;
    float stretch = 0, inverse = 0;  // Frobenius norms; their product is 3 for a similarity
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            stretch += m[j][k] * m[j][k];
            inverse += instance.to_local[j][k] * instance.to_local[j][k];
        }
    if (instance.moves || !(stretch * inverse < 36)) return kInfinity;
    return std::sqrt(inverse) *
           (in_world.origin.length() + V3f(m[3][0], m[3][1], m[3][2]).length() +
            2 * t * in_world.direction.length());
}

}  // namespace petzval
