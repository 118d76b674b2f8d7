// SPDX-License-Identifier: Apache-2.0
// Lessons of traced lenses.
#include <fmt/format.h>

#include <cmath>

#include "apps/live/lesson_setting.h"
#include "camera/bench/ray_path.h"
#include "camera/bench/spot.h"
#include "camera/iris/iris.h"
#include "camera/lens/focus.h"
#include "io/aperture/aperture_file.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

/// What hangs in the scene of the page, assets/scenes/ornaments.glb: distance and style.
struct Thing {
    double mm;
    const char *name, *style;
};
constexpr std::array<Thing, 3> kThings{
    {{1000, "at 1 m", "near"}, {2000, "at 2 m", "middle"}, {6000, "at 6 m", "far"}}};
/// Blur that counts as sharp on a film of 36 x 24 mm, as depth-of-field scales have it.
constexpr double kSharp_mm = 0.03;

std::string micrometres(double mm) {
    return fmt::format("{:.0f} µm", kUm_per_mm * mm);
}

std::string metres(double mm) {
    return std::isfinite(mm) ? fmt::format("{:.2f} m", mm / 1000) : "infinity";
}

/// Blur of a thin lens, mm: c = A S' |1/S - 1/D|, which is A f |D - S| / (D (S - f)) (Potmesil and
/// Chakravarty 1982).
struct ThinBlur {
    double iris_mm, focal_mm, focus_mm, film_mm;  ///< A, f, S, S'

    explicit ThinBlur(const camera::LensBench& bench)
        : ThinBlur(camera::first_order(*bench.lens, kLineD_nm), bench.distance_mm) {}
    ThinBlur(const camera::FirstOrder& lens, double focus)
        : iris_mm(lens.entrance_pupil_diameter_mm),
          focal_mm(lens.focal_length_mm),
          focus_mm(focus),
          film_mm(camera::image_distance_mm(focal_mm, focus)) {}
    [[nodiscard]] double at(double distance_mm) const {
        return iris_mm * film_mm * std::fabs(1 / focus_mm - 1 / distance_mm);
    }
    /// Nearest distance, or farthest, whose blur is that much; infinite where there is none.
    [[nodiscard]] double limit_mm(double blur_mm, double side) const {
        const double inverse = 1 / focus_mm + side * blur_mm / (iris_mm * film_mm);
        return inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
    }
};

double traced_blur_mm(const LessonSetting& set, const camera::LensBench& bench,
                      double distance_mm) {
    double most = 0;
    for (const camera::FanPoint& ray : camera::ray_fan(*bench.lens, set.rays(bench, 0, distance_mm),
                                                       camera::Section::Y, bench.film_mm, {0, 0}))
        most = std::max(most, std::fabs(ray.from_mm[1]));
    return 2 * most;
}

}  // namespace

LessonJson confusion_lesson(const LessonSetting& set) {
    const camera::LensBench bench = set.bench();
    const ThinBlur thin(bench);
    constexpr int kRays = 7;
    constexpr double kAround_mm = 4, kAcross_mm = 1.5, kLead_mm = 10;
    LessonPlots out;
    Json glass = Json::array(), whole = Json::array(), close = Json::array();
    for (int i = 0; i < bench.lens->size(); ++i)
        glass.push_back(camera::element_outline(*bench.lens, i, camera::Section::Y));
    whole.push_back(series("", "glass", glass));
    for (const Thing& thing : kThings) {
        const camera::AimedBundle bundle = set.rays(bench, 0, thing.mm);
        Json paths = Json::array();
        for (const camera::PupilPoint& point : camera::section_points(bundle, kRays))
            paths.push_back(camera::ray_path(*bench.lens, bundle, point, bench.film_mm, kLead_mm));
        whole.push_back(series(thing.name, thing.style, paths));
        close.push_back(
            series(thing.name, thing.style, rays_about_film(bench, bundle, kRays, kAround_mm)));
        out.add_figure(thing.name,
                       fmt::format("formula {}, traced {}", micrometres(thin.at(thing.mm)),
                                   micrometres(traced_blur_mm(set, bench, thing.mm))));
    }
    const double film = bench.film_mm, high = (film + 2 * kLead_mm) / 3.2;
    whole.push_back(upright("film", film, high));
    close.push_back(upright("film", 0, kAcross_mm));
    out.add("Rays of points on the axis", {-kLead_mm, film + kLead_mm, "mm along the axis"},
            {-high, high, "mm"}, whole);
    out.add("The same about the film", {-kAround_mm, kAround_mm, "mm behind the film"},
            {-kAcross_mm, kAcross_mm, "mm"}, close);
    return out.json();
}

