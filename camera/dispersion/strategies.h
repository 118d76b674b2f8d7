// SPDX-License-Identifier: Apache-2.0
// Dispersion strategies: ways to carry wavelengths through a lens that disperses, written once for
// every camera.
#pragma once

#include "camera/dispersion/dispersion_mode.h"
#include "camera/dispersion/hero.h"
#include "camera/dispersion/lens_point.h"

namespace petzval {

/// Paths of the lanes that passed. Lanes for which share(a, b) holds have the ray of the first.
template <LensPoint P, class Rays, class Share>
[[nodiscard]] CameraSample group_lanes(const P& lens, const Rays& rays, const Share& share) {
    CameraSample out;
    out.lanes = rays.losses;
    out.exposure = lens.exposure();
    const f4 weight = rays.weight_of_lanes();
    m4 left = weight > 0;
    for (int lane = 0; lane < 4; ++lane) {
        if (!left[lane]) continue;
        CameraPath& path = out.add();
        path.led = true;
        path.ray = lens.ray(rays, lane);
        path.lanes = left;
        for (int other = lane + 1; other < 4; ++other)
            if (left[other] && !share(lane, other)) path.lanes[other] = 0;
        path.weight = zero_off(path.lanes, weight);
        left &= ~path.lanes;
    }
    return out;
}

/// One ray for all lanes; `lens` gives them all the same.
template <LensPoint P>
[[nodiscard]] CameraSample share_ray(const P& lens, int lead, m4 on) {
    const auto rays = lens.rays({on, lead, true});
    CameraSample out = group_lanes(lens, rays, [](int, int) { return true; });
    for (CameraPath& path : out) path.led = false;
    return out;
}

/// One ray for each lane.
template <LensPoint P>
[[nodiscard]] CameraSample split_rays(const P& lens, int lead, m4 on) {
    const auto rays = lens.rays({on, lead, true});
    return group_lanes(lens, rays, [](int, int) { return false; });
}

/// One ray for lanes that stay within the camera's tolerance, else one for each.
template <LensPoint P>
[[nodiscard]] CameraSample share_within_tolerance(const P& lens, int lead, m4 on) {
    const auto rays = lens.rays({on, lead, true});
    return group_lanes(lens, rays, [&](int a, int b) { return lens.together(rays, a, b); });
}

/// The ray of one lane, which stands for all.
template <LensPoint P>
[[nodiscard]] CameraSample single_ray(const P& lens, int lead) {
    const auto rays = lens.rays({only_lane(lead), lead, true});
    return group_lanes(lens, rays, [](int, int) { return true; });
}

/// The ray of one lane, weighed for each lane by where it would have reached the film (hero.h).
template <LensPoint P>
[[nodiscard]] CameraSample hero_ray(const P& lens, int lead, m4 on, const PixelFilter& pixel) {
    const LaneRequest request{only_lane(lead), lead, false};
    const auto rays = lens.rays(request);
    CameraSample out;
    out.lanes = rays.losses;
    out.exposure = lens.exposure();
    const float of_lead = rays.weight_of_lanes()[lead];
    if (!(of_lead > 0)) return out;
    const FilmLanding landing = lens.landing(rays, request);
    const f4 shares = hero_shares(pixel, landing, lead, on);
    // One lane's weight counts for all that are on.
    const f4 weight = shares * landing.transmitted * (of_lead / static_cast<float>(lane_count(on)));
    const m4 reached = weight > 0;
    if (lane_count(reached) == 0) return out;
    CameraPath& path = out.add();
    path.led = true;
    path.ray = lens.ray(rays, lead);
    path.weight = weight;
    path.lanes = reached;
    return out;
}

/// The paths of a film point through a lens. A hero ray needs the pixel's filter; without one,
/// lanes are split.
template <LensPoint P>
[[nodiscard]] CameraSample sample_lens(const P& lens, DispersionMode mode, const PixelFilter& pixel,
                                       const Bands& bands) {
    const int lead = bands.lead;
    if (one_ray(bands, mode)) return share_ray(lens, lead, bands.on);
    switch (mode) {
        case DispersionMode::Tolerance:
            return share_within_tolerance(lens, lead, bands.on);
        case DispersionMode::Single:
            return single_ray(lens, lead);
        case DispersionMode::Hero:
            if (pixel.filter) return hero_ray(lens, lead, bands.on, pixel);
            break;
        case DispersionMode::Shared:
        case DispersionMode::Split:
            break;
    }
    return split_rays(lens, lead, bands.on);
}

}  // namespace petzval
