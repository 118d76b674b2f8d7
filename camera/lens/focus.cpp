// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/focus.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/lens/axial_spot.h"
#include "camera/lens/paraxial.h"
#include "camera/lens/traced_ray.h"

namespace petzval::camera {
namespace {

constexpr double kInfinity_mm = 1e15;
constexpr double kFarthestFilm = 1e6;  // in focal lengths

// Paraxial image distance from the last vertex; nothing where the image is not real and behind the
// lens.
std::optional<double> image_distance_mm(const Lens& lens, double object_mm) {
    const FirstOrder first = first_order(lens, kLineD_nm);
    if (!(object_mm < std::min(first.front_focus_mm, 0.))) return std::nullopt;
    const double mm = std::isfinite(object_mm)
                          ? image_of(lens, object_mm, kLineD_nm).from_last_vertex_mm
                          : first.back_focus_mm;
    // An object at the front focus to the last digits is sharp on no film that anyone could build.
    if (!(mm > 0 && mm < kFarthestFilm * std::fabs(first.focal_length_mm))) return std::nullopt;
    return mm;
}

using Group = std::array<int, 2>;

double thickness_mm(const Lens& lens, int surface) {
    return lens.prescription().surfaces[static_cast<size_t>(surface)].thickness_mm;
}

// Lens whose focusing group is moved.
class GroupMove {
  public:
    GroupMove(const Lens& lens, const Group& group)
        : lens_(lens),
          group_(group),
          before_mm_(thickness_mm(lens, group[0] > 0 ? group[0] - 1 : lens.last())),
          behind_mm_(thickness_mm(lens, group[1])) {}

    /// Moves the group towards the film by that much, from where it was at first.
    const Lens& to(double by_mm) {
        if (group_[0] > 0) lens_.set_thickness(group_[0] - 1, before_mm_ + by_mm);
        lens_.set_thickness(group_[1], behind_mm_ - by_mm);
        return lens_;
    }
    /// Range of the move, towards the scene (below 0) and towards the film.
    [[nodiscard]] double least_mm() const { return -before_mm_; }
    [[nodiscard]] double most_mm() const { return behind_mm_; }

  private:
    Lens lens_;
    Group group_;
    double before_mm_, behind_mm_;
};

std::optional<Lens> film_focused(Lens lens, double object_mm) {
    const auto mm = image_distance_mm(lens, object_mm);
    if (!mm) return std::nullopt;
    lens.set_thickness(lens.last(), *mm);
    return lens;
}

std::optional<Lens> group_focused(const Lens& filed, const Group& group, double object_mm) {
    auto base = film_focused(filed, -std::numeric_limits<double>::infinity());
    if (!base) return std::nullopt;
    GroupMove move(*base, group);
    const auto miss = [&](double by_mm) -> std::optional<double> {
        const Lens& lens = move.to(by_mm);
        const auto mm = image_distance_mm(lens, object_mm);
        if (!mm) return std::nullopt;
        return *mm - thickness_mm(lens, lens.last());
    };
    double a = 0, b = 0;
    const auto at_rest = miss(0);
    if (!at_rest) return std::nullopt;
    if (std::fabs(*at_rest) < 1e-9) return base;
    // Search for a root on either side, as groups of both signs are used.
    for (int side = 0; side < 2 && b == 0; ++side) {
        const double reach = side == 0 ? move.most_mm() : move.least_mm();
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
    return move.to((a + b) / 2);
}

// Minimum of f near 0: downhill in growing steps, then the golden section (Kiefer 1953, Proc. Amer.
// Math. Soc. 4, 502) to a ten-thousandth of the bracket.
double least_near(const auto& f, double step) {
    constexpr int kRounds = 20;
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
    for (int i = 0; i < kRounds; ++i) {
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

// Lens with its group at the least spot, searched from where it is sharp paraxially.
std::optional<Lens> group_at_best_spot(const Lens& sharp, const Group& group, double object_mm,
                                       double stop_radius_mm) {
    const auto shift = best_film_shift_mm(sharp, sharp.film_mm(), object_mm, stop_radius_mm);
    if (!shift) return std::nullopt;
    GroupMove move(sharp, group);
    const auto blur = [&](double by_mm) {
        if (by_mm < move.least_mm() || by_mm > move.most_mm()) return kInfinity_mm;
        const Lens& there = move.to(by_mm);
        const auto spot = axial_spot(there, object_mm, there.film_mm(), stop_radius_mm);
        return spot ? spot->mean_square_mm2() : kInfinity_mm;
    };
    constexpr double least_step_mm = 1e-6;
    return move.to(least_near(blur, std::max(std::fabs(*shift) / 8, least_step_mm)));
}

}  // namespace

std::optional<Lens> focused(const Lens& lens, double object_mm, FocusBy by, double stop_radius_mm) {
    const auto& group = lens.prescription().focus_group;
    auto sharp = group ? group_focused(lens, *group, object_mm) : film_focused(lens, object_mm);
    if (!sharp || by == FocusBy::Paraxial) return sharp;
    if (group) return group_at_best_spot(*sharp, *group, object_mm, stop_radius_mm);
    const auto shift = best_film_shift_mm(*sharp, sharp->film_mm(), object_mm, stop_radius_mm);
    if (!shift) return std::nullopt;
    const double mm = thickness_mm(*sharp, sharp->last()) + *shift;
    if (!(mm > 0)) return std::nullopt;
    sharp->set_thickness(sharp->last(), mm);
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
    if (ray.status != RayStatus::Passed) return std::nullopt;
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

std::optional<Prescription> stopped_down(const Lens& lens, double fnumber) {
    constexpr double same = 1e-6;
    Prescription out = lens.prescription();
    double& radius_mm = out.surfaces[size_t(lens.stop())].semi_diameter_mm;
    const auto wanted_mm = stop_radius_for(lens, fnumber);
    if (!wanted_mm || *wanted_mm > radius_mm * (1 + same)) return std::nullopt;
    radius_mm = std::min(radius_mm, *wanted_mm);
    return out;
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

}  // namespace petzval::camera
