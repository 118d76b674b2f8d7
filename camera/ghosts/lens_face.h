// SPDX-License-Identifier: Apache-2.0
// Face of a lens: points of its first or last surface by their place beside the axis.
#pragma once

#include <optional>

#include "camera/lens/trace.h"
#include "core/math/math.h"

namespace petzval::camera {

struct FacePoint {
    V3d point_mm;  ///< z from the surface's vertex
    V3d normal;    ///< unit, towards the film
};

/// Point of a surface beside the axis; nothing beyond the conic's reach.
[[nodiscard]] inline std::optional<FacePoint> face_point(const Lens& lens, int surface, V2d at) {
    const SurfaceFacts<double>& s = lens.surfaces<double>()[size_t(surface)];
    if (s.shape == Shape::Asphere) {
        const Asphere<double>& asphere = lens.aspheres<double>()[s.asphere];
        const double r2 = at.x * at.x * asphere.across_x + at.y * at.y * asphere.across_y;
        const lens_trace::Sag<d4> sag = lens_trace::sag_at<d4>(asphere, broadcast<d4>(r2));
        const double height = sag.height[0], slope = sag.slope_by_r[0];
        if (!std::isfinite(height) || !std::isfinite(slope)) return {};
        const V3d up(-at.x * asphere.across_x * slope, -at.y * asphere.across_y * slope, 1);
        return FacePoint{{at.x, at.y, height}, up / up.length()};
    }
    const double curved = s.curvature_x * at.x * at.x + s.curvature_y * at.y * at.y;
    const double under_root = 1 - s.curvature_z * curved;
    if (!(under_root > 0)) return {};
    const double z = curved / (1 + std::sqrt(under_root));
    const V3d up(-s.curvature_x * at.x, -s.curvature_y * at.y, 1 - s.curvature_z * z);
    return FacePoint{{at.x, at.y, z}, up / up.length()};
}

}  // namespace petzval::camera
