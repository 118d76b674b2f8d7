// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/targeted_stop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/sampling/warp.h"

namespace petzval {
namespace {

/// Points of the stop this far apart, in units of its radius, are the same.
constexpr double kSame = 1e-5;
constexpr int kMostSteps = 60;

/// Where a ray is asked for: it crosses the plane where a + b v(h), times s, is what is left of the
/// point once the ray through the middle is taken off. At a depth z: 1 and -z; at infinity slopes
/// themselves: 0 and -1.
struct Depth {
    double a, b;
};

/// Stop heights along one line through its middle, negative beyond it.
struct Heights {
    std::array<double, 3> h{};
    size_t count = 0;
};

/// Heights h of the stop with h (a + b v(h)) = y. Multiplied by focal - half_k h^2 that is a cubic,
/// which is monotone between the zeros of its derivative.
Heights heights(const StopPencil& pencil, const Depth& depth, double y) {
    const double k = pencil.half_k_per_m, a = depth.a - depth.b * pencil.film_vergence_per_m;
    const double c3 = -a * k, c2 = y * k, c1 = a * pencil.focal_m + depth.b,
                 c0 = -y * pencil.focal_m;
    const auto cubic = [&](double h) { return ((c3 * h + c2) * h + c1) * h + c0; };
    const auto slope = [&](double h) { return (3 * c3 * h + 2 * c2) * h + c1; };
    if (k == 0) {
        const double h = -c0 / c1;
        return std::fabs(h) <= pencil.reach_m ? Heights{{h}, 1} : Heights();
    }
    std::array<double, 4> ends{-pencil.reach_m, pencil.reach_m, pencil.reach_m, pencil.reach_m};
    size_t parts = 1;
    const double discriminant = c2 * c2 - 3 * c3 * c1;
    if (discriminant > 0) {
        const double root = std::sqrt(discriminant);
        // The stable form of both zeros: no difference of nearly equal numbers.
        const double q = -(c2 + std::copysign(root, c2));
        for (const double zero : {c3 != 0 ? q / (3 * c3) : INFINITY, q != 0 ? c1 / q : INFINITY})
            if (std::fabs(zero) < pencil.reach_m) ends[parts++] = zero;
        ends[parts] = pencil.reach_m;
        std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(parts) + 1);
    }
    Heights out;
    for (size_t i = 0; i < parts; ++i) {
        double low = ends[i], high = ends[i + 1];
        const double at_low = cubic(low), at_high = cubic(high);
        if (!(low < high) || at_low * at_high > 0 || (at_low == 0 && i > 0)) continue;
        const double sign = at_high > at_low ? 1 : -1;
        double h = (low + high) / 2;
        for (int step = 0; step < kMostSteps; ++step) {
            const double value = sign * cubic(h);
            (value > 0 ? high : low) = h;
            const double next = h - value / (sign * slope(h));
            const double better = next >= low && next <= high ? next : (low + high) / 2;
            if (std::fabs(better - h) <= 1e-14 * pencil.reach_m) break;
            h = better;
        }
        out.h[out.count++] = h;
    }
    return out;
}

/// Points of the stop whose rays pass a point of a target.
struct StopPoints {
    std::array<V2d, 3> s{};
    size_t count = 0;
};

Depth depth_of(const LocalTarget& target, const V3d& point) {
    return target.at_infinity ? Depth{0, -1} : Depth{1, point.z};
}

StopPoints through(const StopPencil& pencil, const LocalTarget& target, const V3d& point) {
    StopPoints out;
    if (!(point.z < 0)) return out;
    const V2d where(point.x, point.y);
    const V2d off =
        target.at_infinity ? where / -point.z - pencil.tangents : where + pencil.tangents * point.z;
    const double y = off.length();
    const V2d along = y > 0 ? off / y : V2d(1, 0);
    const Heights found = heights(pencil, depth_of(target, point), y);
    for (size_t i = 0; i < found.count; ++i) out.s[out.count++] = along * found.h[i];
    return out;
}

double area(const LocalTarget& target) {
    return std::numbers::pi * target.radius_m * target.radius_m;
}

/// Density of a point, 1/m2: of the iris, and of what is aimed.
struct StopDensity {
    double open, aimed;
};
StopDensity density_of(const TargetedStop& stop, V2f stop_mm, TargetList targets) {
    const double per_m2 = 1e6 / stop.iris.area_mm2();
    StopDensity out{double(stop.iris.transmits(stop_mm)) * per_m2, 0};
    const V2d s = V2d(stop_mm) * 1e-3;
    for (const ListedTarget& listed : targets) {
        double sum = 0;
        for (const StopPencil& pencil : stop.pencils)
            sum += aimed_density(pencil, listed.target, s);
        out.aimed += double(listed.chance) * sum / static_cast<double>(stop.pencils.size());
    }
    return out;
}

}  // namespace

