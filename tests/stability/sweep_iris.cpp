// SPDX-License-Identifier: Apache-2.0
// Where the ways to draw from an iris end.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "camera/iris/iris.h"
#include "core/sampling/alias_table.h"
#include "core/sampling/distribution.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr double kStop_mm = 10;

camera::Polygon turned(camera::Polygon polygon, double rad) {
    const double c = std::cos(rad), s = std::sin(rad);
    for (auto& contour : polygon.contours)
        for (V2d& p : contour) p = {p.x * c - p.y * s, p.x * s + p.y * c};
    return polygon;
}

// A rectangle 1 long along the diagonal, where its bounding box is emptiest.
camera::Polygon sliver(double ratio) {
    const double x = 0.5, y = 0.5 / ratio;
    return turned({{{{-x, -y}, {x, -y}, {x, y}, {-x, y}}}}, std::numbers::pi / 4);
}

struct Rejection {
    double attempts = 0, gives_up = 0;
};

// As Iris draws: points of the bounding box, 256 of them at most.
Rejection rejection_of(const camera::Iris& iris, double half_mm) {
    constexpr int kPoints = 2000;
    Draws draws(3);
    Rejection out;
    for (int i = 0; i < kPoints; ++i) {
        int tries = 0;
        bool inside = false;
        while (!inside && tries < camera::Iris::kTries) {
            ++tries;
            const V2f u = draws.next2();
            inside = iris.transmits((u * 2.f - V2f(1.f)) * static_cast<float>(half_mm)) > 0;
        }
        out.attempts += double(tries) / kPoints;
        out.gives_up += double(!inside) / kPoints;
    }
    return out;
}

// Share of the points that an iris draws and then calls outside.
double share_refused(const camera::Iris& iris) {
    constexpr uint32_t kPoints = 8192;
    uint32_t refused = 0;
    for (uint32_t i = 0; i < kPoints; ++i)
        refused += !(iris.transmits(iris.sample(
                         Sampler(SamplerKind::Owen, 5, {0, 0, i}).get2(Dim::Lens))) > 0);
    return double(refused) / kPoints;
}

camera::Iris iris_of(const camera::Polygon& polygon,
                     camera::IrisSampling way = camera::IrisSampling::Triangles) {
    return {polygon, kStop_mm, camera::ApertureScale::Inscribed, way};
}

}  // namespace

Finding rejection_of_slivers() {
    Finding f{.method = "Rejection from slivers", .fails = "time, then bias"};
    f.sweep = fmt::format(
        "A rectangle 1:N along the diagonal of its bounding box, {:g} mm to its corners. Points of "
        "the box that are tried for each one inside, of {} that there may be at most; the share of "
        "draws that give up; and, however a point is drawn, the share of drawn points that the "
        "inside test, which rounds to floats, puts outside: a camera with glass loses their light.",
        kStop_mm, camera::Iris::kTries);
    f.table.columns = {"N", "tries per point", "give up", "drawn but called outside"};
    const auto half_mm = [](double ratio) {
        return kStop_mm * (1 + 1 / ratio) / std::sqrt(2 * (1 + 1 / (ratio * ratio)));
    };
    const auto rejected = [&](double ratio) {
        return rejection_of(iris_of(sliver(ratio)), half_mm(ratio));
    };
    const auto lost = [](double ratio) { return share_refused(iris_of(sliver(ratio))); };
    for (const double ratio : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
        const Rejection r = rejected(ratio);
        add_row(f, ratio, r.attempts, percent(r.gives_up), percent(lost(ratio)));
    }
    const auto few = first_failure(10, 1e6, [&](double n) { return rejected(n).gives_up > 0.01; });
    const auto half = first_failure(10, 1e6, [&](double n) { return rejected(n).gives_up > 0.5; });
    const auto dark = first_failure(10, 1e9, [&](double n) { return lost(n) > 0.01; });
    f.where = fmt::format(
        "1 % of the draws give up from 1:{} on, half of them from 1:{}; every way to draw loses "
        "1 % of the light from 1:{} on",
        number(few), number(half), number(dark));
    f.instead =
        "A draw that gives up takes a fresh number and the triangles, so that points stay uniform. "
        "Rejection is never chosen unless it is asked for. Light that rounding loses is lost.";
    return f;
}

