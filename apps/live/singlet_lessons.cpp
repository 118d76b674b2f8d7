// SPDX-License-Identifier: Apache-2.0
// Lessons of singlets.
#include <fmt/format.h>

#include <cmath>

#include "apps/live/lesson_setting.h"
#include "camera/bench/spectral_lines.h"
#include "camera/lens/profile.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

/// The singlet as a lens of two surfaces as far apart as its rim needs.
camera::Lens thick(const LessonSetting& set, double radius_mm) {
    const camera::Singlet singlet = set.singlet();
    camera::LensSurface stop, front, back;
    stop.stop = true;
    front.curvature_1_mm = 1 / singlet.r1_mm;
    front.glass = singlet.glass;
    back.curvature_1_mm = 1 / singlet.r2_mm;
    for (camera::LensSurface* one : {&stop, &front, &back})
        one->semi_diameter_mm = 1.05 * radius_mm;
    stop.semi_diameter_mm = radius_mm;
    const double sag1 = camera::sag_mm(front, 1.05 * radius_mm, camera::Section::Y),
                 sag2 = camera::sag_mm(back, 1.05 * radius_mm, camera::Section::Y);
    if (!std::isfinite(sag1 - sag2))
        throw set.refusal("is narrower than its iris: raise the f-number");
    constexpr double kRim_mm = 0.5;
    stop.thickness_mm = std::max(0., -sag1) + kRim_mm;
    front.thickness_mm = std::max(sag1 - sag2, 0.) + kRim_mm;
    back.thickness_mm = 50;  // until it is focused
    camera::Prescription lens;
    lens.name = "singlet";
    lens.surfaces = {stop, front, back};
    return camera::Lens(lens);
}

/// Index by a Sellmeier formula whose last plus sign is left out; NaN where the glass has another.
double without_a_plus(const Glass& glass, double nm) {
    const double w = nm / 1000;
    const auto* sellmeier = std::get_if<Sellmeier>(&glass.formula);
    if (!sellmeier || sellmeier->terms.size() != 3) return NAN;
    const auto term = [&](size_t i) {
        const auto [b, c] = sellmeier->terms[i];
        return b * w * w / (w * w - c);
    };
    return std::sqrt(1 + term(0) + term(1) * term(2));
}

}  // namespace

LessonJson spherical_lesson(const LessonSetting& set) {
    const camera::Singlet singlet = set.singlet();
    const camera::SingletOptics at_d = singlet.at(kLineD_nm);
    const double object_mm = set.focus_mm(), radius_mm = at_d.focal_mm / (2 * set.fstop());
    const double film_mm = camera::image_distance_mm(at_d.focal_mm, object_mm);
    const double magnified = film_mm / at_d.focal_mm;
    const double k_1_mm = camera::spherical_coefficient_per_mm(at_d, object_mm);
    const auto formula_mm = [&](double h) { return sqr(magnified) * k_1_mm * h * h / 2; };
    Json formula = Json::array(), traced = Json::array();
    for (int i = 0; i <= 40; ++i) {
        const double h = radius_mm * i / 40;
        formula.push_back({h, formula_mm(h)});
        if (const auto exact = camera::traced_spherical_aberration_mm(at_d, object_mm, h);
            exact && i > 0)
            traced.push_back({h, *exact});
    }
    const double most_mm = 1.2 * std::max(formula_mm(radius_mm), 1e-3);
    const double across_mm = 0.7 * most_mm * radius_mm / film_mm;
    LessonPlots out;
    const camera::LensBench bench = set.in_focus(thick(set, radius_mm));
    out.add("Zones about the film, which is sharp for rays near the axis",
            {-1.4 * most_mm, 0.4 * most_mm, "mm behind the film"}, {-across_mm, across_mm, "mm"},
            {series("traced rays, line d", "traced",
                    rays_about_film(bench, set.rays(bench, 0, object_mm), 17, 0.4 * most_mm)),
             upright("film", 0, across_mm)});
    out.add("Where a zone is sharp", {0, radius_mm, "mm from the axis"},
            {0, most_mm, "mm before the film"},
            {series("(S'/f)² K h²/2", "formula", {formula}),
             series("traced at two spheres", "dots", {traced})});
    out.add_figure("K", fmt::format("{:.4g} per mm", k_1_mm));
    for (const double fraction : {0.25, 0.5, 1.}) {
        const double h = fraction * radius_mm;
        const auto exact = camera::traced_spherical_aberration_mm(at_d, object_mm, h);
        out.add_figure(fmt::format("f/{:.3g}", at_d.focal_mm / (2 * h)),
                       exact
                           ? fmt::format("formula {:.3f} mm, traced {:.3f} mm: {:+.1f} %",
                                         formula_mm(h), *exact, 100 * (formula_mm(h) / *exact - 1))
                           : fmt::format("formula {:.3f} mm; no ray comes through", formula_mm(h)));
    }
    return out.json();
}

LessonJson chromatic_lesson(const LessonSetting& set) {
    const camera::Singlet singlet = set.singlet();
    const Glass& glass = singlet.glass;
    constexpr double kViolet_nm = 380, kRed_nm = 780;
    Json right = Json::array(), wrong = Json::array();
    for (double nm = kViolet_nm; nm <= kRed_nm; nm += 5) {
        right.push_back({nm, glass.index(nm)});
        if (std::isfinite(without_a_plus(glass, nm)))
            wrong.push_back({nm, without_a_plus(glass, nm)});
    }
    LessonPlots out;
    const double focal_mm = singlet.at(kLineD_nm).focal_mm;
    const camera::LensBench bench = set.in_focus(thick(set, focal_mm / (2 * set.fstop())));
    const double around_mm = 1.2 * focal_mm / glass.abbe();
    const double across_mm = 0.8 * around_mm / (2 * set.fstop());
    Json rays = Json::array();
    for (const camera::SpectralLine& line : camera::kSpectralLines) {
        rays.push_back(series(
            fmt::format("{}, {:.0f} nm", line.name, line.nm), line.name,
            rays_about_film(bench, set.rays(bench, 0, bench.distance_mm, line.nm), 6, around_mm)));
        const camera::SingletOptics at = singlet.at(line.nm);
        out.add_figure(fmt::format("{}, {:.1f} nm", line.name, line.nm),
                       fmt::format("n = {:.5f}, f = {:.3f} mm", at.n, at.focal_mm));
    }
    rays.push_back(upright("film", 0, across_mm));
    out.add("Three lines about the film", {-around_mm, around_mm, "mm behind the film"},
            {-across_mm, across_mm, "mm"}, rays);
    double low = glass.index(kRed_nm);
    Json indices{series(glass.name, "traced", {right})};
    if (!wrong.empty()) {
        low = std::min(low, without_a_plus(glass, kRed_nm));
        indices.push_back(series("a plus sign left out", "false", {wrong}));
    }
    constexpr double kMargin = 0.02;
    out.add("Index", {kViolet_nm, kRed_nm, "nm"},
            {low - kMargin, glass.index(kViolet_nm) + kMargin, "n"}, indices);
    out.add_figure("Abbe number", fmt::format("V = {:.1f}", glass.abbe()));
    out.add_figure("f(C) - f(F)",
                   fmt::format("{:.3f} mm; f/V = {:.3f} mm",
                               singlet.at(kLineC_nm).focal_mm - singlet.at(kLineF_nm).focal_mm,
                               focal_mm / glass.abbe()));
    if (const double n = without_a_plus(glass, kLineD_nm); std::isfinite(n))
        out.add_figure("without a plus sign", fmt::format("n = {:.3f} at line d", n));
    return out.json();
}

}  // namespace petzval::apps
