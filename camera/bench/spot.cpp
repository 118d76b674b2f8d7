// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/spot.h"

#include <cmath>
#include <numbers>

namespace petzval::camera {
namespace {

std::array<double, 2> moved(const BundleRay& ray, double shift_mm) {
    return {ray.film_mm[0] + shift_mm * ray.slope[0], ray.film_mm[1] + shift_mm * ray.slope[1]};
}

}  // namespace

SpotSize spot_size(std::span<const BundleRay> rays, double shift_mm) {
    const auto count = static_cast<double>(rays.size());
    SpotSize out;
    for (const BundleRay& ray : rays)
        for (size_t k = 0; k < 2; ++k) out.centroid_mm[k] += moved(ray, shift_mm)[k] / count;
    double sum = 0;
    for (const BundleRay& ray : rays)
        for (size_t k = 0; k < 2; ++k) {
            const double off = moved(ray, shift_mm)[k] - out.centroid_mm[k];
            sum += off * off;
        }
    out.rms_mm = std::sqrt(sum / count);
    return out;
}

// Vertex of a parabola: the mean square as a function of the shift.
double best_shift_mm(std::span<const BundleRay> rays) {
    const auto count = static_cast<double>(rays.size());
    double square = 0, product = 0;
    for (size_t k = 0; k < 2; ++k) {
        double place = 0, slope = 0;
        for (const BundleRay& ray : rays) {
            place += ray.film_mm[k] / count;
            slope += ray.slope[k] / count;
        }
        for (const BundleRay& ray : rays) {
            square += (ray.slope[k] - slope) * (ray.slope[k] - slope);
            product += (ray.slope[k] - slope) * (ray.film_mm[k] - place);
        }
    }
    return square > 0 ? -product / square : 0;
}

std::complex<double> geometric_transfer(std::span<const BundleRay> rays, double cycles_per_mm,
                                        Section along) {
    const size_t k = along == Section::X ? 0 : 1;
    std::complex<double> sum;
    for (const BundleRay& ray : rays)
        sum += std::polar(1., -2 * std::numbers::pi * cycles_per_mm * ray.film_mm[k]);
    return sum / static_cast<double>(rays.size());
}

double geometric_mtf(std::span<const BundleRay> rays, double cycles_per_mm, Section along) {
    return std::abs(geometric_transfer(rays, cycles_per_mm, along));
}

std::vector<FanPoint> ray_fan(const Lens& lens, const AimedBundle& bundle, Section along,
                              double film_mm, std::array<double, 2> from_mm, int count) {
    const size_t moves = along == bundle.object().section ? 1 : 0;
    std::vector<PupilPoint> pupil_points;
    for (int i = 0; i < count; ++i) {
        PupilPoint pupil_point = bundle.chief();
        pupil_point[moves] = bundle.least()[moves] +
                             (bundle.most()[moves] - bundle.least()[moves]) * i / (count - 1);
        pupil_points.push_back(pupil_point);
    }
    const double radius_mm =
        lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
    const size_t axis = along == Section::X ? 0 : 1;
    std::vector<FanPoint> out;
    for (const BundleRay& ray : bundle.trace(pupil_points, film_mm))
        out.push_back({ray.stop_mm[axis] / radius_mm,
                       {ray.film_mm[0] - from_mm[0], ray.film_mm[1] - from_mm[1]}});
    return out;
}

}  // namespace petzval::camera
