// SPDX-License-Identifier: Apache-2.0
// Four rays at once, filled and read lane by lane.
#pragma once

#include <array>
#include <cmath>

#include "camera/lens/paraxial.h"
#include "camera/lens/trace.h"
#include "tests/support/statistics.h"

namespace petzval::test {

using Three = std::array<double, 3>;

/// f(i) in lane i. V: f4 or d4.
template <class V>
[[nodiscard]] V lanes_of(const auto& f) {
    V out{};
    for (int i = 0; i < 4; ++i) out[i] = static_cast<camera::ScalarOf<V>>(f(i));
    return out;
}
/// The three numbers f(i) in lane i.
template <class V>
[[nodiscard]] camera::Vec3<V> vectors_of(const auto& f) {
    return {lanes_of<V>([&](int i) { return f(i)[0]; }),
            lanes_of<V>([&](int i) { return f(i)[1]; }),
            lanes_of<V>([&](int i) { return f(i)[2]; })};
}
[[nodiscard]] inline Three at_lane(const auto& v, int i) {
    return {double(camera::lane(v.x, i)), double(camera::lane(v.y, i)),
            double(camera::lane(v.z, i))};
}

[[nodiscard]] inline Three plus(Three a, Three b, double scale = 1) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}
[[nodiscard]] inline double dot(Three a, Three b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline double length(Three a) {
    return std::hypot(a[0], a[1], a[2]);
}
[[nodiscard]] inline Three unit(Three a) {
    return plus({}, a, 1 / length(a));
}

[[nodiscard]] inline camera::SurfaceRange whole(const camera::Lens& lens) {
    return {0, lens.last()};
}

/// A ray with the same in all lanes; z counts from a surface's vertex.
template <class V>
[[nodiscard]] camera::LensRay<V> ray_of(Three origin, Three direction, int counted_from = 0) {
    camera::LensRay<V> ray;
    ray.origin = vectors_of<V>([&](int) { return origin; });
    ray.direction = vectors_of<V>([&](int) { return unit(direction); });
    ray.counted_from = counted_from;
    return ray;
}

/// One surface, which is the stop, from air into an index, or from it into air.
[[nodiscard]] inline Glass constant_glass(double n) {
    return {"constant", IndexSeries{{{n, 0}}}};
}
[[nodiscard]] inline camera::LensSurface surface_of(double curvature_1_mm, double thickness_mm,
                                                    double n, double semi_diameter_mm = 100) {
    camera::LensSurface out;
    out.curvature_1_mm = curvature_1_mm;
    out.thickness_mm = thickness_mm;
    out.semi_diameter_mm = semi_diameter_mm;
    if (n != 1) out.glass = constant_glass(n);
    return out;
}
/// The first surface becomes the stop where there is none.
[[nodiscard]] inline camera::Lens lens_of(std::vector<camera::LensSurface> surfaces) {
    bool stop = false;
    for (const auto& surface : surfaces) stop = stop || surface.stop;
    if (!stop) surfaces.front().stop = true;
    camera::Prescription out;
    out.surfaces = std::move(surfaces);
    return camera::Lens(std::move(out));
}

/// Through the stop's neighbourhood from a field of some degrees: passes all of kLensKinds.
[[nodiscard]] inline camera::LensRay<d4> usual_ray(const camera::Lens& lens, Random& random) {
    const camera::FirstOrder x = camera::first_order(lens, kLineD_nm, camera::Section::X),
                             y = camera::first_order(lens, kLineD_nm);
    const double radius = 0.2 * std::fabs(x.entrance_pupil_diameter_mm);
    const auto part = [&random] { return 2. * random.next() - 1; };
    const Three at_pupil{part() * radius, part() * radius, y.entrance_pupil_mm};
    const Three direction = unit({0.1 * part(), 0.1 * part(), 1});
    const double to_first = -10 - at_pupil[2];
    return ray_of<d4>(plus(at_pupil, direction, to_first / direction[2]), direction);
}

}  // namespace petzval::test