namespace {

double cross(const V2d& a, const V2d& b) {
    return a.x * b.y - a.y * b.x;
}

double exact_area(const camera::Polygon& polygon) {
    long double twice = 0;
    for (const auto& c : polygon.contours)
        for (size_t i = 0; i < c.size(); ++i) {
            const V2d &a = c[i], &b = c[(i + 1) % c.size()], &o = c[0];
            twice += (static_cast<long double>(a.x) - o.x) * (static_cast<long double>(b.y) - o.y) -
                     (static_cast<long double>(a.y) - o.y) * (static_cast<long double>(b.x) - o.x);
        }
    return static_cast<double>(twice / 2);
}

// How far a point lies outside a contour: 0 within, by the parity of crossings.
double distance_outside(const std::vector<V2d>& contour, const V2d& p) {
    bool inside = false;
    double least = HUGE_VAL;
    for (size_t i = 0; i < contour.size(); ++i) {
        const V2d &a = contour[i], &b = contour[(i + 1) % contour.size()], along = b - a;
        if ((a.y > p.y) != (b.y > p.y) && (cross(along, p - a) > 0) == (b.y > a.y))
            inside = !inside;
        const double t = std::clamp((p - a).dot(along) / along.dot(along), 0.0, 1.0);
        least = std::fmin(least, (p - (a + along * t)).length());
    }
    return inside ? 0 : least;
}

struct Family {
    const char* name;
    camera::Polygon (*of)(double delta);
};

// A vertex that stands delta off the straight edge of a square.
camera::Polygon nearly_collinear(double delta) {
    return turned({{{{-1, -1}, {0, -1 - delta}, {1, -1}, {1, 1}, {-1, 1}}}}, 0.3);
}
// A square with a slot whose two long edges are delta apart.
camera::Polygon nearly_touching(double delta) {
    return turned({{{{-1, -1},
                     {1, -1},
                     {1, -delta / 2},
                     {-0.5, -delta / 2},
                     {-0.5, delta / 2},
                     {1, delta / 2},
                     {1, 1},
                     {-1, 1}}}},
                  0.3);
}
camera::Polygon needle(double delta) {
    return turned({{{{-1, 0}, {1, 0}, {0.2, delta}}}}, 0.3);
}
// A comb whose teeth end on levels that are delta apart.
camera::Polygon nearly_level(double delta) {
    camera::Polygon comb{{{{1, -1}}}};
    for (int i = 0; i < 16; ++i) {
        const double x = 1 - i / 8.0;
        comb.contours[0].push_back({x, 0.5 + delta * ((i * 7) % 16)});
        comb.contours[0].push_back({x - 1 / 16.0, -0.5 + delta * ((i * 5) % 16)});
    }
    comb.contours[0].push_back({-1, -1});
    return comb;
}

struct Quality {
    bool refused = false;
    double area_error = 0, called_outside = 0, stray = 0;
};

Quality quality_of(const camera::Polygon& polygon) {
    Quality out;
    if (camera::find_fault(polygon)) return {.refused = true};
    if (refusal_of([&] { static_cast<void>(iris_of(polygon)); }) != "accepted")
        return {.refused = true};
    double reach = 0;
    for (const V2d& p : polygon.contours[0]) reach = std::fmax(reach, p.length());
    const double mm = kStop_mm / reach;
    const camera::Iris iris = iris_of(polygon);
    out.area_error = std::fabs(iris.area_mm2() / (exact_area(polygon) * mm * mm) - 1);
    out.called_outside = share_refused(iris);
    constexpr uint32_t kPoints = 4096;
    for (uint32_t i = 0; i < kPoints; ++i) {
        const V2f p = iris.sample(Sampler(SamplerKind::Owen, 5, {0, 0, i}).get2(Dim::Lens));
        const double off = distance_outside(polygon.contours[0], V2d(p.x, p.y) * (1 / mm));
        out.stray += double(!(off <= 1e-6)) / kPoints;
    }
    return out;
}

}  // namespace

