// SPDX-License-Identifier: Apache-2.0
// Where the way from a film point to a point of the stop is not found.
#include <fmt/format.h>

#include <algorithm>

#include "camera/lens/trace.h"
#include "tests/stability/shipped_lens.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

// A direction that is not along an axis: cylinders have no symmetry there.
const V2f kAcross(0.8f, 0.6f);

// Irradiance at a film point over the radiance of an even scene: by counting directions on a grid
// that pass through the lens, without the solver.
struct Counted {
    double irradiance = 0;
    /// Share of it by directions that meet the stop the other way round than most: beyond a fold.
    double folded = 0;
};

Counted count_light(const ShippedLens& of, V2f film_mm) {
    const camera::Lens& lens = *of.lens;
    const camera::RayAimer aimer(lens, lens.film_mm(), film_mm.length());
    const camera::LensIndices<f4> indices =
        lens.exact_indices(splat(static_cast<float>(kLineD_nm)));
    const auto stop2_mm2 = static_cast<float>(sqr(of.stop_mm));
    V2f low(-1.f), high(1.f);
    Counted out;
    // The first look finds the box that the second one looks into.
    for (const int side : {160, 400}) {
        const V2f cell = (high - low) / static_cast<float>(side);
        V2f least(1.f), most(-1.f);
        uint32_t passed = 0, turned = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; x += 4) {
                const f4 l = low.x + cell.x * (f4{0.5f, 1.5f, 2.5f, 3.5f} + static_cast<float>(x));
                const f4 m = splat(low.y + cell.y * (static_cast<float>(y) + 0.5f));
                const camera::AimedRay<f4> c =
                    aimer.cross<f4>(camera::PlanePoint<f4>(film_mm), l, m, indices);
                const f4 stop_x = c.ray.origin.x, stop_y = c.ray.origin.y;
                m4 on = c.clear & c.ray.alive() & (l * l + m * m < 1.f) &
                        (stop_x * stop_x + stop_y * stop_y <= stop2_mm2);
                if (!camera::any(on)) continue;
                camera::LensRay<f4> ray = c.ray;
                on &= camera::trace_lens<f4>(
                    {lens, camera::Towards::Scene, {0, lens.stop() - 1}, camera::Clip::Yes},
                    indices, ray);
                for (int i = 0; i < 4; ++i) {
                    if (!on[i]) continue;
                    ++passed;
                    turned += c.determinant()[i] < 0;
                    least = {std::min(least.x, l[i]), std::min(least.y, m[i])};
                    most = {std::max(most.x, l[i]), std::max(most.y, m[i])};
                }
            }
        if (passed == 0) return {};
        out.irradiance = double(passed) * double(cell.x) * double(cell.y);
        out.folded = double(std::min(turned, passed - turned)) / passed;
        low = least - cell * 1.5f, high = most + cell * 1.5f;
    }
    return out;
}

// Draws of the whole stop from a film point, by the solver of a film that reaches so far.
struct Solved {
    double unreached = 0, traces = 0;
    int most_traces = 0;
};

Solved solved_at(const ShippedLens& of, double height_mm) {
    constexpr uint32_t kDraws = 1024;
    const V2f film_mm = kAcross * static_cast<float>(height_mm);
    const camera::RayAimer aimer(*of.lens, of.lens->film_mm(), height_mm);
    const camera::Iris iris(camera::Disk{}, of.stop_mm);
    const f8 nm = splat8(static_cast<float>(kLineD_nm));
    const camera::LensIndices<f8> indices = of.lens->exact_indices(nm);
    Solved out;
    uint32_t found = 0;
    for (uint32_t first = 0; first < kDraws; first += 8) {
        camera::PlanePoint<f8> at(f8{}, f8{});
        for (uint32_t i = 0; i < 8; ++i) {
            const V2f p =
                iris.sample(Sampler(SamplerKind::Owen, 2, {0, 0, first + i}).get2(Dim::Lens));
            at.x[i] = p.x, at.y[i] = p.y;
        }
        const camera::FoundRays c = aimer.aim(camera::PlanePoint<f8>(film_mm), at, indices, nm);
        for (int i = 0; i < 8; ++i) {
            if (!c.found[i]) continue;
            ++found;
            out.traces += c.traces[i];
            out.most_traces = std::max(out.most_traces, int(c.traces[i]));
        }
    }
    out.unreached = 1 - double(found) / kDraws;
    out.traces /= std::max(found, 1u);
    return out;
}

