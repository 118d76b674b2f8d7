// SPDX-License-Identifier: Apache-2.0
// LensPoint: the interface of a camera with a lens to the dispersion strategies.
#pragma once

#include <concepts>

#include "camera/camera.h"

namespace petzval::camera {

/// Request for rays of some lanes.
struct LaneRequest {
    m4 lanes;     ///< lanes whose rays are wanted
    int hero;     ///< lane whose ray meets the drawn point
    bool coated;  ///< weights count what the surfaces reflect
};

/// Landing on the film of one lane's ray of the scene, if it were light of each lane.
struct FilmLanding {
    f4 dx_px, dy_px;  ///< from the film point that the ray was drawn for, y down
    f4 open;          ///< [0, 1]: share that iris and rims let through
    f4 drawn;         ///< density with which the lane draws the ray from there, in any unit
    /// Share that the surfaces do not reflect, and the film's fall-off there over that at the film
    /// point.
    f4 transmitted;
};

/// A film point of a camera and a drawn point of its stop, with the two primitives rays() and
/// landing(). A strategy composes them (strategies.h); a camera that has them has every strategy.
///
/// rays(request): rays with weight_of_lanes() (0: lost; counts for all lanes of the bands, however
/// few were asked for) and `losses`.
/// ray(rays, lane): a lane's ray in the world, unit direction.
/// density(rays): CameraSample::density, where the camera has it.
/// landing(rays, request): landing of the ray of request.hero.
/// exposure(): mean weight of a lane where nothing is lost.
template <class P>
concept LensPoint = requires(const P p, const LaneRequest& request,
                             const decltype(p.rays(request))& rays, int lane) {
    { rays.weight_of_lanes() } -> std::same_as<f4>;
    { rays.losses } -> std::convertible_to<LensLosses<uint32_t>>;
    { p.ray(rays, lane) } -> std::same_as<Ray>;
    { p.landing(rays, request) } -> std::same_as<FilmLanding>;
    { p.exposure() } -> std::same_as<float>;
};

}  // namespace petzval::camera