LessonJson depth_lesson(const LessonSetting& set) {
    const camera::LensBench bench = set.bench();
    const ThinBlur thin(bench);
    constexpr double kFirst_mm = 500, kLast_mm = 4000, kHigh_mm = 0.3;
    std::vector<double> far_mm(120);
    for (size_t i = 0; i < far_mm.size(); ++i)
        far_mm[i] = kFirst_mm + (kLast_mm - kFirst_mm) * double(i) / double(far_mm.size() - 1);
    Json formula = Json::array(), traced = Json::array();
    for (size_t i = 0; i < far_mm.size(); ++i) {
        formula.push_back({far_mm[i] / 1000, thin.at(far_mm[i])});
        if (i % 5 == 0) traced.push_back({far_mm[i] / 1000, traced_blur_mm(set, bench, far_mm[i])});
    }
    const double near = thin.limit_mm(kSharp_mm, 1), far = thin.limit_mm(kSharp_mm, -1);
    const double shown = std::min(far, kLast_mm) / 1000;
    LessonPlots out;
    out.add(
        "Blur by distance", {kFirst_mm / 1000, kLast_mm / 1000, "m from the lens"},
        {0, kHigh_mm, "mm of blur"},
        {series("formula", "formula", {formula}), series("traced", "dots", {traced}),
         series("counts as sharp: 0.03 mm", "limit",
                {{{near / 1000, 0}, {near / 1000, kSharp_mm}, {shown, kSharp_mm}, {shown, 0}}})});
    out.add_figure("nearest sharp", metres(near));
    out.add_figure("farthest sharp", metres(far));
    out.add_figure("hyperfocal distance", metres(thin.focal_mm * (thin.iris_mm / kSharp_mm + 1)));
    out.add_figure("traced blur in focus", micrometres(traced_blur_mm(set, bench, set.focus_mm())));
    return out.json();
}

LessonJson bokeh_lesson(const LessonSetting& set) {
    const camera::LensBench bench = set.bench(false);
    const double lamp_mm = kThings[2].mm;
    const auto radius_mm = camera::stop_radius_for(*bench.lens, set.fstop());
    if (!radius_mm) throw set.refusal("does not open that wide");
    const double rim_mm =
        bench.lens->prescription().surfaces[size_t(bench.lens->stop())].semi_diameter_mm;
    const camera::Iris iris(io::parse_aperture(set.asked().aperture.value_or("circle")),
                            std::min(*radius_mm, rim_mm), set.asked().aperture_scale, {}, rim_mm);
    LessonPlots out;
    constexpr int kSide = 64;
    constexpr double kEdge_mm = 18;  // half of a width of 36 mm
    std::vector<Json> all;
    double reach_mm = 0, middle_mm2 = 0;
    for (const double height_mm : {0., kEdge_mm}) {
        const camera::AimedBundle bundle = set.rays(bench, height_mm, lamp_mm);
        std::vector<camera::BundleRay> light;
        for (const camera::BundleRay& ray : bundle.trace(bundle.grid(kSide), bench.film_mm))
            if (iris.transmits({float(ray.stop_mm[0]), float(ray.stop_mm[1])}) > 0)
                light.push_back(ray);
        if (light.empty()) throw set.refusal("lets no light through there");
        const auto centre = camera::spot_size(light).centroid_mm;
        Json points = Json::array();
        // The picture stands upright, the film's image on its head.
        for (const camera::BundleRay& ray : light) {
            points.push_back(
                {rounded(centre[0] - ray.film_mm[0]), rounded(centre[1] - ray.film_mm[1])});
            for (size_t k = 0; k < 2; ++k)
                reach_mm = std::max(reach_mm, std::fabs(centre[k] - ray.film_mm[k]));
        }
        all.push_back(points);
        const double light_mm2 = double(light.size()) * (bundle.most()[0] - bundle.least()[0]) *
                                 (bundle.most()[1] - bundle.least()[1]);
        if (height_mm == 0)
            middle_mm2 = light_mm2;
        else
            out.add_figure("light at the edge",
                           fmt::format("{:.0f} % of the middle's", 100 * light_mm2 / middle_mm2));
    }
    for (size_t i = 0; i < all.size(); ++i)
        out.add(i == 0 ? "A lamp at 6 m, in the middle" : "The same at the left edge, 18 mm away",
                {-reach_mm, reach_mm, "mm"}, {-reach_mm, reach_mm, "mm"},
                {series("", "dots", {all[i]})}, true);
    out.add_figure("formula, of a round iris",
                   fmt::format("{:.2f} mm", ThinBlur(set.bench()).at(lamp_mm)));
    return out.json();
}

