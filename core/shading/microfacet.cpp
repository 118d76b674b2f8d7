// SPDX-License-Identifier: Apache-2.0
#include "core/shading/microfacet.h"

#include "core/shading/ggx_albedo_table.h"

namespace petzval {

GgxAlbedo ggx_albedo(float cosine, float alpha) {
    constexpr int last = kGgxAlbedoSize - 1;
    const float y = std::sqrt(clamp_unit(alpha)) * last;
    const float x = std::sqrt(clamp_unit(cosine)) * last;
    const int j = std::min(static_cast<int>(y), last - 1);
    const int i = std::min(static_cast<int>(x), last - 1);
    const float fy = y - static_cast<float>(j), fx = x - static_cast<float>(i);
    const auto at = [&](int part) {
        return lerp(lerp(kGgxAlbedo[j][i][part], kGgxAlbedo[j][i + 1][part], fx),
                    lerp(kGgxAlbedo[j + 1][i][part], kGgxAlbedo[j + 1][i + 1][part], fx), fy);
    };
    const float schlick = at(1);
    return {at(0) - schlick, schlick};
}

}  // namespace petzval
