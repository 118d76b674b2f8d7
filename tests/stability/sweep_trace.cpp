// SPDX-License-Identifier: Apache-2.0
// Where rays through lens surfaces lose digits, or the surface.
#include <fmt/format.h>

#include <numbers>

#include "tests/stability/rays.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr double kTracePixel_mm = 0.006;

struct Spread {
    double apart_mm = 0, statuses_differ = 0;
};

template <class Trial>
Spread worst_of(int trials, const Trial& trial) {
    Spread out;
    for (int i = 0; i < trials; ++i) {
        const Pair pair = trial();
        if (pair.passed()) out.apart_mm = std::fmax(out.apart_mm, pair.apart_mm(kBehind_mm));
        out.statuses_differ += double(pair.statuses_differ()) / trials;
    }
    return out;
}

// Parallel to the axis onto a glass ball's front of 50 mm, at that cosine of incidence.
Spread into_glass(double cosine) {
    constexpr double kRadius_mm = 50;
    const camera::Lens lens = lens_of({surface(1 / kRadius_mm, 1e3, 100, true)});
    Draws draws(11);
    return worst_of(512, [&] {
        const double c = cosine * (1 + 0.1 * double(draws.next()));
        const double h_mm = kRadius_mm * std::sqrt(1 - c * c),
                     at = 2 * std::numbers::pi * double(draws.next());
        return trace_both(lens, {0, 0}, {h_mm * std::cos(at), h_mm * std::sin(at), -10}, {0, 0, 1});
    });
}

// Out of glass through a plane, at that cosine of refraction.
Spread out_of_glass(double cosine) {
    camera::Lens lens = lens_of({surface(0, 1e3, 5, true), surface(0, 1e3, 100, false)});
    Draws draws(12);
    return worst_of(512, [&] {
        const double c = cosine * (1 + 0.1 * double(draws.next()));
        const double sine = std::sqrt(1 - c * c) / kGlassIndex,
                     at = 2 * std::numbers::pi * double(draws.next());
        return trace_both(lens, {1, 1}, {0, 0, -3},
                          {sine * std::cos(at), sine * std::sin(at), std::sqrt(1 - sine * sine)});
    });
}

}  // namespace

Finding trace_at_grazing_incidence() {
    Finding f{.method = "Rays at grazing incidence", .fails = "bias"};
    f.sweep = fmt::format(
        "512 rays in floats and in doubles, from the same origin and direction: parallel to the "
        "axis onto a sphere of 50 mm of n = {}, and out of that glass through a plane. The cosine, "
        "of incidence or of refraction, comes down from 1. How far apart the two meet a plane "
        "{:g} mm behind, and the share of rays whose status (missed, totally reflected, passed) "
        "differs.",
        kGlassIndex, kBehind_mm);
    f.table.columns = {"cosine", "into a sphere (mm)", "other status", "out of a plane (mm)",
                       "other status there"};
    for (const double c : {0.9, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Spread in = into_glass(c), out = out_of_glass(c);
        add_row(f, c, in.apart_mm, percent(in.statuses_differ), out.apart_mm,
                percent(out.statuses_differ));
    }
    const auto sphere =
        first_failure(0.9, 1e-6, [](double c) { return into_glass(c).apart_mm > kTracePixel_mm; });
    const auto losses =
        first_failure(0.9, 1e-6, [](double c) { return into_glass(c).statuses_differ > 0.01; });
    const auto plane = first_failure(
        0.9, 1e-6, [](double c) { return out_of_glass(c).apart_mm > kTracePixel_mm; });
    const auto degrees_off = [](const std::optional<double>& c) {
        return number(c ? std::optional(std::asin(*c) * 180 / std::numbers::pi) : std::nullopt);
    };
    f.where = fmt::format(
        "Into a sphere floats are a pixel (6 um) off below a cosine of {} ({} degrees from "
        "grazing), and 1 % of the rays hit or miss otherwise below {}. Out of glass they are a "
        "pixel off below a cosine of refraction of {} ({} degrees)",
        number(sphere), degrees_off(sphere), number(losses), number(plane), degrees_off(plane));
    f.instead =
        "Every ray has a defined end: a point or a status. Grazing rays carry little light, as "
        "Fresnel's reflection goes to 1; `--method lens-precision=double` follows them in doubles.";
    return f;
}

namespace {

// Through a bent plate of 5 mm, 20 degrees off the axis and 10 mm from it.
double over_radius_mm(double radius_mm) {
    const camera::Lens lens =
        lens_of({surface(1 / radius_mm, 1e3, 5, true), surface(1 / radius_mm, 1e3, 100, false)});
    Draws draws(13);
    return worst_of(512,
                    [&] {
                        const double at = 2 * std::numbers::pi * double(draws.next());
                        const double h_mm = 10 * double(draws.next());
                        return trace_both(lens, {0, 1},
                                          {h_mm * std::cos(at), h_mm * std::sin(at), -10},
                                          {0.34 * double(draws.next()), 0.1, 1});
                    })
        .apart_mm;
}

// From an origin so far away onto the middle of a sphere of 50 mm.
double from_afar_mm(double distance_mm) {
    const camera::Lens lens = lens_of({surface(1 / 50., 1e3, 100, true)});
    Draws draws(14);
    return worst_of(512,
                    [&] {
                        const V3d aim(10 * double(draws.next()), 10 * double(draws.next()), 0);
                        const V3d direction = V3d(0.34 * double(draws.next()), 0.1, 1).normalized();
                        return trace_both(lens, {0, 0}, aim - direction * distance_mm, direction);
                    })
        .apart_mm;
}

}  // namespace

Finding trace_over_long_radii() {
    Finding f{.method = "Rays over long radii and from afar", .fails = "bias"};
    f.sweep = fmt::format(
        "512 rays in floats and in doubles from the same origin and direction: through a plate of "
        "5 mm bent to a radius R, and onto a sphere of 50 mm from an origin a distance D before "
        "it. How far apart they meet a plane {:g} mm behind.",
        kBehind_mm);
    f.table.columns = {"R or D (mm)", "radius R (mm)", "distance D (mm)"};
    double worst = 0;
    for (int k = 2; k <= 9; ++k) {
        const double x = std::pow(10, k), bent = over_radius_mm(x);
        add_row(f, x, bent, from_afar_mm(x));
        worst = std::fmax(worst, bent);
    }
    const auto radius =
        first_failure(1e2, 1e12, [](double r) { return over_radius_mm(r) > kTracePixel_mm; });
    const auto afar =
        first_failure(10, 1e9, [](double d) { return from_afar_mm(d) > kTracePixel_mm; });
    f.where = fmt::format(
        "Radii: {}, at most {} mm off. Origins: a pixel (6 um) off from a distance of {} mm on",
        radius ? "a pixel off from " + number(radius) + " mm on"
               : std::string("no failure from 1e2 to 1e12 mm"),
        number(worst), number(afar));
    f.instead =
        "Roots are taken from the ray's point nearest to the vertex, in the form in which nothing "
        "cancels. Cameras start their rays at the film, and analyses trace in doubles: no ray in "
        "floats comes from afar.";
    return f;
}

}  // namespace petzval::stability