// Half widths of third order on a film in the paraxial focus: dW/drho times 2 N of Welford's
// wavefront (1986, 8.1).
LessonJson edge_lesson(const LessonSetting& set) {
    const camera::LensBench bench = set.bench();
    const double edge_mm = std::min(bench.lens->prescription().image_circle_mm / 2, 20.);
    const camera::FirstOrder paraxial = camera::first_order(*bench.lens, kLineD_nm);
    const std::array<const char*, 3> names{"spherical", "coma", "astigmatism and curvature"},
        styles{"near", "traced", "far"};
    std::array<Json, 3> curves;
    double most_um = 1;
    for (int i = 0; i <= 20; ++i) {
        const double y_mm = edge_mm * i / 20;
        const camera::SeidelSums s =
            camera::seidel(*bench.lens, y_mm / paraxial.focal_length_mm).total;
        const std::array<double, 3> sums{s[0], 3 * s[1], 3 * s[2] + s[3]};
        for (size_t k = 0; k < 3; ++k) {
            curves[k].push_back({y_mm, kUm_per_mm * std::fabs(sums[k]) * paraxial.fnumber});
            most_um = std::max(most_um, double(curves[k].back()[1]));
        }
    }
    Json all = Json::array();
    for (size_t k = 0; k < 3; ++k) all.push_back(series(names[k], styles[k], {curves[k]}));
    LessonPlots out;
    out.add("Third order, a distant point", {0, edge_mm, "mm from the axis"},
            {0, 1.1 * most_um, "µm"}, all);
    for (const double share : {0., 1.}) {
        const camera::AimedBundle bundle = set.rays(bench, share * edge_mm, bench.distance_mm);
        const std::vector<camera::BundleRay> spot = bundle.trace(bundle.grid(40), bench.film_mm);
        if (spot.empty()) throw set.refusal("lets no light through there");
        const auto [centre, rms_mm] = camera::spot_size(spot);
        Json points = Json::array();
        double reach_um = 0.1;
        for (const camera::BundleRay& ray : spot) {
            const double x = kUm_per_mm * (ray.film_mm[0] - centre[0]),
                         y = kUm_per_mm * (ray.film_mm[1] - centre[1]);
            points.push_back({rounded(x), rounded(y)});
            reach_um = std::max({reach_um, std::fabs(x), std::fabs(y)});
        }
        const std::string where =
            share > 0 ? fmt::format("{:g} mm from it", share * edge_mm) : "On the axis";
        out.add(where, {-reach_um, reach_um, "µm"}, {-reach_um, reach_um, "µm"},
                {series("", "dots fine", {points})}, true);
        out.add_figure(where, fmt::format("RMS radius {}", micrometres(rms_mm)));
    }
    return out.json();
}

}  // namespace petzval::apps
