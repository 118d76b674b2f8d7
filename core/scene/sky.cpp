// SPDX-License-Identifier: Apache-2.0
#include "core/scene/sky.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/math/trig.h"

namespace petzval {
namespace {

// Standard deviation over the sphere of the light above the mean, relative to the mean, from which
// it is worth drawing directions: a BSDF that finds all of it has about that noise.
constexpr double kLeastContrast = 0.03;

// Least sine of a polar angle in a density: its inverse stays finite at the poles.
constexpr float kLeastSine = 1e-6f;

// Integral of the light of rows of the sky over the polar angle, for a radiance of 1 at a row's
// centres: of its tent between the neighbours' centres, times the sine. The first and the last row
// also reach to the poles.
std::vector<double> row_weights(int height) {
    if (height == 1) return {2};
    const double step = std::numbers::pi / height;
    std::vector<double> weights;
    for (int y = 0; y < height; ++y)
        weights.push_back(2 * std::sin((y + 0.5) * step) * (1 - std::cos(step)) / step);
    weights.front() = weights.back() = 1 - (std::sin(1.5 * step) - std::sin(0.5 * step)) / step;
    return weights;
}

// Inverse of the cumulative distribution of a tent over (-1, 1).
float sample_tent(float u) {
    return u < 0.5f ? std::sqrt(2.f * u) - 1.f : 1.f - std::sqrt(2.f * (1.f - u));
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

// Importance from the texels as they are kept, so that what is drawn is what lookups find: of what
// is brighter than the mean. The rest is left to the BSDF, which finds it with less noise. Karlik
// et al. 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling",
// section 5.
void Sky::fill_importance() {
    std::vector<float> weights;
    weights.reserve(static_cast<size_t>(width_) * height_);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            weights.push_back(
                luminance(Rgb(blocks_of(y)[x / TexelBlock::kSize].colour(x % TexelBlock::kSize))));
    std::vector<float> block_weights(blocks_.size());
    const auto block_of = [&](int y, int x) {
        std::array<float, TexelBlock::kSize> cells{};
        std::copy_n(&weights[static_cast<size_t>(y) * width_ + x],
                    std::min(TexelBlock::kSize, width_ - x), cells.begin());
        return cells;
    };
    std::vector<double> share;  // of the sphere, of a texel of each row
    for (const double weight : row_weights(height_)) share.push_back(weight / (2.0 * width_));
    const auto mean = [&] {
        double sum = 0;
        for (size_t i = 0; i < weights.size(); ++i) sum += share[i / width_] * double(weights[i]);
        return static_cast<float>(sum);
    };
    average_ = mean();
    for (float& w : weights) w = std::max(w - average_, 0.f);
    double square = 0;
    for (size_t i = 0; i < weights.size(); ++i)
        square += share[i / width_] * sqr(double(weights[i]));
    if (!(std::sqrt(square) > kLeastContrast * double(average_))) return;
    drawn_ = mean();
    for (int y = 0; y < height_; ++y) {
        const std::span row(&weights[static_cast<size_t>(y) * width_], width_);
        double row_sum = 0;
        for (float& w : row) row_sum += w *= static_cast<float>(share[y]);
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
    importance_ = Piecewise2D(block_weights, blocks_across_, height_);
    // A texel is 2 pi^2 sine / (width height) steradians.
    const double per_texel =
        static_cast<double>(width_) * height_ / (2 * sqr(std::numbers::pi) * kDistributionUnits);
    for (int y = 0; y < height_; ++y) {
        row_density_.push_back(static_cast<float>(per_texel * importance_.row_probability(y)));
        for (int i = 0; i < blocks_across_; ++i)
            blocks_[static_cast<size_t>(y) * blocks_across_ + i].divide(
                block_of(y, i * TexelBlock::kSize), importance_.units(i, y));
    }
}

// The polar angle comes from both coordinates, so that it is as exact at the poles as elsewhere.
Sky::Place Sky::place_of(const V3f& direction) const {
    const float radius = std::sqrt(sqr(direction.x) + sqr(direction.z));
    const f4 turns =
        atan2_turns(f4{direction.z, radius, 0.f, 0.f}, f4{direction.x, direction.y, 1.f, 1.f});
    const float u = 0.5f + turns[0] + turn_;
    return {{(u - std::floor(u)) * width_, 2.f * turns[1] * height_}, radius};
}

Sky::Corners Sky::corners_of(V2f texel) const {
    const float x = texel.x + 0.5f, y = texel.y + 0.5f;
    const int right = std::min(static_cast<int>(x), width_),
              below = std::min(static_cast<int>(y), height_);
    return {{right > 0 ? right - 1 : width_ - 1, right < width_ ? right : 0},
            {std::max(below - 1, 0), std::min(below, height_ - 1)},
            {x - right, y - below}};
}

Rgb Sky::radiance_at(const Corners& c) const {
    const auto mixed = [&](int y) {
        const TexelBlock* row = blocks_of(y);
        const f4 a = row[c.column[0] / TexelBlock::kSize].colour(c.column[0] % TexelBlock::kSize);
        const f4 b = row[c.column[1] / TexelBlock::kSize].colour(c.column[1] % TexelBlock::kSize);
        return a + (b - a) * c.weight.x;
    };
    const f4 top = mixed(c.row[0]), bottom = mixed(c.row[1]);
    return Rgb(zero_off(m4{-1, -1, -1, 0}, top + (bottom - top) * c.weight.y));
}

// In units as they are drawn, not by luminance: what is drawn and what is said to be drawn agree.
float Sky::density_at(const Corners& c) const {
    const auto units = [&](int x, int y) {
        const int block = x / TexelBlock::kSize;
        return static_cast<float>(
            blocks_of(y)[block].units(x % TexelBlock::kSize, importance_.units(block, y)));
    };
    const auto mixed = [&](int y) {
        return lerp(units(c.column[0], y), units(c.column[1], y), c.weight.x) * row_density_[y];
    };
    return lerp(mixed(c.row[0]), mixed(c.row[1]), c.weight.y);
}

Rgb Sky::radiance(const V3f& direction) const {
    return width_ == 0 ? colour_ : radiance_at(corners_of(place_of(direction).texel));
}

Sky::Found Sky::find(const Place& place) const {
    if (width_ == 0) return {colour_, 0.f};
    const Corners corners = corners_of(place.texel);
    return {radiance_at(corners),
            even() ? 0.f : density_at(corners) / std::max(place.sine, kLeastSine)};
}

Sky::Found Sky::find(const V3f& direction) const {
    return find(width_ == 0 ? Place{} : place_of(direction));
}

Sky::Draw Sky::sample(V2f u) const {
    const Piecewise2D::UnitDraw drawn = importance_.sample_units(u);
    const int row = static_cast<int>(drawn.row);
    // Read what the texel is mixed with while its block is searched.
    const float off_centre = sample_tent(drawn.row_offset);
    const int beside = std::clamp(off_centre < 0.f ? row - 1 : row + 1, 0, height_ - 1);
    const TexelBlock& block = blocks_of(row)[drawn.column];
    __builtin_prefetch(&blocks_of(beside)[drawn.column]);
    importance_.prefetch(drawn.column, beside);
    const int texel = block.find(drawn.unit, drawn.units);
    const uint32_t begin = block.begin(texel, drawn.units);
    const uint32_t units = block.begin(texel + 1, drawn.units) - begin;
    // The middle of the unit, the grain of random numbers: its edge may be the very rim of the
    // tent.
    const float offset =
        (static_cast<float>(drawn.unit - begin) + 0.5f) / static_cast<float>(units);
    float x =
        static_cast<float>(drawn.column * TexelBlock::kSize + texel) + 0.5f + sample_tent(offset);
    if (x < 0.f) x += width_;
    if (x > width_) x -= width_;
    // Beyond a pole the tent is folded back: with what is before it, it makes the clamped row.
    float y = static_cast<float>(row) + 0.5f + off_centre;
    if (y < 0.f) y = -y;
    if (y > height_) y = 2 * height_ - y;
    const SinCos azimuth = sincos_turns(x / width_ - 0.5f - turn_);
    const SinCos polar = sincos_turns(0.5f * y / height_);
    const float sine = std::max(polar.sine, 0.f);
    return {{sine * azimuth.cosine, polar.cosine, sine * azimuth.sine}, {{x, y}, sine}};
}

}  // namespace petzval
