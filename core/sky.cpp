// SPDX-License-Identifier: Apache-2.0
#include "core/sky.h"

#include <algorithm>

#include "core/warp.h"

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
    sky.texels_.resize(static_cast<size_t>(width) * height);
    for (size_t i = 0; i < sky.texels_.size(); ++i)
        sky.texels_[i] = f4{rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 0.f} * strength;
    for (int y = 0; y <= height; ++y)
        sky.row_height_.push_back(
            static_cast<float>(std::cos(static_cast<double>(kPi) * y / height)));

    std::vector<float> weights = cell_luminance(sky.texels_, width, height);
    std::vector<float> solid_angle(height);
    for (int y = 0; y < height; ++y) {
        // cos a - cos b, written so that nothing cancels at the poles.
        const double half = 0.5 * static_cast<double>(kPi) / height;
        solid_angle[y] = static_cast<float>(4 * static_cast<double>(kPi) / width *
                                            std::sin(half * (2 * y + 1)) * std::sin(half));
        for (int x = 0; x < width; ++x)
            weights[static_cast<size_t>(y) * width + x] *= solid_angle[y];
    }
    if (std::none_of(weights.begin(), weights.end(), [](float w) { return w > 0; })) return sky;
    sky.importance_ = Piecewise2D(weights, width, height);
    sky.average_ = static_cast<float>(sky.importance_.sum() / (4 * static_cast<double>(kPi)));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            sky.texels_[static_cast<size_t>(y) * width + x][3] =
                sky.importance_.probability(x, y) / solid_angle[y];
    return sky;
}

// The polar angle comes from both coordinates, so that it is as exact at the poles as elsewhere.
V2f Sky::to_uv(const V3f& direction) const {
    const float u = 0.5f + atan2_turns(direction.z, direction.x) + turn_;
    const float radius = std::sqrt(sqr(direction.x) + sqr(direction.z));
    return {u - std::floor(u), 2.f * atan2_turns(radius, direction.y)};
}

Rgb Sky::filtered(V2f uv) const {
    const float x = uv.x * width_ + 0.5f, y = uv.y * height_ + 0.5f;
    const int right = std::min(static_cast<int>(x), width_),
              below = std::min(static_cast<int>(y), height_);
    const float wx = x - right, wy = y - below;
    const int x0 = right > 0 ? right - 1 : width_ - 1, x1 = right < width_ ? right : 0;
    const f4* row0 = &texels_[static_cast<size_t>(std::max(below - 1, 0)) * width_];
    const f4* row1 = &texels_[static_cast<size_t>(std::min(below, height_ - 1)) * width_];
    const f4 top = row0[x0] + (row0[x1] - row0[x0]) * wx;
    const f4 bottom = row1[x0] + (row1[x1] - row1[x0]) * wx;
    const f4 texel = top + (bottom - top) * wy;
    return Rgb(f4{texel[0], texel[1], texel[2], 0.f});
}

Sky::Found Sky::find(const V3f& direction) const {
    if (width_ == 0) return {colour_, black() ? 0.f : uniform_sphere_pdf()};
    const V2f uv = to_uv(direction);
    const int column = std::min(static_cast<int>(uv.x * width_), width_ - 1);
    const int row = std::min(static_cast<int>(uv.y * height_), height_ - 1);
    return {filtered(uv), texels_[static_cast<size_t>(row) * width_ + column][3]};
}

Sky::Draw Sky::sample(V2f u) const {
    if (width_ == 0) return {uniform_sphere(u), colour_, uniform_sphere_pdf()};
    const Piecewise2D::Draw cell = importance_.sample(u);
    const size_t texel = static_cast<size_t>(cell.row) * width_ + cell.column;
    const float u_drawn = (cell.column + cell.offset.x) / width_;
    const float y = lerp(row_height_[cell.row], row_height_[cell.row + 1], cell.offset.y);
    const float radius = safe_sqrt((1.f - y) * (1.f + y));
    const SinCos azimuth = sincos_turns(u_drawn - 0.5f - turn_);
    const V3f direction(radius * azimuth.cosine, y, radius * azimuth.sine);
    const float v = 2.f * atan2_turns(radius, y);
    return {direction, filtered({u_drawn, v}), texels_[texel][3]};
}

}  // namespace petzval
