// SPDX-License-Identifier: Apache-2.0
#include "core/shading/sheen.h"

#include <algorithm>

#include "core/shading/sheen_albedo_table.h"

namespace petzval {
namespace {

// Coefficients of the shadowing at the widths 0 and 1: Estevez and Kulla 2017, table 1.
constexpr float kNarrow[5] = {25.3245f, 3.32435f, 0.16801f, -1.27393f, -4.85967f};
constexpr float kWide[5] = {21.5473f, 3.82987f, 0.19823f, -1.97760f, -4.32054f};

float albedo_in_table(float roughness, float cosine) {
    constexpr int last = kSheenAlbedoSize - 1;
    const float way = (roughness - kSmallestSheenRoughness) / (1 - kSmallestSheenRoughness);
    const float y = std::sqrt(way) * last;
    const float x = std::sqrt(clamp_unit(cosine)) * last;
    const int j = std::min(static_cast<int>(y), last - 1);
    const int i = std::min(static_cast<int>(x), last - 1);
    const float fy = y - static_cast<float>(j), fx = x - static_cast<float>(i);
    return lerp(lerp(kSheenAlbedo[j][i], kSheenAlbedo[j][i + 1], fx),
                lerp(kSheenAlbedo[j + 1][i], kSheenAlbedo[j + 1][i + 1], fx), fy);
}

}  // namespace

Sheen::Sheen(float roughness, float cosine) {
    roughness = std::clamp(roughness, kSmallestSheenRoughness, 1.f);
    const float alpha = sqr(roughness), narrow = sqr(1 - alpha);
    per_alpha_ = 1 / alpha;
    for (int i = 0; i < 5; ++i) curve_[i] = lerp(kWide[i], kNarrow[i], narrow);
    at_half_ = curve(0.5f);
    lambda_o_ = lambda(cosine);
    const float whole = albedo_in_table(roughness, cosine);
    albedo_ = std::min(whole, 1.f);
    scale_ = albedo_ < whole ? albedo_ / whole : 1.f;
}

float Sheen::curve(float x) const {
    return curve_[0] / (1 + curve_[1] * std::pow(x, curve_[2])) + curve_[3] * x + curve_[4];
}

float Sheen::lambda(float cosine) const {
    return std::exp(cosine < 0.5f ? curve(cosine) : 2 * at_half_ - curve(1 - cosine));
}

float Sheen::f_cos(const V3f& wo, const V3f& wi) const {
    const V3f h = unit(wo + wi);
    const float sin2 = clamp_unit(1 - sqr(h.z));
    const float density = (2 + per_alpha_) * std::pow(sin2, 0.5f * per_alpha_) * (0.5f * kInvPi);
    return scale_ * density / ((1 + lambda_o_ + lambda(wi.z)) * 4 * wo.z);
}

}  // namespace petzval
