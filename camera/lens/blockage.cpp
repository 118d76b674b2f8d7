// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/blockage.h"

#include <array>
#include <cmath>
#include <vector>

#include "camera/lens/paraxial.h"
#include "camera/lens/traced_ray.h"

namespace petzval::camera {
namespace {

constexpr int kAcross = 16;

// Half width and height of the cone to the exit pupil from the film's middle, as tangents. A lens
// whose pupil lies at infinity sends its light within the same angles.
std::array<double, 2> tangents_to_pupil(const Lens& lens) {
    std::array<double, 2> out{};
    const double behind_mm = lens.film_mm() - lens.vertex_mm(lens.last());
    for (const Section section : {Section::X, Section::Y}) {
        const FirstOrder f = first_order(lens, kLineD_nm, section);
        const double tangent =
            f.exit_pupil_diameter_mm / 2 / std::fabs(behind_mm - f.exit_pupil_mm);
        out[section == Section::X ? 0 : 1] = std::isfinite(tangent) ? tangent : 1 / (2 * f.fnumber);
    }
    return out;
}

}  // namespace

std::string Blockage::text() const {
    const auto says = [&](const char* what, const char* look) {
        return std::string(what) + "; check its " + look;
    };
    const std::string how =
        status == RayStatus::Missed ? says("which they do not meet as light can cross it",
                                           "radius, conic, asphere and thickness")
        : status == RayStatus::TotallyReflected
            ? says("which reflects them totally", "radius, asphere and glass")
            : says("whose rim stops them", "semi-diameter and what bends the rays before it");
    return "of " + std::to_string(rays) + " rays from the middle of the film, " +
           std::to_string(stopped) + " end at surface " + std::to_string(surface) +
           " (the first is 0), " + how;
}

std::optional<Blockage> find_blockage(const Lens& lens) {
    const std::array<double, 2> tangent = tangents_to_pupil(lens);
    const V3d middle(0, 0, lens.film_mm());
    std::vector<std::array<int, 4>> ended(static_cast<size_t>(lens.size()));
    int rays = 0, passed = 0;
    for (int i = 0; i < kAcross; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const double x = (2 * i + 1.) / kAcross - 1, y = (2 * j + 1.) / kAcross - 1;
            if (x * x + y * y > 1) continue;
            const TracedRay ray = trace_ray(lens, middle, {x * tangent[0], y * tangent[1], -1},
                                            kLineD_nm, Towards::Scene, Clip::Yes);
            ++rays;
            if (ray.status == RayStatus::Passed)
                ++passed;
            else
                ++ended[static_cast<size_t>(ray.end_surface)][static_cast<size_t>(ray.status)];
        }
    if (10 * passed >= rays) return std::nullopt;
    Blockage worst{0, RayStatus::Missed, 0, rays};
    for (int surface = 0; surface < lens.size(); ++surface)
        for (int status = 1; status < 4; ++status) {
            const int count = ended[static_cast<size_t>(surface)][static_cast<size_t>(status)];
            if (count > worst.stopped) worst = {surface, RayStatus(status), count, rays};
        }
    return worst;
}

double paraxial_irradiance(const Lens& lens, double iris_area_mm2) {
    const std::array<double, 2> tangent = tangents_to_pupil(lens);
    const double stop_mm =
        lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
    const double flat = tangent[0] * tangent[1];
    return flat / (1 + flat) * iris_area_mm2 / (stop_mm * stop_mm);
}

}  // namespace petzval::camera
