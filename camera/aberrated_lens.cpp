// SPDX-License-Identifier: Apache-2.0
#include "camera/aberrated_lens.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/spectrum_table.h"
#include "core/warp.h"

namespace petzval {
namespace {

// f(h) below this share of f: so far out that the closed form means nothing.
constexpr double kLeastZone = 0.5;

void require_stop(const Singlet& lens, double radius_mm, double focus_mm) {
    if (!(radius_mm >= 0)) throw std::invalid_argument("radius of the stop must not be negative");
    const double least_mm = std::fmin(std::fabs(lens.r1_mm), std::fabs(lens.r2_mm));
    bool narrow = radius_mm < least_mm;
    for (const double nm : {double(kFirst_nm), kLineD_nm, double(kLast_nm)}) {
        const SingletOptics at = lens.at(nm);
        const double rim_mm = zonal_focal_length_mm(at, focus_mm, radius_mm);
        narrow = narrow && rim_mm > kLeastZone * at.focal_mm;
    }
    if (!narrow)
        throw std::invalid_argument(
            "the stop is too wide for the curves of the lens: "
            "raise the f-number");
}

}  // namespace

AberratedLensCamera::AberratedLensCamera(AberratedLens lens)
    : pose_(lens.to_world),
      singlet_(std::move(lens.singlet)),
      at_d_(singlet_.at(kLineD_nm)),
      radius_mm_(lens.radius_mm),
      focus_mm_(lens.focus_m * 1e3),
      film_mm_(image_distance_mm(at_d_.focal_mm, focus_mm_)),
      tan_half_x_(std::tan(lens.yfov_rad / 2) * lens.aspect),
      tan_half_y_(std::tan(lens.yfov_rad / 2)) {
    require_stop(singlet_, radius_mm_, focus_mm_);
}

CameraSample AberratedLensCamera::sample(const FilmPoint& at, const Bands& bands) const {
    const V3f through_centre{(2.f * at.film.x - 1.f) * tan_half_x_,
                             (1.f - 2.f * at.film.y) * tan_half_y_, -1.f};
    const V2f stop = uniform_disk(at.sampler.get2(Dim::Lens)) * static_cast<float>(radius_mm_);
    const V3f point_mm{stop.x, stop.y, 0.f};
    const double h_mm = double(stop.length());
    const bool split = bands.spectral && radius_mm_ > 0;

    CameraSample out;
    std::array<double, 4> index{};  // of each path
    for (int lane = 0; lane < 4; ++lane) {
        if (!bands.on[lane]) continue;
        const double n = split ? singlet_.glass.index(double(bands.nm[lane])) : at_d_.n;
        int k = 0;
        while (k < out.count && index[k] != n) ++k;
        CameraPath& path = out.path[k];
        if (k == out.count) {
            const double focal_mm = zonal_mm(n, h_mm);
            // Only what holds between the wavelengths that the constructor tried can fail here.
            if (!(focal_mm > kLeastZone / 2 * at_d_.focal_mm)) continue;
            index[k] = n;
            ++out.count;
            // 1/S for this ray. Unlike S it stays finite when the ray crosses no axis ahead.
            const auto vergence_per_mm = static_cast<float>(1 / focal_mm - 1 / film_mm_);
            path.ray.origin = pose_.origin + pose_.to_world(point_mm * 1e-3f);
            path.ray.direction = unit(pose_.to_world(through_centre - point_mm * vergence_per_mm));
            path.lanes = m4{};
        }
        path.lanes[lane] = -1;
    }
    for (int k = 0; k < out.count; ++k) out.path[k].weight = zero_off(out.path[k].lanes, splat(1));
    return out;
}

double AberratedLensCamera::zonal_mm(double n, double h_mm) const {
    if (!(n > 1)) return 0;
    const double focal_mm = at_d_.focal_mm * (at_d_.n - 1) / (n - 1);
    return zonal_focal_length_mm({n, focal_mm, at_d_.bending}, focus_mm_, h_mm);
}

}  // namespace petzval
