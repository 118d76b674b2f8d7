// SPDX-License-Identifier: Apache-2.0
#include "camera/iris/iris_polygon.h"

#include <algorithm>

namespace petzval::camera {
namespace {

V2f rounded(const V2d& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
}

double mix(const double ends[2], double t) {
    return ends[0] + (ends[1] - ends[0]) * t;
}

}  // namespace

PolygonRaster::PolygonRaster(const Polygon& polygon, std::span<const Trapezoid> trapezoids) {
    V2d low(HUGE_VAL), high(-HUGE_VAL);
    for (const auto& contour : polygon.contours)
        for (const V2d& p : contour) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    lower_ = rounded(low), size_ = rounded(high - low);
    const V2d scale = V2d(kCells) / (high - low);
    cells_per_mm_ = rounded(scale);

    // Slack of cells, for the rounding of points to floats.
    constexpr double slack = 1e-3;
    const auto cell_of = [](double position) {
        return static_cast<int>(std::clamp(std::floor(position), 0.0, kCells - 1.0));
    };
    // Calls f(row, t0, t1) for each row that a span of y touches; t0 to t1 is the part of the span
    // in it.
    const auto for_rows = [&](double y0, double y1, auto f) {
        const double a = (y0 - low.y) * scale.y, b = (y1 - low.y) * scale.y;
        for (int row = cell_of(a - slack); row <= cell_of(b + slack); ++row)
            f(row, b > a ? std::clamp((row - slack - a) / (b - a), 0.0, 1.0) : 0,
              b > a ? std::clamp((row + 1 + slack - a) / (b - a), 0.0, 1.0) : 1);
    };
    const auto column_of = [&](double x, double by) { return cell_of((x - low.x) * scale.x + by); };
    cells_.assign(kCells * kCells, kOutside);
    std::vector<std::vector<uint32_t>> lists(cells_.size());
    constexpr uint32_t cut = kFirstList;
    for (const auto& contour : polygon.contours)
        for (size_t i = 0; i < contour.size(); ++i) {
            V2d a = contour[i], b = contour[(i + 1) % contour.size()];
            if (a.y > b.y) std::swap(a, b);
            for_rows(a.y, b.y, [&](int row, double t0, double t1) {
                const double x0 = a.x + (b.x - a.x) * t0, x1 = a.x + (b.x - a.x) * t1;
                for (int column = column_of(std::min(x0, x1), -slack);
                     column <= column_of(std::max(x0, x1), slack); ++column)
                    cells_[row * kCells + column] = cut;
            });
        }
    for (const Trapezoid& t : trapezoids) {
        const auto index = static_cast<uint32_t>(pieces_.size());
        const V2f corner[4] = {rounded(t.corner(0)), rounded(t.corner(1)), rounded(t.corner(2)),
                               rounded(t.corner(3))};
        pieces_.push_back({corner[0].y, corner[2].y, 1.f / (corner[2].y - corner[0].y), corner[0].x,
                           corner[3].x - corner[0].x, corner[1].x, corner[2].x - corner[1].x});
        for_rows(t.bottom, t.top, [&](int row, double t0, double t1) {
            const double left = std::min(mix(t.left, t0), mix(t.left, t1));
            const double right = std::max(mix(t.right, t0), mix(t.right, t1));
            const double middle = low.y + (row + 0.5) / scale.y;
            for (int column = column_of(left, -slack); column <= column_of(right, slack);
                 ++column) {
                uint32_t& cell = cells_[row * kCells + column];
                if (cell == cut)
                    lists[row * kCells + column].push_back(index);
                else if (middle >= t.bottom && middle < t.top)
                    cell = kInside;
            }
        });
    }
    list_ends_ = {0};
    for (size_t i = 0; i < cells_.size(); ++i)
        if (cells_[i] == cut) {
            cells_[i] = kFirstList + static_cast<uint32_t>(list_ends_.size()) - 1;
            lists_.insert(lists_.end(), lists[i].begin(), lists[i].end());
            list_ends_.push_back(static_cast<uint32_t>(lists_.size()));
        }
}

PolygonIris::PolygonIris(const Polygon& polygon, PolygonDraw how)
    : how_(how),
      contours_mm_(polygon.contours),
      trapezoids_(trapezoids(polygon)),
      raster_(polygon, trapezoids_) {
    for (const Trapezoid& t : trapezoids_) area_ += t.area();
    if (how == PolygonDraw::Formula) {
        const auto& p = polygon.contours[0];
        parallelogram_ = p.size() == 4;
        corner_ = rounded(p[0]);
        sides_[0] = rounded(p[1] - p[0]);
        sides_[1] = rounded(p.back() - p[0]);
        return;
    }
    std::vector<float> areas;
    // The apex lies across the trapezoid from a leg, so that u.y runs from leg to leg in both.
    const auto add = [&](const V2d& apex, const V2d& first, const V2d& second) {
        const double area = (first - apex).cross(second - apex) / 2;
        if (!(area > 0)) return;
        triangles_.push_back({rounded(apex), rounded(first - apex), rounded(second - first)});
        areas.push_back(static_cast<float>(area / area_));
    };
    // All lower halves before all upper ones: each half of u.x then runs up the shape once, where
    // turns of one and the other would leave the half to the last bits of u.x.
    for (const Trapezoid& t : trapezoids_) add(t.corner(0), t.corner(1), t.corner(2));
    for (const Trapezoid& t : trapezoids_) add(t.corner(2), t.corner(3), t.corner(0));
    if (how == PolygonDraw::Alias)
        aliases_ = AliasTable(areas);
    else
        choice_ = Piecewise1D(areas);
}

bool PolygonIris::has_formula(const Polygon& polygon) {
    if (polygon.contours.size() != 1) return false;
    const auto& p = polygon.contours[0];
    if (p.size() == 3) return true;
    if (p.size() != 4) return false;
    const V2d gap = p[0] + p[2] - p[1] - p[3];
    return gap.length() <= 1e-9 * (p[2] - p[0]).length();
}

double PolygonIris::area_within_mm2(double radius_mm) const {
    double area = 0;
    for (const Trapezoid& t : trapezoids_) area += area_in_circle(t, radius_mm);
    return area;
}

}  // namespace petzval::camera
