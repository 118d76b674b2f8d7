// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/iris_mask.h"

#include <algorithm>

#include "camera/iris/trapezoids.h"

namespace petzval::camera {

MaskIris::MaskIris(const Mask& mask, double texel_mm)
    : texels_(mask.texels),
      table_(texels_, static_cast<uint32_t>(mask.width), static_cast<uint32_t>(mask.height)),
      half_(static_cast<float>(mask.width) / 2, static_cast<float>(mask.height) / 2),
      texel_mm_(static_cast<float>(texel_mm)),
      texels_per_mm_(static_cast<float>(1 / texel_mm)),
      peak_(*std::max_element(texels_.begin(), texels_.end())),
      texel_area_(texel_mm * texel_mm) {}

double MaskIris::area_within_mm2(double radius_mm) const {
    const double texel_mm = std::sqrt(texel_area_);
    double area = 0;
    for (uint32_t row = 0; row < table_.height(); ++row)
        for (uint32_t column = 0; column < table_.width(); ++column) {
            const float weight = texels_[size_t{row} * table_.width() + column];
            if (!(weight > 0)) continue;
            const double x = (column - double{half_.x}) * texel_mm;
            const double y = (double{half_.y} - row - 1) * texel_mm;
            area += weight * area_in_circle({y, y + texel_mm, {x, x}, {x + texel_mm, x + texel_mm}},
                                            radius_mm);
        }
    return area;
}

}  // namespace petzval::camera
