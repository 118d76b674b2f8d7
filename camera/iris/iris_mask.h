// SPDX-License-Identifier: Apache-2.0
// A grey-scale mask in millimetres: drawn in proportion to its transmission.
#pragma once

#include "camera/iris/aperture.h"
#include "core/sampling/distribution.h"

namespace petzval::camera {

class MaskIris {
  public:
    /// The mask must be without fault.
    MaskIris(const Mask&, double texel_mm);

    [[nodiscard]] V2f draw(V2f u) const {
        const Piecewise2D::Draw d = table_.sample(u);
        return {(static_cast<float>(d.column) - half_.x + d.offset.x) * texel_mm_,
                (half_.y - static_cast<float>(d.row) - d.offset.y) * texel_mm_};
    }
    [[nodiscard]] float transmits(V2f p) const {
        const float x = p.x * texels_per_mm_ + half_.x, y = half_.y - p.y * texels_per_mm_;
        if (!(x >= 0.f && y >= 0.f && x < 2 * half_.x && y < 2 * half_.y)) return 0.f;
        return texels_[static_cast<size_t>(y) * table_.width() + static_cast<size_t>(x)];
    }
    [[nodiscard]] float peak() const { return peak_; }
    [[nodiscard]] V2f lower() const { return half_ * -texel_mm_; }
    [[nodiscard]] V2f size() const { return half_ * (2 * texel_mm_); }
    [[nodiscard]] double area_mm2() const { return table_.sum() * texel_area_; }
    [[nodiscard]] double area_within_mm2(double radius_mm) const;

  private:
    std::vector<float> texels_;
    Piecewise2D table_;
    V2f half_;  ///< half of width and height
    float texel_mm_, texels_per_mm_, peak_;
    double texel_area_;
};

}  // namespace petzval::camera
