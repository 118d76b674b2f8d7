// SPDX-License-Identifier: Apache-2.0
// Planes of targets, and where rays of a traced lens meet them: what the search for rays and the
// choice of its starts share.
#pragma once

#include <algorithm>

#include "camera/targets/lens_targets.h"

namespace petzval {

[[nodiscard]] inline f8 select8(m8 on, f8 a, f8 b) {
    return on ? a : b;
}
[[nodiscard]] inline Vec3<f8> negated(const Vec3<f8>& a) {
    return a * -1.f;
}

/// Guesses for eight film points and points of their targets, from a start of each.
struct LensTargets::Guess {
    f8 l{}, m{};
    void put(int i, const TargetStart& start, V2f film_mm, V2f on) {
        const V2f off = film_mm - start.film_mm;
        const V2f lm = start.cosines + start.by_film_x * off.x + start.by_film_y * off.y +
                       start.by_across * on.x + start.by_up * on.y;
        l[i] = lm.x, m[i] = lm.y;
    }
};

/// Targets of eight lanes, in the space of the lens.
struct LensTargets::Goals {
    Vec3<f8> normal{}, centre{}, across{}, up{};  ///< centre: at infinity the direction
    f8 per_radius{}, chance{};
    m8 at_infinity{}, on{};
    std::array<const ListedTarget*, 8> listed{};

    [[nodiscard]] int most_starts(m8 wanted) const {
        int most = 0;
        for (size_t i = 0; i < 8; ++i)
            if (wanted[static_cast<int>(i)]) most = std::max<int>(most, listed[i]->start_count);
        return most;
    }
};

/// Where rays meet the planes of targets, in radii from their middles, and the derivatives by the
/// two parameters of the ray.
struct LensTargets::Landing {
    f8 x{}, y{}, x_by_u{}, y_by_u{}, x_by_v{}, y_by_v{};
    f8 radii{};  ///< distance to the plane
    m8 ahead{};  ///< lanes whose ray leads there

    Landing() = default;
    Landing(const LensRay<Dual<f8>>& ray, const Goals& goal) {
        const auto part = [](const Vec3<Dual<f8>>& a, auto which) {
            return Vec3<f8>{a.x.*which, a.y.*which, a.z.*which};
        };
        constexpr auto value = &Dual<f8>::value;
        const Vec3<f8> origin = part(ray.origin, value), d = part(ray.direction, value);
        const Vec3<f8> away = select(goal.at_infinity, goal.centre, goal.centre + negated(origin));
        const f8 across = dot(goal.normal, d), t = dot(goal.normal, away) / across;
        const Vec3<f8> from_centre = d * t + negated(away);
        x = dot(goal.across, from_centre) * goal.per_radius;
        y = dot(goal.up, from_centre) * goal.per_radius;
        const auto change = [&](auto which, f8& x_by, f8& y_by) {
            const Vec3<f8> moved = select(goal.at_infinity, Vec3<f8>{}, part(ray.origin, which)) +
                                   part(ray.direction, which) * t;
            const Vec3<f8> in_plane = moved + d * (-dot(goal.normal, moved) / across);
            x_by = dot(goal.across, in_plane) * goal.per_radius;
            y_by = dot(goal.up, in_plane) * goal.per_radius;
        };
        change(&Dual<f8>::du, x_by_u, y_by_u);
        change(&Dual<f8>::dv, x_by_v, y_by_v);
        radii = t * goal.per_radius;
        ahead = goal.on & ray.alive() & (t > 0.f);
    }
    [[nodiscard]] f8 determinant() const { return x_by_u * y_by_v - x_by_v * y_by_u; }
    /// Area on the target for a unit of the parameters, in squared radii.
    [[nodiscard]] f8 size() const {
        const f8 d = determinant();
        return d < 0.f ? -d : d;
    }
    /// Change of the parameters that changes x and y by so much.
    [[nodiscard]] PlanePoint<f8> parameters(f8 by_x, f8 by_y) const {
        const f8 per = 1 / determinant();
        return {(y_by_v * by_x - x_by_v * by_y) * per, (x_by_u * by_y - y_by_u * by_x) * per};
    }
};

}  // namespace petzval
