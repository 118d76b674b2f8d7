// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/trapezoids.h"

#include <algorithm>
#include <map>
#include <utility>

namespace petzval::camera {
namespace {

struct Side {
    V2d low, high;
    int winding;  ///< 1 upwards, -1 downwards
    [[nodiscard]] double x(double y) const {
        const double t = (y - low.y) / (high.y - low.y);
        return t < 0.5 ? low.x + t * (high.x - low.x) : high.x - (1 - t) * (high.x - low.x);
    }
};

std::vector<Side> sides_of(const Polygon& polygon) {
    std::vector<Side> sides;
    for (const auto& contour : polygon.contours)
        for (size_t i = 0; i < contour.size(); ++i) {
            const V2d &a = contour[i], &b = contour[(i + 1) % contour.size()];
            if (a.y < b.y) sides.push_back({a, b, 1});
            if (a.y > b.y) sides.push_back({b, a, -1});
        }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return a.low.y < b.low.y; });
    return sides;
}

std::vector<double> levels_of(const std::vector<Side>& sides) {
    std::vector<double> levels;
    for (const Side& s : sides) levels.insert(levels.end(), {s.low.y, s.high.y});
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

// Signed area of a sector: half of the square of the radius, times the angle from a to b about the
// origin.
double sector(const V2d& a, const V2d& b, double radius) {
    return radius * radius / 2 * std::atan2(a.cross(b), a.dot(b));
}

// Signed area that the triangle (origin, a, b) shares with the circle: sectors where the edge runs
// outside, the triangle between.
double edge_in_circle(const V2d& a, const V2d& b, double radius) {
    const V2d d = b - a;
    const double dd = d.dot(d), ad = a.dot(d);
    if (!(dd > 0)) return 0;
    const double discriminant = ad * ad - dd * (a.dot(a) - radius * radius);
    const double root = std::sqrt(std::max(discriminant, 0.0));
    const double enter = (-ad - root) / dd, leave = (-ad + root) / dd;
    if (discriminant <= 0 || enter >= 1 || leave <= 0) return sector(a, b, radius);
    const V2d p = a + d * std::max(enter, 0.0), q = a + d * std::min(leave, 1.0);
    return (enter > 0 ? sector(a, p, radius) : 0) + p.cross(q) / 2 +
           (leave < 1 ? sector(q, b, radius) : 0);
}

}  // namespace

std::vector<Trapezoid> trapezoids(const Polygon& polygon) {
    const std::vector<Side> sides = sides_of(polygon);
    const std::vector<double> levels = levels_of(sides);
    std::vector<Trapezoid> out;
    using Pair = std::pair<const Side*, const Side*>;
    std::map<Pair, double> open;  // neighbours and where they became so
    std::vector<const Side*> active;
    auto next = sides.begin();
    for (size_t k = 0; k < levels.size(); ++k) {
        const double y = levels[k];
        std::erase_if(active, [y](const Side* s) { return s->high.y <= y; });
        for (; next != sides.end() && next->low.y <= y; ++next) active.push_back(&*next);
        // No two sides meet between two levels, so their order half way is that of all the way.
        const double half = k + 1 < levels.size() ? (y + levels[k + 1]) / 2 : y;
        std::sort(active.begin(), active.end(),
                  [half](const Side* a, const Side* b) { return a->x(half) < b->x(half); });
        std::map<Pair, double> now;
        int winding = 0;
        const Side* left = nullptr;
        for (const Side* side : active) {
            const int before = std::exchange(winding, winding + side->winding);
            const auto inside = [&](int w) { return polygon.even_odd ? w % 2 != 0 : w != 0; };
            if (!inside(before) && inside(winding)) left = side;
            if (!inside(before) || inside(winding)) continue;
            const auto was = open.find({left, side});
            now[{left, side}] = was != open.end() ? was->second : y;
            if (was != open.end()) open.erase(was);
        }
        for (const auto& [pair, bottom] : open) {
            const auto [l, r] = pair;
            const Trapezoid piece{bottom, y, {l->x(bottom), l->x(y)}, {r->x(bottom), r->x(y)}};
            if (piece.area() > 0) out.push_back(piece);
        }
        open = std::move(now);
    }
    std::sort(out.begin(), out.end(), [](const Trapezoid& a, const Trapezoid& b) {
        return std::pair(a.bottom, a.left[0]) < std::pair(b.bottom, b.left[0]);
    });
    return out;
}

double area_in_circle(const Trapezoid& t, double radius) {
    double area = 0;
    for (int i = 0; i < 4; ++i) area += edge_in_circle(t.corner(i), t.corner((i + 1) % 4), radius);
    return area;
}

}  // namespace petzval::camera
