// SPDX-License-Identifier: Apache-2.0
// Where rays through lens surfaces lose digits, or the surface.
#include <fmt/format.h>

#include <algorithm>

#include "camera/lens_march.h"
#include "camera/profile.h"
#include "io/lens_file.h"
#include "io/stability_sweeps.h"

namespace petzval::stability {
namespace {

constexpr double kGlassIndex = 1.5, kBehind_mm = 50, kPixel_mm = 0.006;

LensSurface surface(double curvature_1_mm, double semi_mm, double thickness_mm, bool glass) {
    LensSurface s;
    s.curvature_1_mm = curvature_1_mm;
    s.semi_diameter_mm = semi_mm;
    s.thickness_mm = thickness_mm;
    if (glass) s.glass = Glass{"n", IndexSeries{{{kGlassIndex, 0}}}};
    return s;
}

// With a stop behind all of it, through which everything passes.
Lens lens_of(std::vector<LensSurface> surfaces) {
    surfaces.push_back(surface(0, 1e6, kBehind_mm, surfaces.back().glass.has_value()));
    surfaces.back().stop = true;
    Prescription p;
    p.surfaces = std::move(surfaces);
    return Lens(std::move(p));
}

// One ray in four equal lanes.
template <class V>
LensRay<V> ray_from(const V3d& origin_mm, const V3d& direction) {
    using S = ScalarOf<V>;
    const auto all = [](double a) { return broadcast<V>(static_cast<S>(a)); };
    const V3d d = direction / direction.length();
    LensRay<V> ray;
    ray.origin = {all(origin_mm.x), all(origin_mm.y), all(origin_mm.z)};
    ray.direction = {all(d.x), all(d.y), all(d.z)};
    return ray;
}

struct Pair {
    LensRay<f4> in_floats;
    LensRay<d4> in_doubles;

