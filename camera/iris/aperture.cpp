// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/aperture.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace petzval::camera {
namespace {

// Farthest that a polyline may run from its arc, in radii of the polygon's circle.
constexpr double kArcTolerance = 1e-4;

V2d on_circle(double radius, double angle_rad) {
    return {radius * std::cos(angle_rad), radius * std::sin(angle_rad)};
}

void require_count(int n, const char* of) {
    if (n < kMinBlades || n > kMaxBlades)
        throw std::invalid_argument("number of " + std::string(of) + " must be from " +
                                    std::to_string(kMinBlades) + " to " +
                                    std::to_string(kMaxBlades));
}

// Blade edge from an angle to another about its own centre, without its last point. The points
// between the ends stand at a distance q that gives the fan of m triangles the sector's area:
// sin(d) / 2 (2 r q + (m - 2) q^2) = r^2 m d / 2, or for m = 2 without the square.
void add_arc(std::vector<V2d>& contour, double radius, double half_angle_rad, V2d centre,
             double middle_rad) {
    const double finest = std::sqrt(8 * kArcTolerance / radius);  // sagitta r d^2 / 8
    const int m = std::max(2, static_cast<int>(std::ceil(2 * half_angle_rad / finest)));
    const double step = 2 * half_angle_rad / m;
    const double target = m * step / std::sin(step);
    const double q =
        radius * (m == 2 ? target / 2 : (std::sqrt(1 + (m - 2) * target) - 1) / (m - 2));
    for (int i = 0; i < m; ++i)
        contour.push_back(centre +
                          on_circle(i == 0 ? radius : q, middle_rad - half_angle_rad + i * step));
}

}  // namespace

Polygon regular_polygon(int blades, double rotation_deg, double roundness) {
    require_count(blades, "blades");
    if (!std::isfinite(rotation_deg))
        throw std::invalid_argument("rotation must be a finite number of degrees");
    if (!(roundness >= 0 && roundness <= 1))
        throw std::invalid_argument("roundness must be from 0 (straight) to 1 (a circle)");
    const double first = (90 + std::remainder(rotation_deg, 360.0)) * std::numbers::pi / 180;
    const double half = std::numbers::pi / blades;
    std::vector<V2d> contour;
    for (int i = 0; i < blades; ++i) {
        const double angle = first + 2 * half * i;
        // Bulges below a hundredth of the tolerance would only cost vertices.
        const double sagitta = roundness * std::pow(std::sin(half), 2) / 2;
        if (sagitta < 0.01 * kArcTolerance) {
            contour.push_back(on_circle(1, angle));
            continue;
        }
        const double radius = 1 / roundness;
        const double half_angle = std::asin(std::sin(half) * roundness);
        const double centre = std::cos(half) - radius * std::cos(half_angle);
        add_arc(contour, radius, half_angle, on_circle(centre, angle + half), angle + half);
    }
    return {{contour}};
}

Polygon star(int tips) {
    require_count(tips, "tips of a star");
    const double inner = (3 - std::sqrt(5.0)) / 2;
    std::vector<V2d> contour;
    for (int i = 0; i < 2 * tips; ++i)
        contour.push_back(
            on_circle(i % 2 ? inner : 1, std::numbers::pi / 2 + i * std::numbers::pi / tips));
    return {{contour}};
}

Polygon square() {
    return {{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}};
}

Polygon rhomboid() {
    return {{{{-1.25, -0.5}, {0.75, -0.5}, {1.25, 0.5}, {-0.75, 0.5}}}};
}

Polygon frame() {
    return {{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
             {{-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}}}};
}

}  // namespace petzval::camera
