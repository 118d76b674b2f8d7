// SPDX-License-Identifier: Apache-2.0
#include "camera/lens_focus.h"

#include <cmath>
#include <limits>

#include "camera/paraxial.h"
#include "camera/traced_ray.h"

namespace petzval {
namespace {

constexpr double kInfinity_mm = 1e15;

// From the last vertex; nothing where the image is not real and behind the lens.
std::optional<double> image_distance_mm(const Lens& lens, double object_mm) {
    const double mm = std::isfinite(object_mm)
                          ? image_of(lens, object_mm, kLineD_nm).from_last_vertex_mm
                          : first_order(lens, kLineD_nm).back_focus_mm;
    if (!(mm > 0 && mm < kInfinity_mm)) return std::nullopt;
    return mm;
}

// The group moves towards the film by `by`.
Prescription moved(Prescription p, const std::array<int, 2>& group, double by_mm) {
    if (group[0] > 0) p.surfaces[size_t(group[0] - 1)].thickness_mm += by_mm;
    p.surfaces[size_t(group[1])].thickness_mm -= by_mm;
    return p;
}

}  // namespace

std::optional<Prescription> focused(const Lens& lens, double object_mm) {
    const Prescription& filed = lens.prescription();
    if (!filed.focus_group) {
        const auto mm = image_distance_mm(lens, object_mm);
        if (!mm) return std::nullopt;
        Prescription p = filed;
        p.surfaces.back().thickness_mm = *mm;
        return p;
    }
    // The film stays where a distant point is sharp with the group as it is filed.
    const auto rest = image_distance_mm(lens, -std::numeric_limits<double>::infinity());
    if (!rest) return std::nullopt;
    Prescription base = filed;
    base.surfaces.back().thickness_mm = *rest;
    const auto miss = [&](double by_mm) -> std::optional<double> {
        const Prescription p = moved(base, *filed.focus_group, by_mm);
        const auto mm = image_distance_mm(Lens(p), object_mm);
        if (!mm) return std::nullopt;
        return *mm - p.surfaces.back().thickness_mm;
    };
    const auto& group = *filed.focus_group;
    const double room_front =
        group[0] > 0 ? base.surfaces[size_t(group[0] - 1)].thickness_mm : *rest;
    const double room_back = base.surfaces[size_t(group[1])].thickness_mm;
    double a = 0, b = 0;
    const auto at_rest = miss(0);
    if (!at_rest) return std::nullopt;
    if (std::fabs(*at_rest) < 1e-9) return base;
    // A root on either side, as groups of both signs are used.
    for (int side = 0; side < 2 && b == 0; ++side) {
        const double reach = side == 0 ? room_back : -room_front;
        for (int i = 1; i <= 64; ++i) {
            const double by = reach * i / 64;
            const auto there = miss(by);
            if (!there) break;
            if (*there * *at_rest <= 0) {
                b = by;
                a = reach * (i - 1) / 64;
                break;
            }
        }
    }
    if (b == 0) return std::nullopt;
    for (int i = 0; i < 100; ++i) {
        const double middle = (a + b) / 2;
        const auto there = miss(middle);
        if (!there) return std::nullopt;
        (*there * *at_rest > 0 ? a : b) = middle;
    }
    return moved(base, group, (a + b) / 2);
}

std::optional<AxialRay> axial_ray(const Lens& lens, double height_mm) {
    const TracedRay ray =
        trace_ray(lens, {0, height_mm, -1}, {0, 0, 1}, kLineD_nm, Towards::Film, Clip::No);
    if (ray.fate != Fate::Passed) return std::nullopt;
    const auto& surfaces = lens.prescription().surfaces;
    AxialRay out{0, std::hypot(ray.direction.x, ray.direction.y)};
    for (int i = 0; i < lens.size(); ++i) {
        const V3d& point = ray.points[static_cast<size_t>(i)];
        const double r = std::hypot(point.x, point.y);
        if (i == lens.stop())
            out.stop_height_mm = r;
        else if (r > surfaces[static_cast<size_t>(i)].semi_diameter_mm)
            return std::nullopt;
    }
    return out;
}

// Rays farther from the axis come in at a steeper angle, as far as the glass lets them through.
std::optional<double> stop_radius_for(const Lens& lens, double fnumber) {
    const double wanted = 1 / (2 * fnumber);
    double low = 0, high = lens.prescription().surfaces.front().semi_diameter_mm;
    const auto reaches = [&](double height) {
        const auto ray = axial_ray(lens, height);
        return !ray || ray->sine >= wanted;
    };
    if (!reaches(high)) return std::nullopt;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (reaches(middle) ? high : low) = middle;
    }
    const auto ray = axial_ray(lens, low);
    if (!ray || std::fabs(ray->sine - wanted) > 1e-9) return std::nullopt;
    return ray->stop_height_mm;
}

double fnumber_of(const Lens& lens, double stop_radius_mm) {
    double low = 0, high = lens.prescription().surfaces.front().semi_diameter_mm;
    const auto beyond = [&](double height) {
        const auto ray = axial_ray(lens, height);
        return !ray || ray->stop_height_mm >= stop_radius_mm;
    };
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (beyond(middle) ? high : low) = middle;
    }
    const auto ray = axial_ray(lens, low);
    return ray && ray->sine > 0 ? 1 / (2 * ray->sine) : std::numeric_limits<double>::infinity();
}

}  // namespace petzval
