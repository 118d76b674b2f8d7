// SPDX-License-Identifier: Apache-2.0
// Light walk: all ways that the light of one ray takes through a lens whose surfaces reflect.
#pragma once

#include <array>
#include <functional>
#include <random>
#include <vector>

#include "camera/lens/lens_coats.h"
#include "camera/lens/lens_ray.h"
#include "core/math/math.h"

namespace petzval::camera {

enum class LightFate : uint8_t {
    BehindLens,  ///< leaves the last surface for the film
    BeforeLens,  ///< leaves the first surface
    Stopped,     ///< meets a rim, the iris or the barrel, all of which are black
    Absorbed     ///< in glass or coats
};

/// A ray inside a lens, with its share of the light.
struct LightRay {
    V3d origin_mm, direction;  ///< z from the first vertex; unit
    Towards towards = Towards::Film;
    int next = 0;  ///< surface that it comes to
    double share = 1;
    int reflections = 0;
    std::array<int, 2> mirrors{-1, -1};  ///< surfaces of its first two reflections
};

/// End of some of the light. ray: where it leaves the lens, or was last. mm of the way count as
/// glass's where it is in glass.
struct LightEnd {
    LightFate fate;
    LightRay ray;
};

/// What a ray meets at its next surface. Where the ray is stopped before, nothing of it goes on.
struct LightMeeting {
    V3d point_mm;  ///< on the surface, z from the first vertex; that of the ray where it meets none
    double absorbed = 0, stopped = 0;  ///< shares of all light, as LightRay::share
    LightRay passed, reflected;        ///< share 0: no such ray
};

class LightWalk {
  public:
    /// Both must outlive it. nm: 360 to 830.
    LightWalk(const Lens&, const LensCoats&, double nm);

    /// One surface: bulk absorption on the way there, then what its coat does. Rays that do not
    /// head for the surface, or miss it, are stopped.
    [[nodiscard]] LightMeeting meet(const LightRay&) const;

    /// Follows a ray and all that comes of it, and tells every end. The shares of the ends add up
    /// to that of the ray, but for kShareAtOnce. Ways of up to two reflections are followed each;
    /// of the further ones some that stand for all, drawn with a fixed seed, unless they are not
    /// wanted: then their light ends nowhere.
    void follow(const LightRay&, const std::function<void(const LightEnd&)>&,
                bool beyond_two = true);

    /// Share of light beyond two reflections that is followed as one ray.
    static constexpr double kShareAtOnce = 1e-6;

  private:
    void follow_one(LightRay, const std::function<void(const LightEnd&)>&, bool beyond_two);

    const Lens& lens_;
    const LensCoats& coats_;
    double nm_;
    LensIndices<d4> indices_;
    std::vector<double> absorption_per_mm_;  ///< of each medium
    std::vector<LightRay> open_;
    double waiting_ = 0;
    std::mt19937 random_{1};
};

}  // namespace petzval::camera
