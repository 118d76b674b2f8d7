// SPDX-License-Identifier: Apache-2.0
#include "core/scene/sky.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/sampling/warp.h"

namespace petzval {
namespace {

// Mean of the bilinear interpolant over the cell of a texel, along one axis: the cell covers half
// of the linear piece on either side of its centre, which gives the neighbours 1/8 each.
float footprint(float before, float centre, float after) {
    return 0.75f * centre + 0.125f * (before + after);
}

// Mean luminance of what a lookup finds within each texel's cell.
std::vector<float> cell_luminance(const std::vector<f4>& texels, int width, int height) {
    std::vector<float> across(texels.size()), both(texels.size());
    const auto at = [width](int x, int y) { return static_cast<size_t>(y) * width + x; };
    const auto lum = [&](int x, int y) { return luminance(Rgb(texels[at(x, y)])); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            across[at(x, y)] = footprint(lum(x > 0 ? x - 1 : width - 1, y), lum(x, y),
                                         lum(x + 1 < width ? x + 1 : 0, y));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            both[at(x, y)] = footprint(across[at(x, std::max(y - 1, 0))], across[at(x, y)],
                                       across[at(x, std::min(y + 1, height - 1))]);
    return both;
}

}  // namespace

Sky Sky::uniform(Rgb radiance) {
    Sky sky;
    sky.colour_ = radiance;
    sky.average_ = luminance(radiance);
    return sky;
}

Sky Sky::picture(std::vector<float> rgb, int width, int height, float rotate_deg, float strength) {
    Sky sky;
    sky.width_ = width;
    sky.height_ = height;
    sky.turn_ = rotate_deg / 360.f - std::floor(rotate_deg / 360.f);
    sky.blocks_across_ = (width + TexelBlock::kSize - 1) / TexelBlock::kSize;
    sky.blocks_.reserve(static_cast<size_t>(sky.blocks_across_) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; x += TexelBlock::kSize) {
            const int count = std::min(TexelBlock::kSize, width - x);
            std::array<f4, TexelBlock::kSize> texels{};
            for (int i = 0; i < count; ++i) {
                const float* texel = &rgb[3 * (static_cast<size_t>(y) * width + x + i)];
                texels[i] = f4{texel[0], texel[1], texel[2], 0.f} * strength;
            }
            sky.blocks_.emplace_back(std::span(texels.data(), count));
        }
    rgb = std::vector<float>();  // "= {}" would keep its memory
    sky.fill_importance();
    return sky;
}

// Importance from the texels as they are kept, so that what is drawn is what lookups find.
void Sky::fill_importance() {
    std::vector<f4> texels;
    texels.reserve(static_cast<size_t>(width_) * height_);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            texels.push_back(blocks_of(y)[x / TexelBlock::kSize].colour(x % TexelBlock::kSize));
    std::vector<float> weights = cell_luminance(texels, width_, height_);
    std::vector<float> block_weights(blocks_.size());
    const auto block_of = [&](int y, int x) {
        std::array<float, TexelBlock::kSize> cells{};
        std::copy_n(&weights[static_cast<size_t>(y) * width_ + x],
                    std::min(TexelBlock::kSize, width_ - x), cells.begin());
        return cells;
    };
    double sum = 0;
    for (int y = 0; y < height_; ++y) {
        // cos a - cos b, written so that nothing cancels at the poles.
        const double half = 0.5 * static_cast<double>(kPi) / height_;
        const double solid_angle =
            4 * static_cast<double>(kPi) / width_ * std::sin(half * (2 * y + 1)) * std::sin(half);
        rows_.push_back({static_cast<float>(std::cos(2 * half * y)),
                         static_cast<float>(1 / (solid_angle * kDistributionUnits))});
        const std::span row(&weights[static_cast<size_t>(y) * width_], width_);
        double row_sum = 0;
        for (float& w : row) row_sum += w *= static_cast<float>(solid_angle);
        sum += row_sum;
        // Four units at least of the row's 2^24: a block then has one for each of its texels.
        const auto least = static_cast<float>(row_sum * 0x1p-22);
        for (float& w : row)
            if (w > 0) w = std::max(w, least);
        for (int x = 0; x < width_; x += TexelBlock::kSize) {
            const auto cells = block_of(y, x);
            block_weights[static_cast<size_t>(y) * blocks_across_ + x / TexelBlock::kSize] =
                std::accumulate(cells.begin(), cells.end(), 0.f);
        }
    }
    rows_.push_back({-1.f, 0.f});
    if (!(sum > 0)) return;
    average_ = static_cast<float>(sum / (4 * static_cast<double>(kPi)));
    importance_ = Piecewise2D(block_weights, blocks_across_, height_);
    for (int y = 0; y < height_; ++y) {
        rows_[y].density *= importance_.row_probability(y);
        for (int i = 0; i < blocks_across_; ++i)
            blocks_[static_cast<size_t>(y) * blocks_across_ + i].divide(
                block_of(y, i * TexelBlock::kSize), importance_.units(i, y));
    }
}

// The polar angle comes from both coordinates, so that it is as exact at the poles as elsewhere.
V2f Sky::to_uv(const V3f& direction) const {
    const float radius = std::sqrt(sqr(direction.x) + sqr(direction.z));
    const f4 turns =
        atan2_turns(f4{direction.z, radius, 0.f, 0.f}, f4{direction.x, direction.y, 1.f, 1.f});
    const float u = 0.5f + turns[0] + turn_;
    return {u - std::floor(u), 2.f * turns[1]};
}

Rgb Sky::filtered(V2f uv) const {
    const float x = uv.x * width_ + 0.5f, y = uv.y * height_ + 0.5f;
    const int right = std::min(static_cast<int>(x), width_),
              below = std::min(static_cast<int>(y), height_);
    const float wx = x - right, wy = y - below;
    const int x0 = right > 0 ? right - 1 : width_ - 1, x1 = right < width_ ? right : 0;
    const TexelBlock* row0 = blocks_of(std::max(below - 1, 0));
    const TexelBlock* row1 = blocks_of(std::min(below, height_ - 1));
    const auto mixed = [&](const TexelBlock* row) {
        const f4 a = row[x0 / TexelBlock::kSize].colour(x0 % TexelBlock::kSize);
        const f4 b = row[x1 / TexelBlock::kSize].colour(x1 % TexelBlock::kSize);
        return a + (b - a) * wx;
    };
    const f4 top = mixed(row0), bottom = mixed(row1);
    return Rgb(zero_off(m4{-1, -1, -1, 0}, top + (bottom - top) * wy));
}

Rgb Sky::radiance(const V3f& direction) const {
    return width_ == 0 ? colour_ : filtered(to_uv(direction));
}

Sky::Found Sky::find(const V3f& direction) const {
    if (width_ == 0 || black()) return {colour_, black() ? 0.f : uniform_sphere_pdf()};
    const V2f uv = to_uv(direction);
    const int column = std::min(static_cast<int>(uv.x * width_), width_ - 1);
    const int row = std::min(static_cast<int>(uv.y * height_), height_ - 1);
    const int block = column / TexelBlock::kSize;
    const uint32_t share = importance_.units(block, row);
    const uint32_t units = blocks_of(row)[block].units(column % TexelBlock::kSize, share);
    return {filtered(uv), static_cast<float>(units) * rows_[row].density};
}

Sky::Draw Sky::sample(V2f u) const {
    if (width_ == 0) return {uniform_sphere(u), uniform_sphere_pdf()};
    const Piecewise2D::UnitDraw drawn = importance_.sample_units(u);
    const int row = static_cast<int>(drawn.row);
    const TexelBlock& block = blocks_of(row)[drawn.column];
    // Prefetch the row that the texels are mixed with while this one is searched.
    const int beside = drawn.row_offset < 0.5f ? row - 1 : row + 1;
    __builtin_prefetch(&blocks_of(std::clamp(beside, 0, height_ - 1))[drawn.column]);
    const int texel = block.find(drawn.unit, drawn.units);
    const uint32_t begin = block.begin(texel, drawn.units);
    const uint32_t units = block.begin(texel + 1, drawn.units) - begin;
    const float offset =
        (static_cast<float>(drawn.unit - begin) + drawn.rest) / static_cast<float>(units);
    const float u_drawn = (static_cast<float>(drawn.column * TexelBlock::kSize + texel) +
                           std::min(offset, kOneMinus)) /
                          width_;
    const float y = lerp(rows_[row].top, rows_[row + 1].top, drawn.row_offset);
    const float radius = safe_sqrt((1.f - y) * (1.f + y));
    const SinCos azimuth = sincos_turns(u_drawn - 0.5f - turn_);
    return {{radius * azimuth.cosine, y, radius * azimuth.sine},
            static_cast<float>(units) * rows_[row].density};
}

}  // namespace petzval
