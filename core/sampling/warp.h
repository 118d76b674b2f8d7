// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to the shapes that are sampled, each with its density. u is in [0, 1)^2
// throughout; neighbours stay neighbours, so that stratified points stay stratified.
#pragma once

#include <algorithm>

#include "core/math/math.h"
#include "core/math/trig.h"

namespace petzval {

/// Number in [0, 1) that is left of a sampler's number after a choice: `left`, its position within
/// the chosen share. A number has 24 bits, of which the choice took some: an independent number
/// fills in the last ones, or stands for all of them where no more than ten are left. One pair of
/// numbers then chooses and places, and is stratified in both (Shirley 1996, "Monte Carlo
/// Techniques for Direct Lighting Calculations", section 4).
[[nodiscard]] inline float left_of_unit(float left, float share, float independent) {
    const float step = 0x1p-24f / share;
    return step < 0x1p-10f ? std::min(left + independent * step, kOneMinus) : independent;
}

/// Point of the unit disk, uniform by area. Shirley and Chiu 1997, "A Low Distortion Map Between
/// Disk and Square".
[[nodiscard]] inline V2f uniform_disk(V2f u) {
    const float a = 2.f * u.x - 1.f, b = 2.f * u.y - 1.f;
    const bool wide = std::fabs(a) > std::fabs(b);
    const float radius = wide ? a : b, other = wide ? b : a;
    const SinCos angle = sincos_of_eighth(0.5f * other / (radius != 0.f ? radius : 1.f));
    return wide ? V2f(radius * angle.cosine, radius * angle.sine)
                : V2f(radius * angle.sine, radius * angle.cosine);
}
[[nodiscard]] constexpr float uniform_disk_pdf() {
    return kInvPi;
}

/// Direction about +z in proportion to its cosine: the disk raised onto the hemisphere (Malley).
[[nodiscard]] inline V3f cosine_hemisphere(V2f u) {
    const V2f disk = uniform_disk(u);
    return {disk.x, disk.y, safe_sqrt(1.f - disk.dot(disk))};
}
/// Density, 1/sr.
[[nodiscard]] constexpr float cosine_hemisphere_pdf(float cosine) {
    return cosine > 0.f ? cosine * kInvPi : 0.f;
}

/// Direction about +z, uniform over the hemisphere; its cosine is above 0.
[[nodiscard]] inline V3f uniform_hemisphere(V2f u) {
    const float z = 1.f - u.y;
    const float radius = safe_sqrt(u.y * (1.f + z));
    const SinCos azimuth = sincos_turns(u.x);
    return {radius * azimuth.cosine, radius * azimuth.sine, z};
}
/// Density, 1/sr.
[[nodiscard]] constexpr float uniform_hemisphere_pdf() {
    return 0.5f * kInvPi;
}

/// Direction, uniform over the sphere: uniform in height (Archimedes) and in azimuth.
[[nodiscard]] inline V3f uniform_sphere(V2f u) {
    const float z = 1.f - 2.f * u.y;
    const float radius = 2.f * safe_sqrt(u.y * (1.f - u.y));
    const SinCos azimuth = sincos_turns(u.x);
    return {radius * azimuth.cosine, radius * azimuth.sine, z};
}
/// Density, 1/sr.
[[nodiscard]] constexpr float uniform_sphere_pdf() {
    return 0.25f * kInvPi;
}

/// Weights of the second and third corner of a triangle, uniform by area: the square root form,
/// Turk 1990, "Generating Random Points in Triangles". The density is 1 / area, or 2 for the
/// weights.
[[nodiscard]] inline V2f uniform_triangle(V2f u) {
    const float root = std::sqrt(u.x);
    return {root * (1.f - u.y), root * u.y};
}
[[nodiscard]] constexpr float uniform_triangle_pdf() {
    return 2.f;
}

}  // namespace petzval
