// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>

#include "camera/waves/point_spread.h"

namespace petzval::camera {
namespace {

// Point where a ray meets the sphere, from the image point, and the optical path to there.
struct Wavelet {
    V3d from_mm;
    double path_mm;
};

Wavelet on_sphere(const BundleRay& ray, std::array<double, 2> image_mm, double radius_mm,
                  double index) {
    const V3d direction = V3d(ray.slope[0], ray.slope[1], 1).normalized();
    const V3d film(ray.film_mm[0] - image_mm[0], ray.film_mm[1] - image_mm[1], 0);
    const double along = film.dot(direction);
    const double root = std::sqrt(radius_mm * radius_mm - film.dot(film) + along * along);
    const double way = -along - std::copysign(root, radius_mm);
    return {film + way * direction, ray.path_mm + index * way};
}

double signed_radius_mm(const AimedBundle& bundle, double film_mm, std::array<double, 2> image_mm) {
    constexpr double stand_in_mm = 1000;
    const double curvature = reference_sphere(bundle, film_mm, image_mm).curvature_1_mm;
    return std::fabs(curvature) * stand_in_mm > 1 ? 1 / curvature : stand_in_mm;
}

}  // namespace

// U = sum of sqrt(light of the patch * its area across the axis) exp(i k path) / (wavelength R):
// the light of a patch is that of its rays, the area that of the quadrangle of its corners' rays.
std::vector<double> huygens_spread(const AimedBundle& bundle, double film_mm,
                                   std::array<double, 2> image_mm,
                                   std::span<const std::array<double, 2>> offsets_mm, int side) {
    const double radius_mm = signed_radius_mm(bundle, film_mm, image_mm);
    const double index = bundle.film_index(), wavelength_mm = bundle.nm() * 1e-6;
    const double width = (bundle.most()[0] - bundle.least()[0]) / side;
    const double height = (bundle.most()[1] - bundle.least()[1]) / side;
    const auto corner = [&](int i, int j) {
        return PupilPoint{bundle.least()[0] + i * width, bundle.least()[1] + j * height};
    };
    std::vector<std::complex<double>> sums(offsets_mm.size());
    double light = 0, first_path_mm = NAN;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const PupilPoint middle{corner(i, j)[0] + width / 2, corner(i, j)[1] + height / 2};
            const auto ray = bundle.trace({&middle, 1}, film_mm);
            if (ray.empty()) continue;
            const std::array corners{corner(i, j), corner(i + 1, j + 1), corner(i + 1, j),
                                     corner(i, j + 1)};
            const auto rim = bundle.trace(corners, film_mm, Clip::No);
            if (rim.size() < 4) continue;
            const auto at = [&](size_t k) {
                return on_sphere(rim[k], image_mm, radius_mm, index).from_mm;
            };
            const V3d one = at(1) - at(0), other = at(3) - at(2);
            const double area = std::fabs(one.x * other.y - one.y * other.x) / 2;
            const Wavelet from = on_sphere(ray[0], image_mm, radius_mm, index);
            if (std::isnan(first_path_mm)) first_path_mm = from.path_mm;
            light += width * height;
            const double strength = std::sqrt(width * height * area) / std::fabs(radius_mm);
            for (size_t k = 0; k < sums.size(); ++k) {
                const V3d to(offsets_mm[k][0], offsets_mm[k][1], 0);
                const double distance_mm =
                    std::copysign((to - from.from_mm).length(), radius_mm) - radius_mm;
                const double path_mm = from.path_mm - first_path_mm + index * distance_mm;
                sums[k] += std::polar(strength, 2 * std::numbers::pi * path_mm / wavelength_mm);
            }
        }
    std::vector<double> out;
    for (const auto& sum : sums) out.push_back(std::norm(sum * index / wavelength_mm) / light);
    return out;
}

}  // namespace petzval::camera
