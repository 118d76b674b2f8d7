// SPDX-License-Identifier: Apache-2.0
// Where the stop of a lens lies.
#include <cmath>
#include <limits>
#include <utility>

#include "camera/lens/paraxial.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {

bool add_stop(std::vector<camera::LensSurface>& surfaces, camera::LensSurface surface) {
    const auto before = surfaces.empty() ? std::nullopt : surfaces.back().glass;
    const bool shaped = surface.curvature_1_mm != 0 || !surface.asphere.empty();
    if (!shaped && surface.glass == before) {
        surface.profile = camera::Profile::Rotational;
        surfaces.push_back(std::move(surface));
        return false;
    }
    camera::LensSurface plane;
    plane.stop = true;
    plane.semi_diameter_mm = surface.semi_diameter_mm;
    surface.stop = false;
    if (before) {
        plane.glass = surface.glass;
        plane.thickness_mm = std::exchange(surface.thickness_mm, 0);
        surfaces.push_back(std::move(surface));
        surfaces.push_back(std::move(plane));
    } else {
        surfaces.push_back(std::move(plane));
        surfaces.push_back(std::move(surface));
    }
    return shaped;
}

size_t limiting_surface(const std::vector<camera::LensSurface>& surfaces) {
    size_t found = 0;
    double narrowest = std::numeric_limits<double>::infinity();
    for (const camera::Section section : {camera::Section::Y, camera::Section::X}) {
        const std::vector<double> heights = camera::marginal_heights_mm(surfaces, section);
        for (size_t i = 0; i < surfaces.size(); ++i) {
            const double beam = surfaces[i].semi_diameter_mm / std::fabs(heights[i]);
            if (!(beam < narrowest)) continue;
            narrowest = beam;
            found = i;
        }
    }
    return found;
}

}  // namespace petzval::io