// What the camera's draws bring there.
struct Drawn {
    double irradiance = 0, heaviest = 0;  ///< heaviest weight over the mean of those that pass
};

Drawn drawn_at(const ShippedLens& of, V2f film_mm) {
    constexpr uint32_t kDraws = 1u << 16;
    const camera::LensCamera camera = of.camera(2 * double(film_mm.x), 2 * double(film_mm.y));
    Drawn out;
    double passed = 0;
    for (uint32_t i = 0; i < kDraws; ++i) {
        const V2f u = Sampler(SamplerKind::Owen, 2, {0, 0, i}).get2(Dim::Lens);
        const double weight = double(camera.draw<f4>(film_mm, u, Bands::rgb()).weight[0]);
        out.irradiance += weight / kDraws;
        out.heaviest = std::fmax(out.heaviest, weight);
        passed += double(weight > 0) / kDraws;
    }
    if (passed > 0) out.heaviest *= passed / out.irradiance;
    return out;
}

}  // namespace

Finding pupil_at_wide_fields() {
    Finding f{.method = "Aiming through the pupil", .fails = "bias, variance"};
    f.sweep =
        "Every lens that ships, wide open, line d, at 0.98 of the rim of its image circle: 1024 "
        "draws of the stop for which no ray is found; how often the others trace through the rear "
        "of the lens; the irradiance of 65536 draws against counting directions on a grid of 400 x "
        "400, without the solver, and the share of those directions that meet the stop the other "
        "way round; the weight of the heaviest draw over the mean of those that pass. And from "
        "where on, in steps of 5 % to three times the circle, some draw of 1024 has no ray.";
    f.table.columns = {"lens",
                       "height (mm)",
                       "no ray",
                       "traces (mean)",
                       "traces (most)",
                       "irradiance off by",
                       "light beyond a fold",
                       "heaviest draw",
                       "first without a ray (circles)"};
    double worst_off = 0, folded = 0, heaviest = 0;
    std::string off_name, folded_name, heavy_name;
    int most = 0, clear = 0, all = 0;
    for (const io::LensSummary& summary : io::list_lenses()) {
        const ShippedLens of(summary.name);
        const double r_mm = 0.98 * of.half_circle_mm;
        const V2f film_mm = kAcross * static_cast<float>(r_mm);
        const Solved corner = solved_at(of, r_mm);
        const Drawn drawn = drawn_at(of, film_mm);
        const Counted counted = count_light(of, film_mm);
        const double off = counted.irradiance > 0 ? drawn.irradiance / counted.irradiance - 1 : 0;
        std::optional<double> first;
        for (int i = 0; i <= 60 && !first; ++i)
            if (solved_at(of, of.half_circle_mm * 0.05 * i).unreached > 0) first = 0.05 * i;
        add_row(f, summary.name, r_mm, percent(corner.unreached), corner.traces, corner.most_traces,
                percent(off), percent(counted.folded), drawn.heaviest, first);
        ++all, clear += corner.unreached == 0;
        most = std::max(most, corner.most_traces);
        if (counted.folded > folded) folded = counted.folded, folded_name = summary.name;
        if (drawn.heaviest > heaviest) heaviest = drawn.heaviest, heavy_name = summary.name;
        if (std::fabs(off) > std::fabs(worst_off)) worst_off = off, off_name = summary.name;
    }
    f.where = fmt::format(
        "{} of {} lenses have a ray for every draw near the rim of their circle, in {} traces at "
        "most. Where the pupil folds, a point of the stop has two rays, of which one is found: the "
        "other side of the fold holds {} of the light of {}. Irradiance {} off at worst ({}); "
        "heaviest draw {} times the mean ({})",
        clear, all, most, percent(folded), folded_name, percent(worst_off), off_name,
        number(heaviest), heavy_name);
    f.instead =
        "A draw that no ray reaches brings no light and is counted (`unreached` in the statistics "
        "of `render`); it takes at most 12 traces to give up. At a fold the solver goes on until "
        "the ray is known, not only its crossing: a weight there is large, but not without bound. "
        "Light of the second ray is lost.";
    return f;
}

}  // namespace petzval::stability
