// SPDX-License-Identifier: Apache-2.0
// Newton's method on aspheres stronger than any that ships.
#include <fmt/format.h>

#include <algorithm>

#include "camera/lens/profile.h"
#include "io/lens/lens_file.h"
#include "tests/stability/rays.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

// What Newton's method makes of rays onto one asphere, against a search for changes of sign.
struct Newton {
    double missed = 0,
           other = 0;  ///< shares: a surface that is there, a root that is not the first
};

camera::LensSurface scaled_asphere(camera::LensSurface s, double factor) {
    for (auto& term : s.asphere) term[1] *= factor;
    s.thickness_mm = 1;
    s.stop = false;
    return s;
}

Newton newton_on(const camera::LensSurface& s) {
    std::vector<camera::LensSurface> one{s};
    one[0].glass = Glass{"n", IndexSeries{{{kGlassIndex, 0}}}};
    const camera::Lens lens = lens_of(one);
    const double semi_mm = s.semi_diameter_mm;
    constexpr int kHeights = 16, kSteps = 400;
    double deepest_mm = 0;
    for (int i = 0; i <= 100; ++i)
        deepest_mm = std::fmax(deepest_mm,
                               std::fabs(camera::sag_mm(s, semi_mm * i / 100, camera::Section::Y)));
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
                return p.z - camera::sag_mm(s, p.y, camera::Section::Y);
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
            const Pair pair = trace_both(lens, {0, 0}, aim - d * semi_mm, d);
            const auto judge = [&](camera::RayStatus status, double y) {
                out.missed += status == camera::RayStatus::Missed;
                out.other += status == camera::RayStatus::Passed &&
                             std::fabs(y - (aim + d * *root).y) > 1e-3 * semi_mm;
            };
            judge(pair.in_floats.status(0), double(pair.in_floats.origin.y[0]));
            judge(pair.in_doubles.status(0), pair.in_doubles.origin.y[0]);
        }
    out.missed /= std::max(2 * rays, 1);
    out.other /= std::max(2 * rays, 1);
    return out;
}

}  // namespace

Finding newton_on_strong_aspheres() {
    Finding f{.method = "Newton on strong aspheres", .fails = "no answer"};
    f.sweep =
        "Each asphere of the lenses that ship, alone, its coefficients multiplied by a factor from "
        "1 to 1e4, and 48 rays at 0 and 22 degrees, in floats and in doubles, against a search for "
        "the first change of sign along the ray within the semi-diameter: the factor from which a "
        "ray misses a surface that is there, or meets another point of it than the first.";
    f.table.columns = {"lens",        "surface",        "departure at the rim / semi-diameter",
                       "a miss from", "10 % miss from", "another point from"};
    double least = HUGE_VAL, least_share = 0;
    std::string least_name;
    for (const io::LensSummary& summary : io::list_lenses()) {
        const camera::Prescription lens = io::load_lens(summary.name).lens;
        for (size_t i = 0; i < lens.surfaces.size(); ++i) {
            const camera::LensSurface& s = lens.surfaces[i];
            if (s.asphere.empty()) continue;
            camera::LensSurface bare = s;
            bare.asphere.clear();
            const double semi_mm = s.semi_diameter_mm;
            const double departure = std::fabs(camera::sag_mm(s, semi_mm, camera::Section::Y) -
                                               camera::sag_mm(bare, semi_mm, camera::Section::Y)) /
                                     semi_mm;
            const auto from = [&](auto fails) {
                return first_failure(
                    1, 1e4,
                    [&](double factor) { return fails(newton_on(scaled_asphere(s, factor))); }, 5);
            };
            const auto miss = from([](const Newton& n) { return n.missed > 0; });
            const auto many = from([](const Newton& n) { return n.missed > 0.1; });
            const auto other = from([](const Newton& n) { return n.other > 0; });
            add_row(f, summary.name, static_cast<int>(i) + 1, departure, miss, many, other);
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
    return f;
}

}  // namespace petzval::stability