Finding degenerate_polygons() {
    Finding f{.method = "Triangles of nearly degenerate polygons", .fails = "bias, then no answer"};
    f.sweep = fmt::format(
        "Polygons of size 1 that are degenerate but for d, scaled to {:g} mm: d comes down from "
        "0.1. Where the area is off by more than 1e-6 of itself, where 1 % of the drawn points are "
        "called outside by the inside test (in floats), where a drawn point lies more than 1e-6 "
        "outside the exact polygon, and where the polygon is refused.",
        kStop_mm);
    f.table.columns = {"polygon", "area off below d", "1 % called outside below d",
                       "strays below d", "refused below d"};
    const Family families[] = {{"vertex d off a straight edge", nearly_collinear},
                               {"edges d apart", nearly_touching},
                               {"triangle of height d", needle},
                               {"vertices on levels d apart", nearly_level}};
    double worst_lost = 0, worst_refused = 0;
    std::string lost_by = "none", refused_by = "none";
    bool stray = false;
    for (const Family& family : families) {
        const auto below = [&](auto fails) {
            return first_failure(
                0.1, 1e-20, [&](double d) { return fails(quality_of(family.of(d))); }, 2);
        };
        const auto area = below([](const Quality& q) { return q.area_error > 1e-6; });
        const auto lost = below([](const Quality& q) { return q.called_outside > 0.01; });
        const auto strays = below([](const Quality& q) { return q.stray > 0; });
        const auto refused = below([](const Quality& q) { return q.refused; });
        add_row(f, family.name, area, lost, strays, refused);
        if (lost.value_or(0) > worst_lost) worst_lost = *lost, lost_by = family.name;
        if (refused.value_or(0) > worst_refused) worst_refused = *refused, refused_by = family.name;
        stray = stray || strays;
    }
    f.where =
        fmt::format("{}: 1 % of the light is lost below d = {}. {}: refused below d = {}. {}",
                    lost_by, number(worst_lost), refused_by, number(worst_refused),
                    stray ? "Points leave the polygon where the table says so"
                          : "No drawn point leaves the polygon by more than 1e-6 of its size");
    const auto fault =
        camera::find_fault(camera::Polygon{{{{-1, -1}, {1, -1}, {1, 1}, {0, -1}, {-1, 1}}}});
    f.instead = fmt::format(
        "Areas and triangles are made in doubles. What touches or encloses nothing is refused "
        "(\"{}\").",
        fault ? fault->message : "accepted");
    return f;
}

Finding choice_by_weight() {
    Finding f{.method = "Choice by weight", .fails = "bias"};
    f.sweep =
        "Two things of weights 1 and w: the probability of the second over what it should be, by "
        "the running sum (whole multiples of 2^-24: triangles, texels of a mask or of a sky, "
        "lights) and by the alias table (over all 2^24 numbers that there are).";
    f.table.columns = {"w", "running sum: drawn / due", "alias table: drawn / due"};
    const auto sum_ratio = [](double w) {
        const float weights[2] = {1, static_cast<float>(w)};
        return double(Piecewise1D(weights).probability(1)) * (1 + w) / w;
    };
    const auto alias_ratio = [](double w) {
        const float weights[2] = {1, static_cast<float>(w)};
        const AliasTable table{std::span<const float>(weights)};
        uint32_t drawn = 0;
        for (uint32_t i = 0; i < kDistributionUnits; ++i)
            drawn += table.sample(static_cast<float>(i) * 0x1p-24f).cell;
        return drawn / double(kDistributionUnits) * (1 + w) / w;
    };
    for (const double w : {1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
        add_row(f, w, sum_ratio(w), alias_ratio(w));
    const auto off =
        first_failure(1e-2, 1e-10, [&](double w) { return std::fabs(sum_ratio(w) - 1) > 0.1; });
    f.where = fmt::format(
        "Probabilities are off by 10 % below w = {}: they are whole multiples of 2^-24, and never "
        "0, so that the faint one is drawn too often",
        number(off));
    f.instead =
        "Lights and skies divide by the probability that was used, so that only variance is paid. "
        "An iris does not: triangles and texels of a mask that hold less than 2^-24 of all are "
        "brightened to that.";
    return f;
}

}  // namespace petzval::stability
