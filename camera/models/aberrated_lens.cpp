// SPDX-License-Identifier: Apache-2.0
#include "camera/models/aberrated_lens.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "camera/dispersion/hero.h"
#include "core/spectrum/spectrum_table.h"

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
    : in_(std::move(lens)),
      pose_(in_.to_world),
      at_d_(in_.singlet.at(kLineD_nm)),
      focus_mm_(in_.focus_m * 1e3),
      film_mm_(image_distance_mm(at_d_.focal_mm, focus_mm_)),
      tan_half_x_(std::tan(in_.yfov_rad / 2) * in_.aspect),
      tan_half_y_(std::tan(in_.yfov_rad / 2)) {
    require_stop(in_.singlet, in_.iris.bounding_radius_mm(), focus_mm_);
}

CameraSample AberratedLensCamera::sample(const FilmPoint& at, const Bands& bands) const {
    if (in_.dispersion == DispersionMode::Hero && bands.spectral)
        return at.pixel.filter ? hero(at, bands) : sample(at, bands, DispersionMode::Split);
    return sample(at, bands, in_.dispersion);
}

CameraSample AberratedLensCamera::sample(const FilmPoint& at, const Bands& bands,
                                         DispersionMode dispersion) const {
    const V3f through_centre{(2.f * at.film.x - 1.f) * tan_half_x_,
                             (1.f - 2.f * at.film.y) * tan_half_y_, -1.f};
    const V2f stop = in_.iris.sample(at.sampler.get2(Dim::Lens));
    const V3f point_mm{stop.x, stop.y, 0.f};
    const float h_mm = stop.length();
    const bool split = bands.spectral && dispersion != DispersionMode::Shared;
    m4 on = bands.on;
    float weight = in_.exposure;
    if (split && dispersion == DispersionMode::Single) {
        on = only_lane(pick_lane(bands.on, at.sampler.get1(Dim::LensLane)));
        weight *= static_cast<float>(lane_count(bands.on));
    }

    CameraSample out;
    out.exposure = in_.exposure;
    // 1/S for each path's ray. Unlike S it stays finite when the ray crosses no axis ahead.
    std::array<float, 4> vergence_per_mm{};
    for (int lane = 0; lane < 4; ++lane) {
        if (!on[lane]) continue;
        const double n = split ? in_.singlet.glass.index(double(bands.nm[lane])) : at_d_.n;
        const double focal_mm = zonal_mm(n, double(h_mm));
        // Only what holds between the wavelengths that the constructor tried can fail here.
        if (!(focal_mm > kLeastZone / 2 * at_d_.focal_mm)) continue;
        const auto vergence = static_cast<float>(1 / focal_mm - 1 / film_mm_);
        const auto together = [&](size_t k) {
            return h_mm * std::fabs(vergence - vergence_per_mm[k]) <= in_.tolerance_rad &&
                   !(split && dispersion == DispersionMode::Split);
        };
        size_t k = 0;
        while (k < out.size() && !together(k)) ++k;
        const bool is_new = k == out.size();
        CameraPath& path = is_new ? out.add() : out[k];
        if (is_new) {
            vergence_per_mm[k] = vergence;
            path.ray.origin = pose_.origin + pose_.to_world(point_mm * 1e-3f);
            path.ray.direction = unit(pose_.to_world(through_centre - point_mm * vergence));
            path.lanes = m4{};
        }
        path.lanes[lane] = -1;
    }
    for (CameraPath& path : out) path.weight = zero_off(path.lanes, splat(weight));
    return out;
}

// Through a point of the lens, the same ray of the scene belongs to film points that differ by the
// vergences of the lanes.
CameraSample AberratedLensCamera::hero(const FilmPoint& at, const Bands& bands) const {
    const V2f stop = in_.iris.sample(at.sampler.get2(Dim::Lens));
    const int lead = pick_lane(bands.on, at.sampler.get1(Dim::LensLane));
    f4 vergence_per_mm{};
    f4 open = zero_off(bands.on, splat(1.f));
    for (int lane = 0; lane < 4; ++lane) {
        if (!bands.on[lane]) continue;
        const double n = in_.singlet.glass.index(double(bands.nm[lane]));
        const double focal_mm = zonal_mm(n, double(stop.length()));
        if (!(focal_mm > kLeastZone / 2 * at_d_.focal_mm)) open[lane] = 0;
        vergence_per_mm[lane] = static_cast<float>(1 / focal_mm - 1 / film_mm_);
    }
    CameraSample out;
    out.exposure = in_.exposure;
    if (!(open[lead] > 0)) return out;
    const f4 off = vergence_per_mm - splat(vergence_per_mm[lead]);
    const V2f px = 0.5f * at.pixel.frame_px / V2f(tan_half_x_, tan_half_y_);
    const f4 shares =
        hero_shares(at.pixel, off * (stop.x * px.x), off * (-stop.y * px.y), bands.on, open);
    const V3f through_centre{(2.f * at.film.x - 1.f) * tan_half_x_,
                             (1.f - 2.f * at.film.y) * tan_half_y_, -1.f};
    const V3f point_mm{stop.x, stop.y, 0.f};
    const m4 reached = shares > 0;
    if (lane_count(reached) == 0) return out;
    CameraPath& path = out.add();
    path.ray.origin = pose_.origin + pose_.to_world(point_mm * 1e-3f);
    path.ray.direction = unit(pose_.to_world(through_centre - point_mm * vergence_per_mm[lead]));
    path.weight = shares * in_.exposure;
    path.lanes = reached;
    return out;
}

double AberratedLensCamera::zonal_mm(double n, double h_mm) const {
    if (!(n > 1)) return 0;
    const double focal_mm = at_d_.focal_mm * (at_d_.n - 1) / (n - 1);
    return zonal_focal_length_mm({n, focal_mm, at_d_.bending}, focus_mm_, h_mm);
}

}  // namespace petzval
