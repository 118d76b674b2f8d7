// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/profile.h"

#include <algorithm>
#include <cmath>

namespace petzval::camera {

double sag_mm(const LensSurface& surface, double height_mm, Section section) {
    const auto straight = section == Section::X ? Profile::CylinderX : Profile::CylinderY;
    if (surface.profile == straight) return 0;
    const double c = surface.curvature_1_mm, r = std::fabs(height_mm);
    double z = c * r * r / (1 + std::sqrt(1 - (1 + surface.conic) * c * c * r * r));
    for (const auto& [power, coefficient] : surface.asphere) z += coefficient * std::pow(r, power);
    return z;
}

Outline surface_outline(const Lens& lens, int surface, Section section) {
    const LensSurface& s = lens.prescription().surfaces[static_cast<size_t>(surface)];
    const bool plane = s.curvature_1_mm == 0 && s.asphere.empty();
    const int steps = plane ? 2 : 64;
    Outline out;
    for (int i = -steps / 2; i <= steps / 2; ++i) {
        const double height = s.semi_diameter_mm * 2 * i / steps;
        const double z = sag_mm(s, height, section);
        if (std::isfinite(z)) out.push_back({lens.vertex_mm(surface) + z, height});
    }
    return out;
}

Outline element_outline(const Lens& lens, int surface, Section section) {
    const auto& surfaces = lens.prescription().surfaces;
    if (surface >= lens.last() || !surfaces[static_cast<size_t>(surface)].glass) return {};
    Outline front = surface_outline(lens, surface, section);
    Outline back = surface_outline(lens, surface + 1, section);
    if (front.empty() || back.empty()) return {};
    const double rim = std::max(front.back()[1], back.back()[1]);
    const auto add_rims = [rim](Outline& face) {
        if (face.back()[1] == rim) return;
        face.insert(face.begin(), {face.front()[0], -rim});
        face.push_back({face.back()[0], rim});
    };
    add_rims(front);
    add_rims(back);
    front.insert(front.end(), back.rbegin(), back.rend());
    return front;
}

}  // namespace petzval::camera
