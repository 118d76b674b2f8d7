// SPDX-License-Identifier: Apache-2.0
#include "camera/lens_focus.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/axial_spot.h"
#include "camera/paraxial.h"
#include "camera/traced_ray.h"

namespace petzval {
namespace {

constexpr double kInfinity_mm = 1e15;

// From the last vertex; nothing where the image is not real and behind the lens.
std::optional<double> image_distance_mm(const Lens& lens, double object_mm) {
    const FirstOrder first = first_order(lens, kLineD_nm);
    if (!(object_mm < std::min(first.front_focus_mm, 0.))) return std::nullopt;
    const double mm = std::isfinite(object_mm)
                          ? image_of(lens, object_mm, kLineD_nm).from_last_vertex_mm
                          : first.back_focus_mm;
    if (!(mm > 0 && mm < kInfinity_mm)) return std::nullopt;
    return mm;
}

using Group = std::array<int, 2>;

// The group moves towards the film by `by`.
Prescription moved(Prescription p, const Group& group, double by_mm) {
    if (group[0] > 0) p.surfaces[size_t(group[0] - 1)].thickness_mm += by_mm;
    p.surfaces[size_t(group[1])].thickness_mm -= by_mm;
    return p;
}

// How far it can move towards the scene and towards the film.
std::array<double, 2> room_mm(const Prescription& p, const Group& group) {
    const double before = group[0] > 0 ? p.surfaces[size_t(group[0] - 1)].thickness_mm
                                       : p.surfaces.back().thickness_mm;
    return {before, p.surfaces[size_t(group[1])].thickness_mm};
}

std::optional<Prescription> film_focused(Prescription p, double object_mm) {
    const auto mm = image_distance_mm(Lens(p), object_mm);
    if (!mm) return std::nullopt;
    p.surfaces.back().thickness_mm = *mm;
    return p;
}

std::optional<Prescription> group_focused(const Prescription& filed, const Group& group,
                                          double object_mm) {
    const auto base = film_focused(filed, -std::numeric_limits<double>::infinity());
    if (!base) return std::nullopt;
    const auto miss = [&](double by_mm) -> std::optional<double> {
        const Prescription p = moved(*base, group, by_mm);
        const auto mm = image_distance_mm(Lens(p), object_mm);
        if (!mm) return std::nullopt;
        return *mm - p.surfaces.back().thickness_mm;
    };
    const auto room = room_mm(*base, group);
    double a = 0, b = 0;
    const auto at_rest = miss(0);
    if (!at_rest) return std::nullopt;
    if (std::fabs(*at_rest) < 1e-9) return base;
    // A root on either side, as groups of both signs are used.
    for (int side = 0; side < 2 && b == 0; ++side) {
        const double reach = side == 0 ? room[1] : -room[0];
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
    return moved(*base, group, (a + b) / 2);
}

// Downhill in growing steps from a minimum's neighbourhood, then the golden section (Kiefer 1953,
// Proc. Amer. Math. Soc. 4, 502), to what the square root of rounding allows.
double least_near(const auto& f, double step) {
    double middle = 0, at_middle = f(0.);
    if (f(step) > at_middle) step = -step;
    double low = -step, high = step;
    for (double at = f(high); at < at_middle; at = f(high)) {
        low = middle;
        middle = high;
        at_middle = at;
        step *= 2;
        high = middle + step;
    }
    constexpr double golden = std::numbers::phi - 1;
    double left = high - golden * (high - low), right = low + golden * (high - low);
    double at_left = f(left), at_right = f(right);
    for (int i = 0; i < 48; ++i) {
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - golden * (high - low);
            at_left = f(left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + golden * (high - low);
            at_right = f(right);
        }
    }
    return (low + high) / 2;
}

// From where it is sharp paraxially.
std::optional<Prescription> group_at_best_spot(const Prescription& sharp, const Group& group,
                                               double object_mm, double stop_radius_mm) {
    const Lens lens(sharp);
    const auto shift = best_film_shift_mm(lens, lens.film_mm(), object_mm, stop_radius_mm);
    if (!shift) return std::nullopt;
    const auto room = room_mm(sharp, group);
    const auto blur = [&](double by_mm) {
        if (by_mm < -room[0] || by_mm > room[1]) return kInfinity_mm;
        const Lens there(moved(sharp, group, by_mm));
        const auto spot = axial_spot(there, object_mm, there.film_mm(), stop_radius_mm);
        return spot ? spot->mean_square_mm2() : kInfinity_mm;
    };
    constexpr double least_step_mm = 1e-6;
    return moved(sharp, group, least_near(blur, std::max(std::fabs(*shift) / 8, least_step_mm)));
}

}  // namespace

std::optional<Prescription> focused(const Lens& lens, double object_mm, FocusBy by,
                                    double stop_radius_mm) {
    const Prescription& filed = lens.prescription();
    const auto& group = filed.focus_group;
    auto sharp = group ? group_focused(filed, *group, object_mm) : film_focused(filed, object_mm);
    if (!sharp || by == FocusBy::Paraxial) return sharp;
    if (group) return group_at_best_spot(*sharp, *group, object_mm, stop_radius_mm);
    const Lens there(*sharp);
    const auto shift = best_film_shift_mm(there, there.film_mm(), object_mm, stop_radius_mm);
    double& to_film_mm = sharp->surfaces.back().thickness_mm;
    if (!shift || !(to_film_mm + *shift > 0)) return std::nullopt;
    to_film_mm += *shift;
    return sharp;
}

std::optional<double> best_film_shift_mm(const Lens& lens, double film_mm, double object_mm,
                                         double stop_radius_mm) {
    const auto spot = axial_spot(lens, object_mm, film_mm, stop_radius_mm);
    return spot ? std::optional(spot->best_shift_mm()) : std::nullopt;
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
