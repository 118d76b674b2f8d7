// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/lens_scale.h"

#include <cmath>
#include <stdexcept>

#include "camera/bench/analysis.h"

namespace petzval::camera {

Prescription scaled(Prescription p, double factor) {
    if (!(factor > 0) || !std::isfinite(factor))
        throw std::invalid_argument("a lens is scaled by a finite factor above 0");
    for (LensSurface& surface : p.surfaces) {
        surface.curvature_1_mm /= factor;
        surface.thickness_mm *= factor;
        surface.semi_diameter_mm *= factor;
        for (auto& [power, coefficient] : surface.asphere)
            coefficient *= std::pow(factor, 1 - power);
    }
    p.image_circle_mm *= factor;
    if (p.stated_focal_length_mm) *p.stated_focal_length_mm *= factor;
    return p;
}

std::optional<double> scale_for_field(const Lens& lens, double half_height_mm,
                                      double half_field_deg, double film_mm) {
    constexpr int side = 64;
    const auto bundle = AimedBundle::aim(lens, {.field_deg = half_field_deg}, kLineD_nm);
    if (!bundle || bundle->trace(bundle->grid(side), film_mm).empty()) return std::nullopt;
    const auto height_mm = chief_height_mm(lens, bundle->object(), film_mm);
    if (!height_mm || !(*height_mm > 0)) return std::nullopt;
    return half_height_mm / *height_mm;
}

}  // namespace petzval::camera
