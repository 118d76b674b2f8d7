// SPDX-License-Identifier: Apache-2.0
// Lenses that nobody would build, and rays that no light takes.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/lens_rays.h"
#include "tests/support/statistics.h"

namespace petzval::test {

[[nodiscard]] inline double between(Random& random, double a, double b) {
    return a + (b - a) * random.next();
}

[[nodiscard]] inline camera::LensSurface random_surface(Random& random) {
    camera::LensSurface out;
    if (random.next() < 0.9f) out.curvature_1_mm = 1 / between(random, 3, 100);
    if (random.next() < 0.5f) out.curvature_1_mm *= -1;
    if (random.next() < 0.1f) out.curvature_1_mm *= 1e-6;
    if (random.next() < 0.3f) out.conic = between(random, -6, 6);
    if (random.next() < 0.2f)
        out.profile =
            random.next() < 0.5f ? camera::Profile::CylinderX : camera::Profile::CylinderY;
    if (random.next() < 0.3f) {
        // Each term adds up to 1 mm at 8 mm, or, where r is 30 mm, up to 10^9 mm.
        const int terms = 1 + int(random.next() * 5);
        for (int i = 0; i < terms; ++i) {
            const int power = 2 + int(random.next() * 15);
            out.asphere.push_back({double(power), between(random, -1, 1) * std::pow(8, -power)});
        }
    }
    out.thickness_mm = between(random, -1, 12);
    out.semi_diameter_mm = between(random, 1, 30);
    if (random.next() < 0.6f) out.glass = constant_glass(between(random, 1, 2.2));
    return out;
}

/// The stop is any of its surfaces.
[[nodiscard]] inline camera::Prescription random_prescription(Random& random) {
    camera::Prescription out;
    out.surfaces.resize(1 + size_t(random.next() * 12));
    for (auto& surface : out.surfaces) surface = random_surface(random);
    out.surfaces[size_t(random.next() * float(out.surfaces.size()))].stop = true;
    return out;
}

struct Line {
    Three origin, direction;
};

/// Half of them somewhat along the axis, others from anywhere to anywhere; some of them along an
/// axis of coordinates, where zeros meet.
[[nodiscard]] inline Line random_line(Random& random, bool to_film) {
    const auto place = [&](double size) { return between(random, -size, size); };
    Line out;
    const double size = random.next() < 0.5f ? 4 : 40;
    out.origin = {place(size), place(size), place(50)};
    const V3f anywhere = random.direction();
    out.direction = {anywhere.x, anywhere.y, anywhere.z};
    const float kind = random.next();
    if (kind < 0.6f) {
        out.direction[2] = (to_film ? 1 : -1) * (2 + std::fabs(out.direction[2]));
    } else if (kind < 0.75f) {
        Three axis{};
        axis[size_t(random.next() * 3)] = random.next() < 0.5f ? 1 : -1;
        out.direction = axis;
        for (double& x : out.origin)
            if (random.next() < 0.5f) x = 0;
    }
    out.direction = unit(out.direction);
    return out;
}

template <class V>
[[nodiscard]] camera::LensRay<V> rays_of(const std::array<Line, 4>& lines) {
    camera::LensRay<V> ray;
    ray.origin = vectors_of<V>([&](int i) { return lines[size_t(i)].origin; });
    ray.direction = vectors_of<V>([&](int i) { return lines[size_t(i)].direction; });
    return ray;
}
/// With derivatives by the origin's x and y.
[[nodiscard]] inline camera::LensRay<camera::Dual<f4>> with_derivatives(
    const camera::LensRay<f4>& ray) {
    using D = camera::Dual<f4>;
    const auto& [at, along] = std::pair(ray.origin, ray.direction);
    camera::LensRay<D> out;
    out.origin = {D{at.x, splat(1), {}}, D{at.y, {}, splat(1)}, D{at.z}};
    out.direction = {D{along.x}, D{along.y}, D{along.z}};
    return out;
}

/// What of that which holds for every ray that has been traced does not hold; empty where all
/// does. tolerance: of the direction's length.
template <class N>
[[nodiscard]] std::string fault_of(const camera::LensRay<N>& ray, const camera::Lens& lens,
                                   camera::Towards towards, double tolerance) {
    const auto origin = camera::value_of(ray.origin), direction = camera::value_of(ray.direction);
    for (int i = 0; i < camera::NumberTraits<N>::lanes; ++i) {
        const Three at = at_lane(origin, i), along = at_lane(direction, i);
        if (!std::isfinite(at[0] + at[1] + at[2])) return "a point that is not finite";
        if (!(std::fabs(length(along) - 1) <= tolerance))
            return "a direction of length " + std::to_string(length(along));
        const int status = int(camera::lane(ray.status_code, i)),
                  end = int(camera::lane(ray.end_surface, i));
        if (status < 0 || status > 3) return "no status";
        if (end < 0 || end >= lens.size()) return "an end on no surface";
        if (status == 0) continue;
        if (at != Three{} || along != Three{0, 0, towards == camera::Towards::Film ? 1. : -1.})
            return "a blocked ray off the axis";
    }
    return {};
}

}  // namespace petzval::test
