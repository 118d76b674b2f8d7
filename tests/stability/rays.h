// SPDX-License-Identifier: Apache-2.0
// One ray through a few surfaces, in floats and in doubles, for the sweeps.
#pragma once

#include <utility>
#include <vector>

#include "camera/lens/trace.h"
#include "core/math/math.h"

namespace petzval::stability {

inline constexpr double kGlassIndex = 1.5;
inline constexpr double kBehind_mm = 50;  ///< of the plane on which rays are compared

/// Of no conic, and glass of kGlassIndex behind it where there is some.
[[nodiscard]] inline camera::LensSurface surface(double curvature_1_mm, double semi_mm,
                                                 double thickness_mm, bool glass) {
    camera::LensSurface s;
    s.curvature_1_mm = curvature_1_mm;
    s.semi_diameter_mm = semi_mm;
    s.thickness_mm = thickness_mm;
    if (glass) s.glass = Glass{"n", IndexSeries{{{kGlassIndex, 0}}}};
    return s;
}

/// With a stop behind all of it, through which everything passes.
[[nodiscard]] inline camera::Lens lens_of(std::vector<camera::LensSurface> surfaces) {
    surfaces.push_back(surface(0, 1e6, kBehind_mm, surfaces.back().glass.has_value()));
    surfaces.back().stop = true;
    camera::Prescription p;
    p.surfaces = std::move(surfaces);
    return camera::Lens(std::move(p));
}

/// One ray in four equal lanes.
template <class V>
[[nodiscard]] camera::LensRay<V> ray_from(const V3d& origin_mm, const V3d& direction) {
    using S = camera::ScalarOf<V>;
    const auto all = [](double a) { return camera::broadcast<V>(static_cast<S>(a)); };
    const V3d d = direction / direction.length();
    camera::LensRay<V> ray;
    ray.origin = {all(origin_mm.x), all(origin_mm.y), all(origin_mm.z)};
    ray.direction = {all(d.x), all(d.y), all(d.z)};
    return ray;
}

/// A ray traced in floats and in doubles.
struct Pair {
    camera::LensRay<f4> in_floats;
    camera::LensRay<d4> in_doubles;

    [[nodiscard]] bool statuses_differ() const {
        return in_floats.status(0) != in_doubles.status(0);
    }
    [[nodiscard]] bool passed() const {
        return in_floats.status(0) == camera::RayStatus::Passed &&
               in_doubles.status(0) == camera::RayStatus::Passed;
    }
    /// Of the crossing with a plane so far behind the vertex of the last surface that was met.
    [[nodiscard]] double apart_mm(double behind_mm) const {
        const auto at = [behind_mm](const auto& ray) {
            const double t = (behind_mm - double(ray.origin.z[0])) / double(ray.direction.z[0]);
            return V3d(double(ray.origin.x[0]) + t * double(ray.direction.x[0]),
                       double(ray.origin.y[0]) + t * double(ray.direction.y[0]), 0);
        };
        return (at(in_floats) - at(in_doubles)).length();
    }
};

/// Both from the same origin and direction, as floats have them.
[[nodiscard]] inline Pair trace_both(const camera::Lens& lens, camera::SurfaceRange range,
                                     const V3d& origin_mm, const V3d& direction) {
    const camera::LensRay<f4> start = ray_from<f4>(origin_mm, direction);
    const auto lane_0 = [](const camera::Vec3<f4>& a) {
        return V3d(double(a.x[0]), double(a.y[0]), double(a.z[0]));
    };
    Pair out{start, ray_from<d4>(lane_0(start.origin), lane_0(start.direction))};
    const float nm = static_cast<float>(kLineD_nm);
    static_cast<void>(camera::trace_lens<f4>({lens, camera::Towards::Film, range, camera::Clip::No},
                                             lens.exact_indices(splat(nm)), out.in_floats));
    static_cast<void>(camera::trace_lens<d4>({lens, camera::Towards::Film, range, camera::Clip::No},
                                             lens.exact_indices(camera::broadcast<d4>(kLineD_nm)),
                                             out.in_doubles));
    return out;
}

}  // namespace petzval::stability
