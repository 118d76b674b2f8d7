// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/axial_spot.h"

#include <cmath>
#include <numbers>

#include "camera/lens/traced_ray.h"

namespace petzval::camera {
namespace {

/// Rays from the object's foot through points of the plane of the first vertex, at one azimuth.
struct Spokes {
    const Lens& lens;
    double object_mm, stop_radius_mm, nm;
    V3d outwards;

    [[nodiscard]] std::optional<TracedRay> trace(double radius_mm) const {
        const V3d at = outwards * radius_mm;
        const V3d along = std::isfinite(object_mm) ? at - V3d(0, 0, object_mm) : V3d(0, 0, 1);
        TracedRay ray = trace_ray(lens, at, along, nm, Towards::Film, Clip::Yes);
        if (ray.status != RayStatus::Passed || !(ray.direction.z > 0)) return std::nullopt;
        const V3d& stop = ray.points[static_cast<size_t>(lens.stop())];
        if (std::hypot(stop.x, stop.y) > stop_radius_mm) return std::nullopt;
        return ray;
    }
    /// Radius of the farthest ray that passes, to the last digits, so that spots change smoothly
    /// with the lens.
    [[nodiscard]] double rim_mm() const {
        double low = 0, high = 2 * lens.prescription().surfaces.front().semi_diameter_mm;
        for (int i = 0; i < 48; ++i) {
            const double middle = (low + high) / 2;
            (trace(middle) ? low : high) = middle;
        }
        return low;
    }
};

}  // namespace

double AxialSpot::mean_square_mm2(double shift_mm) const {
    return square_mm2 + shift_mm * (2 * product_mm + shift_mm * slope_square);
}

double AxialSpot::best_shift_mm() const {
    return slope_square > 0 ? -product_mm / slope_square : 0;
}

std::optional<AxialSpot> axial_spot(const Lens& lens, double object_mm, double film_mm,
                                    double stop_radius_mm) {
    constexpr int rings = 100, azimuths_with_cylinders = 24;
    const int azimuths = lens.of_revolution() ? 1 : azimuths_with_cylinders;
    AxialSpot sum;
    int lines = 0;
    for (const double nm : {kLineF_nm, kLineD_nm, kLineC_nm}) {
        AxialSpot line;
        double area = 0;
        for (int i = 0; i < azimuths; ++i) {
            // One quarter of the pupil is like the others.
            const double azimuth = std::numbers::pi / 2 * (i + 0.5) / azimuths;
            const Spokes spokes{lens, object_mm, stop_radius_mm, nm,
                                V3d(std::cos(azimuth), std::sin(azimuth), 0)};
            const double rim = spokes.rim_mm();
            if (!(rim > 0)) continue;
            for (int k = 0; k < rings; ++k) {
                const auto ray = spokes.trace(rim * std::sqrt((k + 0.5) / rings));
                if (!ray) continue;
                const V3d slope = ray->direction / ray->direction.z;
                const V3d at = ray->point + slope * (film_mm - ray->point.z);
                const double weight = rim * rim;
                area += weight;
                line.square_mm2 += weight * (at.x * at.x + at.y * at.y);
                line.product_mm += weight * (at.x * slope.x + at.y * slope.y);
                line.slope_square += weight * (slope.x * slope.x + slope.y * slope.y);
            }
        }
        if (!(area > 0)) continue;
        ++lines;
        sum.square_mm2 += line.square_mm2 / area;
        sum.product_mm += line.product_mm / area;
        sum.slope_square += line.slope_square / area;
    }
    if (lines == 0) return std::nullopt;
    return AxialSpot{sum.square_mm2 / lines, sum.product_mm / lines, sum.slope_square / lines};
}

}  // namespace petzval::camera
