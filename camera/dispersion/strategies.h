// SPDX-License-Identifier: Apache-2.0
// Dispersion strategies: ways to carry wavelengths through a lens that disperses, written once for
// every camera.
#pragma once

#include "camera/dispersion/dispersion_mode.h"
#include "camera/dispersion/hero.h"
#include "camera/dispersion/lens_point.h"

namespace petzval::camera {

/// A sample without paths yet: what the rays lost, and the exposure.
template <LensPoint P, class Rays>
[[nodiscard]] CameraSample begun_sample(const P& lens, const Rays& rays) {
    CameraSample out;
    out.lanes = rays.losses;
    out.exposure = lens.exposure();
    if constexpr (requires { lens.density(rays); }) out.density = lens.density(rays);
    return out;
}

/// One ray for all lanes; `lens` gives them all the same.
template <LensPoint P>
[[nodiscard]] CameraSample share_ray(const P& lens, int hero, m4 on) {
    const auto rays = lens.rays({on, hero, true});
    CameraSample out = begun_sample(lens, rays);
    const f4 weight = rays.weight_of_lanes();
    const m4 passed = weight > 0;
    int first = 0;
    while (first < 4 && !passed[first]) ++first;
    if (first == 4) return out;
    CameraPath& path = out.add();
    path.ray = lens.ray(rays, first);
    path.lanes = passed;
    path.weight = zero_off(passed, weight);
    return out;
}

/// One ray for each lane.
template <LensPoint P>
[[nodiscard]] CameraSample split_rays(const P& lens, int hero, m4 on) {
    const auto rays = lens.rays({on, hero, true});
    CameraSample out = begun_sample(lens, rays);
    const f4 weight = rays.weight_of_lanes();
    for (int lane = 0; lane < 4; ++lane) {
        if (!(weight[lane] > 0)) continue;
        CameraPath& path = out.add();
        path.hero_decided = true;
        path.ray = lens.ray(rays, lane);
        path.lanes = only_lane(lane);
        path.weight = zero_off(path.lanes, weight);
    }
    return out;
}

/// The ray of one lane, weighed for each lane by where it would have reached the film (hero.h).
template <LensPoint P>
[[nodiscard]] CameraSample hero_ray(const P& lens, int hero, m4 on, const PixelFilter& pixel) {
    const LaneRequest request{only_lane(hero), hero, false};
    const auto rays = lens.rays(request);
    CameraSample out = begun_sample(lens, rays);
    const float of_hero = rays.weight_of_lanes()[hero];
    if (!(of_hero > 0)) return out;
    const FilmLanding landing = lens.landing(rays, request);
    const f4 shares = hero_shares(pixel, landing, hero, on);
    // One lane's weight counts for all that are on.
    const f4 weight = shares * landing.transmitted * (of_hero / static_cast<float>(lane_count(on)));
    const m4 reached = weight > 0;
    if (lane_count(reached) == 0) return out;
    CameraPath& path = out.add();
    path.hero_decided = true;
    path.ray = lens.ray(rays, hero);
    path.weight = weight;
    path.lanes = reached;
    return out;
}

/// The paths of a film point through a lens. A hero ray needs the pixel's filter; without one,
/// lanes are split.
template <LensPoint P>
[[nodiscard]] CameraSample sample_lens(const P& lens, DispersionMode mode, const PixelFilter& pixel,
                                       const Bands& bands) {
    const int hero = bands.hero;
    if (one_ray(bands, mode)) return share_ray(lens, hero, bands.on);
    if (mode == DispersionMode::Hero && pixel.filter) return hero_ray(lens, hero, bands.on, pixel);
    return split_rays(lens, hero, bands.on);
}

}  // namespace petzval::camera