double aimed_density(const StopPencil& pencil, const LocalTarget& target, V2d s) {
    const V3d d = pencil.direction(s), o(s.x, s.y, 0);
    const double across = target.normal.dot(d);
    V3d point;
    if (target.at_infinity) {
        if (!(across > 0)) return 0;
        point = d / across;
    } else {
        const double t = target.normal.dot(target.centre - o) / across;
        if (!(t > 0)) return 0;
        point = o + t * d;
    }
    if (!((point - target.centre).length2() <= target.radius_m * target.radius_m)) return 0;
    const StopPoints found = through(pencil, target, point);
    const bool belongs = std::any_of(found.s.begin(), found.s.begin() + found.count, [&](V2d p) {
        return (p - s).length2() <= sqr(kSame * pencil.reach_m);
    });
    if (!belongs) return 0;
    // Stretch of s -> s (a + b v(h)): across and along the radius.
    const double h = s.length(), v = pencil.vergence_per_m(h);
    const double v_slope = 2 * pencil.half_k_per_m * h * sqr(v + pencil.film_vergence_per_m);
    const auto [a, b] = depth_of(target, point);
    const double stretch = std::fabs((a + b * v) * (a + b * (v + h * v_slope)));
    // From the plane across the axis to that of the target: along the ray for a disc, and by the
    // solid angle of a direction at infinity.
    const double tilt = target.at_infinity ? across * across * across : std::fabs(across);
    return stretch / tilt / area(target) / static_cast<double>(found.count);
}

std::optional<V2d> aim(const StopPencil& pencil, const LocalTarget& target, V2f point, float pick) {
    const V2f on = uniform_disk(point);
    const V3d at =
        target.centre + (target.across * double(on.x) + target.up * double(on.y)) * target.radius_m;
    const StopPoints found = through(pencil, target, at);
    if (found.count == 0) return std::nullopt;
    return found
        .s[std::min(static_cast<size_t>(pick * static_cast<float>(found.count)), found.count - 1)];
}

float TargetedStop::mis_weight(V2f stop_mm, TargetList targets) const {
    const auto [open, aimed] = density_of(*this, stop_mm, targets);
    // A point of the very edge may be rounded to where the iris is closed: no ray is aimed there.
    return open > 0 ? static_cast<float>(open / (open + aimed)) : 1;
}

std::optional<TargetedStop::Aimed> TargetedStop::aim_at_one(const FilmPoint& at,
                                                            TargetList targets) const {
    const V2f pick = at.sampler.get2(Dim::TargetPick);
    const size_t i = picked(targets, pick.x);
    const LocalTarget& target = targets[i].target;
    const float lane = pick.y * static_cast<float>(pencils.size());
    const size_t chosen = std::min(static_cast<size_t>(lane), pencils.size() - 1);
    const auto s = aim(pencils[chosen], target, at.sampler.get2(Dim::TargetPoint),
                       lane - static_cast<float>(chosen));
    if (!s) return std::nullopt;
    const V2f stop_mm(*s * 1e3);
    // Rounding may carry it off the target's rim, where its density would be too low.
    if (!(aimed_density(pencils[chosen], target, V2d(stop_mm) * 1e-3) > 0)) return std::nullopt;
    const auto [open, aimed] = density_of(*this, stop_mm, targets);
    if (!(open > 0)) return std::nullopt;
    return Aimed{stop_mm, static_cast<float>(open / (open + aimed))};
}

std::optional<ListedTarget> TargetedStop::listed(const LocalTarget& target, V2f place) const {
    // A target's rim is met from a little farther away than its middle.
    constexpr double kReach = 1.25;
    StopPencil wide = pencils[0];
    wide.reach_m *= kReach;
    const StopPoints found = through(wide, target, target.centre);
    double met = 0;
    for (size_t i = 0; i < found.count; ++i)
        met += 1e6 / iris.area_mm2() / aimed_density(wide, target, found.s[i]) /
               static_cast<double>(found.count);
    if (!(met > 0 && std::isfinite(met))) return std::nullopt;
    return ListedTarget{target, 1, static_cast<float>(met), place};
}

}  // namespace petzval
