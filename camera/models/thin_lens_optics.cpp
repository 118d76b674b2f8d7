// SPDX-License-Identifier: Apache-2.0
#include "camera/models/thin_lens_optics.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace petzval::camera {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string mm(double a) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g mm", a);
    return text;
}

[[noreturn]] void refuse(const std::string& message) {
    throw std::invalid_argument(message);
}

// Refuses what is not above 0, NaN too.
void require_positive(double a, const char* what) {
    if (!(a > 0)) refuse(std::string(what) + " must be above 0");
}
void require_length(double a, const char* what) {
    require_positive(a, what);
    if (!std::isfinite(a)) refuse(std::string(what) + " must be finite");
}

void require_lens(const SingletOptics& lens) {
    require_length(lens.focal_mm, "focal length");
    if (!(lens.n > 1) || !std::isfinite(lens.n))
        refuse("a lens needs glass whose index is above 1");
    if (!std::isfinite(lens.bending)) refuse("bending of a lens must be finite");
}

// Ray in the plane through the axis; light travels towards +z.
struct MeridionalRay {
    double y, z, dy, dz;
};

// Refracts a ray at a sphere of that curvature with its vertex at the origin; eta: index before /
// behind.
bool refract(MeridionalRay& ray, double curvature, double eta) {
    const double a = ray.dz - curvature * (ray.y * ray.dy + ray.z * ray.dz);
    const double b = curvature * (ray.y * ray.y + ray.z * ray.z) - 2 * ray.z;
    const double within = a * a - curvature * b;
    if (!(within >= 0)) return false;
    const double t = b / (a + std::sqrt(within));
    ray.y += t * ray.dy;
    ray.z += t * ray.dz;
    const double normal_y = curvature * ray.y, normal_z = curvature * ray.z - 1;
    const double cosine = -(ray.dy * normal_y + ray.dz * normal_z);
    const double cosine2_behind = 1 - eta * eta * (1 - cosine * cosine);
    if (!(cosine > 0 && cosine2_behind >= 0)) return false;
    const double along_normal = eta * cosine - std::sqrt(cosine2_behind);
    ray.dy = eta * ray.dy + along_normal * normal_y;
    ray.dz = eta * ray.dz + along_normal * normal_z;
    return true;
}

}  // namespace

double image_distance_mm(double focal_mm, double object_mm) {
    require_length(focal_mm, "focal length");
    require_positive(object_mm, "object distance");
    if (object_mm <= focal_mm)
        refuse("an object at " + mm(object_mm) + " is within the focal length, " + mm(focal_mm) +
               ", and has no image: focus further away or shorten the focal length");
    return focal_mm / (1 - focal_mm / object_mm);
}

double object_distance_mm(double focal_mm, double film_mm) {
    require_length(focal_mm, "focal length");
    require_length(film_mm, "film distance");
    if (film_mm < focal_mm)
        refuse("a film at " + mm(film_mm) + " is within the focal length, " + mm(focal_mm) +
               ", and sees nothing sharp: move it back or shorten the focal length");
    return focal_mm / (1 - focal_mm / film_mm);
}

double focal_length_between_mm(double object_mm, double film_mm) {
    require_positive(object_mm, "object distance");
    require_length(film_mm, "film distance");
    return film_mm / (1 + film_mm / object_mm);
}

Singlet Singlet::bent(Glass glass, double focal_mm, double bending) {
    const double n = glass.index(kLineD_nm);
    require_lens({n, focal_mm, bending});
    const double twice = 2 * focal_mm * (n - 1);
    return {std::move(glass), twice / (bending + 1), twice / (bending - 1)};
}

SingletOptics Singlet::at_index(double n) const {
    const double c1 = 1 / r1_mm, c2 = 1 / r2_mm, power = (n - 1) * (c1 - c2);
    if (!std::isfinite(c1) || !std::isfinite(c2))
        refuse("radii of a lens must not be 0: a flat surface has an infinite radius");
    if (!(power > 0))
        refuse("a lens of radii " + mm(r1_mm) + " and " + mm(r2_mm) + " and index " +
               std::to_string(n) +
               " does not gather light: 1/r1 must be above 1/r2, and the index above 1");
    const SingletOptics lens{n, 1 / power, (c1 + c2) / (c1 - c2)};
    require_lens(lens);
    return lens;
}

SingletOptics Singlet::at(double nm) const {
    return at_index(glass.index(nm));
}

double spherical_coefficient_per_mm(const SingletOptics& lens, double object_mm) {
    require_lens(lens);
    require_positive(object_mm, "object distance");
    const auto [n, f, q] = lens;
    const double p = 2 * f / object_mm - 1;  // (S' - S) / (S' + S) with S' put in
    const double sum = (n + 2) / (n - 1) * q * q + 4 * (n + 1) * q * p +
                       (3 * n + 2) * (n - 1) * p * p + n * n * n / (n - 1);
    return sum / (4 * f * n * (n - 1));
}

double zonal_focal_length_mm(const SingletOptics& lens, double object_mm, double h_mm) {
    return lens.focal_mm - spherical_coefficient_per_mm(lens, object_mm) * h_mm * h_mm / 2;
}

double spherical_aberration_mm(const SingletOptics& lens, double object_mm, double h_mm) {
    const double image_mm = image_distance_mm(lens.focal_mm, object_mm);
    const double zonal_mm = zonal_focal_length_mm(lens, object_mm, h_mm);
    if (!(zonal_mm > 0 && zonal_mm < object_mm))
        refuse("a ray " + mm(h_mm) + " off the axis is too far out for a focal length of " +
               mm(lens.focal_mm) + ": narrow the stop");
    return image_mm - image_distance_mm(zonal_mm, object_mm);
}

std::optional<double> traced_spherical_aberration_mm(const SingletOptics& lens, double object_mm,
                                                     double h_mm) {
    require_lens(lens);
    const double image_mm = image_distance_mm(lens.focal_mm, object_mm);
    if (h_mm == 0) return 0.;
    const double half = 1 / (2 * lens.focal_mm * (lens.n - 1));
    const double slope = h_mm / object_mm, scale = 1 / std::hypot(1, slope);
    MeridionalRay ray{h_mm, 0, slope * scale, scale};
    if (!refract(ray, (lens.bending + 1) * half, 1 / lens.n)) return {};
    if (!refract(ray, (lens.bending - 1) * half, lens.n)) return {};
    return image_mm - (ray.z - ray.y * ray.dz / ray.dy);
}

double spherical_aberration_error(const SingletOptics& lens, double object_mm, double h_mm) {
    const std::optional<double> traced = traced_spherical_aberration_mm(lens, object_mm, h_mm);
    const double zonal_mm = zonal_focal_length_mm(lens, object_mm, h_mm);
    if (!traced || !(zonal_mm > 0 && zonal_mm < object_mm)) return kInfinite;
    const double formula = spherical_aberration_mm(lens, object_mm, h_mm);
    return formula == *traced ? 0 : std::fabs(formula / *traced - 1);
}

double radius_within_error(const SingletOptics& at, double focus_mm, double radius_mm,
                           double most_error) {
    while (radius_mm > 1e-6 * at.focal_mm &&
           !(spherical_aberration_error(at, focus_mm, radius_mm) <= most_error))
        radius_mm *= 0.98;
    return radius_mm;
}

}  // namespace petzval::camera
