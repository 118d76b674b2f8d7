// SPDX-License-Identifier: Apache-2.0
// Where the way from a film point to a point of the stop is not found.
#include <fmt/format.h>

#include <algorithm>

#include "camera/lens_camera.h"
#include "camera/paraxial.h"
#include "io/lens_file.h"
#include "io/stability_sweeps.h"

namespace petzval::stability {
namespace {

// A direction that is not along an axis: cylinders have no symmetry there.
const V2f kAcross(0.8f, 0.6f);

struct Subject {
    std::shared_ptr<const Lens> lens;
    double stop_mm, half_circle_mm;

    explicit Subject(const std::string& name) {
        Prescription p = load_lens(name).lens;
        half_circle_mm = 0.5 * (p.image_circle_mm > 0 ? p.image_circle_mm : 43.27);
        lens = std::make_shared<const Lens>(std::move(p));
        stop_mm = lens->prescription().surfaces[static_cast<size_t>(lens->stop())].semi_diameter_mm;
    }
    [[nodiscard]] LensIndices<f4> line_d() const {
        return lens->exact_indices(splat(static_cast<float>(kLineD_nm)));
    }
};

struct Solved {
    double unreached = 0, marches = 0;
    int most_marches = 0;
};

// Draws of the whole stop from a film point, by the solver of a film that reaches so far.
Solved solved_at(const Subject& of, double height_mm) {
    constexpr uint32_t kDraws = 512;
    const Pupil pupil(*of.lens, of.lens->film_mm(), height_mm);
    const Iris iris(Disk{}, of.stop_mm);
    const LensIndices<f4> indices = of.line_d();
    Solved out;
    uint32_t found = 0;
    for (uint32_t i = 0; i < kDraws; ++i) {
        const V2f at = iris.sample(Sampler(SamplerKind::Owen, 2, {0, 0, i}).get2(Dim::Lens));
        const auto c = pupil.solve(kAcross * static_cast<float>(height_mm), at, indices, 0,
                                   static_cast<float>(kLineD_nm));
        if (!c) continue;
        ++found;
        out.marches += c->marches;
        out.most_marches = std::max(out.most_marches, c->marches);
    }
    out.unreached = 1 - double(found) / kDraws;
    out.marches /= std::max(found, 1u);
    return out;
}

// Integral of dl dm over the directions at a film point that pass through the lens, by trying
// directions on a grid: no solver. box: of the directions, halved in every round.
double counted_irradiance(const Subject& of, V2f film_mm) {
    const Lens& lens = *of.lens;
    const Pupil pupil(lens, lens.film_mm(), film_mm.length());
    const LensIndices<f4> indices = of.line_d();
    V2f low(-1.f), high(1.f);
    double area = 0;
    for (const int side : {160, 240}) {
        const V2f cell = (high - low) / static_cast<float>(side);
        V2f least(1.f), most(-1.f);
        uint32_t passed = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; x += 4) {
                const f4 l = low.x + cell.x * (f4{0.5f, 1.5f, 2.5f, 3.5f} + static_cast<float>(x));
                const f4 m = splat(low.y + cell.y * (static_cast<float>(y) + 0.5f));
                const StopCrossing<f4> c = pupil.cross<f4>(film_mm, l, m, indices);
                m4 on = c.clear & c.ray.alive() & (l * l + m * m < 1.f);
                if (!any(on)) continue;
                LensRay<f4> ray = c.ray;
                on &= march<f4>(lens, indices, Towards::Scene, {0, lens.stop() - 1}, ray, Clip::Yes);
                for (int i = 0; i < 4; ++i) {
                    if (!on[i]) continue;
                    ++passed;
                    least = {std::min(least.x, l[i]), std::min(least.y, m[i])};
                    most = {std::max(most.x, l[i]), std::max(most.y, m[i])};
                }
            }
        area = double(passed) * double(cell.x) * double(cell.y);
        low = least - cell * 1.5f, high = most + cell * 1.5f;
    }
    return area;
}

double solved_irradiance(const Subject& of, V2f film_mm) {
    LensCameraInput in{.lens = of.lens, .iris = Iris(Disk{}, of.stop_mm), .to_world = M44f()};
    in.film_mm = of.lens->film_mm();
    in.film_width_mm = 2 * double(std::fabs(film_mm.x));
    in.film_height_mm = 2 * double(std::fabs(film_mm.y));
    in.chroma = Chroma::Shared;
    return LensCamera(in).irradiance(film_mm, 4096);
}

}  // namespace

Finding pupil_at_wide_fields() {
    Finding f;
    f.method = "Aiming through the pupil";
    f.fails = "no answer";
    f.sweep =
        "Every lens that ships, wide open, line d: 512 draws of the stop from the corner of the "
        "film (the rim of the image circle), and then from farther out, by 5 % steps to three "
        "times the circle, until a draw has no ray from film to stop. Irradiance at the corner "
        "against counting directions on a grid, without the solver.";
    f.table.columns = {"lens",          "corner (mm)",        "unreached there", "marches (mean)",
                       "marches (most)", "irradiance off by", "first unreached at (circles)"};
    double least_reach = HUGE_VAL, worst_off = 0;
    std::string nearest, worst_name;
    int most = 0;
    for (const LensSummary& summary : list_lenses()) {
        const Subject of(summary.name);
        const double r_mm = of.half_circle_mm;
        const Solved corner = solved_at(of, r_mm);
        std::optional<double> first;
        for (int i = 0; i <= 40 && !first; ++i)
            if (solved_at(of, r_mm * (1 + 0.05 * i)).unreached > 0) first = 1 + 0.05 * i;
        const V2f film_mm = kAcross * static_cast<float>(r_mm * 0.98);
        const double counted = counted_irradiance(of, film_mm);
        const double off = counted > 0 ? solved_irradiance(of, film_mm) / counted - 1 : 0;
        f.table.rows.push_back(row(summary.name, r_mm, percent(corner.unreached), corner.marches,
                                   corner.most_marches, percent(std::fabs(off)), first));
        if (first.value_or(HUGE_VAL) < least_reach) least_reach = *first, nearest = summary.name;
        if (std::fabs(off) > worst_off) worst_off = std::fabs(off), worst_name = summary.name;
        most = std::max(most, corner.most_marches);
    }
    f.where = fmt::format(
        "First draws without a ray: {} at {} image circles. At the corner no draw takes more than "
        "{} marches, and the irradiance is within {} of counting (worst: {}), which is what "
        "counting errs itself",
        nearest, number(least_reach), most, percent(worst_off), worst_name);
    f.instead =
        "A draw that no ray reaches brings no light and is counted (`unreached` in the statistics "
        "of `render`). It takes 12 marches to give up.";
    f.guards = {"Pupil.RaysMeetTheStopWhereTheyShould", "LensCamera.IrradianceIsTheOracles",
                "LaneFates.AFilmBeyondTheImageCircleIsBlack",
                "LaneFates.AtTheFisheyesRimRaysGrazeThenAreTotallyReflected"};
    return f;
}

}  // namespace petzval::stability