    [[nodiscard]] bool fates_differ() const { return in_floats.fate(0) != in_doubles.fate(0); }
    [[nodiscard]] bool passed() const {
        return in_floats.fate(0) == Fate::Passed && in_doubles.fate(0) == Fate::Passed;
    }
    // Of the crossing with a plane so far behind the vertex of the last surface that was met.
    [[nodiscard]] double apart_mm(double behind_mm) const {
        const auto at = [behind_mm](const auto& ray) {
            const double t = (behind_mm - double(ray.origin.z[0])) / double(ray.direction.z[0]);
            return V3d(double(ray.origin.x[0]) + t * double(ray.direction.x[0]),
                       double(ray.origin.y[0]) + t * double(ray.direction.y[0]), 0);
        };
        return (at(in_floats) - at(in_doubles)).length();
    }
};

// Both from the same origin and direction, as floats have them.
Pair march_both(const Lens& lens, SurfaceRange range, const V3d& origin_mm, const V3d& direction) {
    const LensRay<f4> start = ray_from<f4>(origin_mm, direction);
    const auto lane_0 = [](const Vec3<f4>& a) {
        return V3d(double(a.x[0]), double(a.y[0]), double(a.z[0]));
    };
    Pair out{start, ray_from<d4>(lane_0(start.origin), lane_0(start.direction))};
    const float nm = static_cast<float>(kLineD_nm);
    static_cast<void>(march<f4>(lens, lens.exact_indices(splat(nm)), Towards::Film, range,
                                out.in_floats, Clip::No));
    static_cast<void>(march<d4>(lens, lens.exact_indices(broadcast<d4>(kLineD_nm)), Towards::Film,
                                range, out.in_doubles, Clip::No));
    return out;
}

struct Spread {
    double apart_mm = 0, fates_differ = 0;
};

template <class Trial>
Spread worst_of(int trials, const Trial& trial) {
    Spread out;
    for (int i = 0; i < trials; ++i) {
        const Pair pair = trial();
        if (pair.passed()) out.apart_mm = std::fmax(out.apart_mm, pair.apart_mm(kBehind_mm));
        out.fates_differ += double(pair.fates_differ()) / trials;
    }
    return out;
}

// Parallel to the axis onto a glass ball's front of 50 mm, at that cosine of incidence.
Spread into_glass(double cosine) {
    constexpr double kRadius_mm = 50;
    const Lens lens = lens_of({surface(1 / kRadius_mm, 1e3, 100, true)});
    Draws draws(11);
    return worst_of(512, [&] {
        const double c = cosine * (1 + 0.1 * double(draws.next()));
        const double h_mm = kRadius_mm * std::sqrt(1 - c * c), at = 2 * M_PI * double(draws.next());
        return march_both(lens, {0, 0}, {h_mm * std::cos(at), h_mm * std::sin(at), -10}, {0, 0, 1});
    });
}

// Out of glass through a plane, at that cosine of refraction.
Spread out_of_glass(double cosine) {
    Lens lens = lens_of({surface(0, 1e3, 5, true), surface(0, 1e3, 100, false)});
    Draws draws(12);
    return worst_of(512, [&] {
        const double c = cosine * (1 + 0.1 * double(draws.next()));
        const double sine = std::sqrt(1 - c * c) / kGlassIndex,
                     at = 2 * M_PI * double(draws.next());
        return march_both(lens, {1, 1}, {0, 0, -3},
                          {sine * std::cos(at), sine * std::sin(at), std::sqrt(1 - sine * sine)});
    });
}

}  // namespace

Finding march_at_grazing_incidence() {
    Finding f;
    f.method = "March at grazing incidence";
    f.fails = "bias";
    f.sweep = fmt::format(
        "512 rays in floats and in doubles, from the same origin and direction: parallel to the "
        "axis onto a sphere of 50 mm of n = {}, and out of that glass through a plane. The cosine, "
        "of incidence or of refraction, comes down from 1. How far apart the two meet a plane "
        "{:g} mm behind, and the share whose fates (missed, totally reflected, passed) differ.",
        kGlassIndex, kBehind_mm);
    f.table.columns = {"cosine", "into a sphere (mm)", "other fate", "out of a plane (mm)",
                       "other fate there"};
    for (const double c : {0.9, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Spread in = into_glass(c), out = out_of_glass(c);
        f.table.rows.push_back(
            row(c, in.apart_mm, percent(in.fates_differ), out.apart_mm, percent(out.fates_differ)));
    }
    const auto sphere =
        first_failure(0.9, 1e-6, [](double c) { return into_glass(c).apart_mm > kPixel_mm; });
    const auto fates =
        first_failure(0.9, 1e-6, [](double c) { return into_glass(c).fates_differ > 0.01; });
    const auto plane =
        first_failure(0.9, 1e-6, [](double c) { return out_of_glass(c).apart_mm > kPixel_mm; });
    const auto degrees_off = [](const std::optional<double>& c) {
        return number(c ? std::optional(std::asin(*c) * 180 / M_PI) : std::nullopt);
    };
    f.where = fmt::format(
        "Into a sphere floats are a pixel (6 um) off below a cosine of {} ({} degrees from "
        "grazing), and 1 % of the rays hit or miss otherwise below {}. Out of glass they are a "
        "pixel off below a cosine of refraction of {} ({} degrees)",
        number(sphere), degrees_off(sphere), number(fates), number(plane), degrees_off(plane));
    f.instead =
        "Every ray has a defined end: a point or a fate. Grazing rays carry little light, as "
        "Fresnel's reflection goes to 1; `--march double` follows them in doubles.";
    f.guards = {"RandomLens.EveryRayHasADefinedEnd", "Oracle.RaysInFloats",
                "LensCameraMarch.DoublesAgreeWithFloats"};
    return f;
}

namespace {

// Through a bent plate of 5 mm, 20 degrees off the axis and 10 mm from it.
double over_radius_mm(double radius_mm) {
    const Lens lens =
        lens_of({surface(1 / radius_mm, 1e3, 5, true), surface(1 / radius_mm, 1e3, 100, false)});
    Draws draws(13);
    return worst_of(512,
                    [&] {
                        const double at = 2 * M_PI * double(draws.next());
                        const double h_mm = 10 * double(draws.next());
                        return march_both(lens, {0, 1},
                                          {h_mm * std::cos(at), h_mm * std::sin(at), -10},
                                          {0.34 * double(draws.next()), 0.1, 1});
                    })
        .apart_mm;
}

// From an origin so far away onto the middle of a sphere of 50 mm.
double from_afar_mm(double distance_mm) {
    const Lens lens = lens_of({surface(1 / 50., 1e3, 100, true)});
    Draws draws(14);
    return worst_of(512,
                    [&] {
                        const V3d aim(10 * double(draws.next()), 10 * double(draws.next()), 0);
                        const V3d direction = V3d(0.34 * double(draws.next()), 0.1, 1).normalized();
                        return march_both(lens, {0, 0}, aim - direction * distance_mm, direction);
                    })
        .apart_mm;
}

}  // namespace

Finding march_over_long_radii() {
    Finding f;
    f.method = "March over long radii and from afar";
    f.fails = "bias";
    f.sweep = fmt::format(
        "512 rays in floats and in doubles from the same origin and direction: through a plate of "
        "5 mm bent to a radius R, and onto a sphere of 50 mm from an origin a distance D before "
        "it. How far apart they meet a plane {:g} mm behind.",
        kBehind_mm);
    f.table.columns = {"R or D (mm)", "radius R (mm)", "distance D (mm)"};
    double worst = 0;
    for (int k = 2; k <= 9; ++k) {
        const double x = std::pow(10, k), bent = over_radius_mm(x);
        f.table.rows.push_back(row(x, bent, from_afar_mm(x)));
        worst = std::fmax(worst, bent);
    }
    const auto radius =
        first_failure(1e2, 1e12, [](double r) { return over_radius_mm(r) > kPixel_mm; });
    const auto afar = first_failure(10, 1e9, [](double d) { return from_afar_mm(d) > kPixel_mm; });
    f.where = fmt::format(
        "Radii: {}, at most {} mm off. Origins: a pixel (6 um) off from a distance of {} mm on",
        radius ? "a pixel off from " + number(radius) + " mm on"
               : std::string("no failure from 1e2 to 1e12 mm"),
        number(worst), number(afar));
    f.instead =
        "Roots are taken from the ray's point nearest to the vertex, in the form in which nothing "
        "cancels. Cameras start their rays at the film, and analyses trace in doubles: no ray in "
        "floats comes from afar.";
    f.guards = {"March.NearlyFlatIsLikeFlatFromEverywhere", "Oracle.RaysInDoubles"};
    return f;
}

namespace {

// What Newton's method makes of rays onto one asphere, against a search for changes of sign.
struct Newton {
    double missed = 0,
           other = 0;  ///< shares: a surface that is there, a root that is not the first
};

LensSurface scaled_asphere(LensSurface s, double factor) {
    for (auto& term : s.asphere) term[1] *= factor;
    s.thickness_mm = 1;
    s.stop = false;
    return s;
}

Newton newton_on(const LensSurface& s) {
    std::vector<LensSurface> one{s};
    one[0].glass = Glass{"n", IndexSeries{{{kGlassIndex, 0}}}};
    const Lens lens = lens_of(one);
    const double semi_mm = s.semi_diameter_mm;
    constexpr int kHeights = 16, kSteps = 400;
    double deepest_mm = 0;
    for (int i = 0; i <= 100; ++i)
        deepest_mm = std::fmax(deepest_mm, std::fabs(sag_mm(s, semi_mm * i / 100, Section::Y)));
    const double reach_mm = 1.1 * deepest_mm + 0.5 * semi_mm;
    Newton out;
    int rays = 0;
    for (const double slope : {-0.4, 0., 0.4})
        for (int i = 0; i < kHeights; ++i) {
            const V3d aim(0, semi_mm * (2 * (i + 0.5) / kHeights - 1), 0);
            const V3d d = V3d(0, slope, 1).normalized();
            // Below the surface before it is met, as light comes; t = 0 at the vertex's plane.
            const auto above = [&](double t) {
                const V3d p = aim + d * t;
                return p.z - sag_mm(s, p.y, Section::Y);
            };
            std::optional<double> root;
            for (int k = 0; k < kSteps && !root; ++k) {
                double a = reach_mm * (2. * k / kSteps - 1);
                double b = reach_mm * (2. * (k + 1) / kSteps - 1);
                const bool within = std::fabs((aim + d * b).y) <= semi_mm;
                if (!within || !(above(a) < 0 && above(b) >= 0)) continue;
                for (int half = 0; half < 60; ++half)
                    (above((a + b) / 2) < 0 ? a : b) = (a + b) / 2;
                root = b;
            }
            if (!root) continue;
            ++rays;
            const Pair pair = march_both(lens, {0, 0}, aim - d * semi_mm, d);
            const auto judge = [&](Fate fate, double y) {
                out.missed += fate == Fate::Missed;
                out.other +=
                    fate == Fate::Passed && std::fabs(y - (aim + d * *root).y) > 1e-3 * semi_mm;
            };
            judge(pair.in_floats.fate(0), double(pair.in_floats.origin.y[0]));
            judge(pair.in_doubles.fate(0), pair.in_doubles.origin.y[0]);
        }
    out.missed /= std::max(2 * rays, 1);
    out.other /= std::max(2 * rays, 1);
    return out;
}

}  // namespace

Finding newton_on_strong_aspheres() {
    Finding f;
    f.method = "Newton on strong aspheres";
    f.fails = "no answer";
    f.sweep =
        "Each asphere of the lenses that ship, alone, its coefficients multiplied by a factor from "
        "1 to 1e4, and 48 rays at 0 and 22 degrees, in floats and in doubles, against a search for "
        "the first change "
        "of sign along the ray within the semi-diameter: the factor from which a ray misses a "
        "surface that is there, or meets another point of it than the first.";
    f.table.columns = {"lens",        "surface",        "departure at the rim / semi-diameter",
                       "a miss from", "10 % miss from", "another point from"};
    double least = HUGE_VAL, least_share = 0;
    std::string least_name;
    for (const LensSummary& summary : list_lenses()) {
        const Prescription lens = load_lens(summary.name).lens;
        for (size_t i = 0; i < lens.surfaces.size(); ++i) {
            const LensSurface& s = lens.surfaces[i];
            if (s.asphere.empty()) continue;
            LensSurface bare = s;
            bare.asphere.clear();
            const double semi_mm = s.semi_diameter_mm;
            const double departure =
                std::fabs(sag_mm(s, semi_mm, Section::Y) - sag_mm(bare, semi_mm, Section::Y)) /
                semi_mm;
            const auto from = [&](auto fails) {
                return first_failure(
                    1, 1e4,
                    [&](double factor) { return fails(newton_on(scaled_asphere(s, factor))); }, 5);
            };
            const auto miss = from([](const Newton& n) { return n.missed > 0; });
            const auto many = from([](const Newton& n) { return n.missed > 0.1; });
            const auto other = from([](const Newton& n) { return n.other > 0; });
            f.table.rows.push_back(
                row(summary.name, static_cast<int>(i) + 1, departure, miss, many, other));
            const double first = std::fmin(miss.value_or(HUGE_VAL), other.value_or(HUGE_VAL));
            if (first < least) least = first, least_share = departure, least_name = summary.name;
        }
    }
    f.where = fmt::format(
        "No asphere that ships fails as it is. The first to fail is one of {} from {} times its "
        "coefficients on, where it departs from its conic by {} of its semi-diameter at the rim",
        least_name, number(least), number(least * least_share));
    f.instead =
        "A ray whose twelve steps do not converge misses: it is blocked and counted, never a point "
        "that is not on the surface.";
    f.guards = {"RandomLens.EveryRayHasADefinedEnd",
                "RandomLens.PointsAreOnTheSurfacesAndSnellsLawHolds",
                "RandomLens.SlopesWhoseSquaresAreInfiniteMiss"};
    return f;
}

}  // namespace petzval::stability
