// SPDX-License-Identifier: Apache-2.0
#include "camera/film_projection.h"

#include <cmath>

namespace petzval::camera {

std::optional<Ray> FilmProjection::ray_at(const V2d& px) const {
    FilmPoint point{V2f(px / V2d(size_px_))};  // always the same place of the iris
    const CameraSample seen = finder_.sample(point, Bands::rgb());
    if (seen.empty()) return std::nullopt;
    return seen[0].ray;
}

// Newton's method on the two components across the ray of the way to the point.
std::optional<V2d> FilmProjection::place_of(const V3d& p, const V2d& guess) const {
    constexpr int kRounds = 12;
    constexpr double kStep_px = 0.5, kSettled_px = 1e-3;
    V2d at = guess;
    for (int round = 0; round < kRounds; ++round) {
        const auto ray = ray_at(at), right = ray_at(at + V2d(kStep_px, 0)),
                   down = ray_at(at + V2d(0, kStep_px));
        if (!ray || !right || !down) return std::nullopt;
        const Frame frame = Frame::about(ray->direction);
        const auto across = [&](const Ray& r) {
            const V3d to = p - V3d(r.origin), along(r.direction);
            const double depth = to.dot(along);
            const V3d miss = to - along * depth;  // how far the ray passes the point by
            return V3d(miss.dot(V3d(frame.x)), miss.dot(V3d(frame.y)), depth);
        };
        const V3d here = across(*ray), x = (across(*right) - here) / kStep_px,
                  y = (across(*down) - here) / kStep_px;
        const double determinant = x.x * y.y - x.y * y.x;
        if (!(here.z > 0) || !(std::fabs(determinant) > 0)) return std::nullopt;
        const V2d step((here.y * y.x - here.x * y.y) / determinant,
                       (here.x * x.y - here.y * x.x) / determinant);
        at += step;
        if (!std::isfinite(at.x + at.y)) return std::nullopt;
        if (step.length() < kSettled_px) return at;
    }
    return std::nullopt;
}

}  // namespace petzval::camera
