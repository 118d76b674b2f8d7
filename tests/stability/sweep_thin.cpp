// SPDX-License-Identifier: Apache-2.0
// Where the closed forms of a thin lens end.
#include <fmt/format.h>

#include "apps/setup/camera/thin_setup.h"
#include "camera/models/aberrated_lens.h"
#include "camera/models/thin_lens_optics.h"
#include "io/glass/glass_lookup.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {
namespace {

constexpr double kThinFocal_mm = 50, kThinPixel_mm = 0.006;  ///< 6000 pixels on 36 mm
constexpr double kFar = std::numeric_limits<double>::infinity();

// How far apart formula and trace meet the film that is sharp near the axis.
double film_error_mm(const camera::SingletOptics& lens, double object_mm, double h_mm) {
    const auto traced = camera::traced_spherical_aberration_mm(lens, object_mm, h_mm);
    const double zonal_mm = camera::zonal_focal_length_mm(lens, object_mm, h_mm);
    if (!traced || !(zonal_mm > 0 && zonal_mm < object_mm)) return kFar;
    const double image_mm = camera::image_distance_mm(lens.focal_mm, object_mm);
    const auto height = [&](double aberration_mm) {
        return aberration_mm * h_mm / (image_mm - aberration_mm);
    };
    return std::fabs(height(camera::spherical_aberration_mm(lens, object_mm, h_mm)) -
                     height(*traced));
}

camera::AberratedLens singlet_camera(const Glass& glass, double bending, double h_mm,
                                     double focus_mm) {
    return {M44f(), camera::Singlet::bent(glass, kThinFocal_mm, bending),
            camera::Iris(camera::Disk{}, h_mm), focus_mm * 1e-3};
}

// What the program says of a singlet at that f-number.
std::string warning_of(const Glass& glass, float fstop) {
    apps::CameraModel plan;
    plan.asked.lens = "singlet:" + glass.name;
    plan.asked.focal_length_mm = static_cast<float>(kThinFocal_mm);
    plan.asked.fstop = fstop;
    plan.optics = apps::SingleLens{glass, 0, {}};
    std::string said;
    const apps::ThinView view = apps::thin_view(plan, "", 1.5f);
    static_cast<void>(apps::set_up_thin(plan, view, camera::ThinLens{}, 1e6f,
                                        [&](const std::string& text) { said += text; }));
    return said;
}

}  // namespace

Finding third_order_formula() {
    const Glass glass = io::LensGlasses({}).find("schott:N-BK7").value();
    const double n = glass.index(kLineD_nm);
    Finding f{.method = "Third-order formula of a singlet", .fails = "bias"};
    f.sweep = fmt::format(
        "A singlet of N-BK7 with f = {:g} mm, equiconvex (q = 0) or flat towards the film (q = 1). "
        "The ray's height h grows from f/1000 until the formula's intersection with the axis is "
        "off the exact trace's by 1 % and 10 % of the aberration, until the two are a pixel of "
        "{:g} um apart on the film, until no ray comes through, and until the camera refuses the "
        "iris; as f-numbers, f / 2h.",
        kThinFocal_mm, kThinPixel_mm * 1e3);
    f.table.columns = {
        "object S/f",      "q", "1 % below f/", "10 % below f/", "1 px below f/", "no ray below f/",
        "refused below f/"};
    double one_far = 0, ten_far = 0, px_far = 0;
    double ten_worst = 0, ten_worst_at = 0, px_worst = 0, px_worst_at = 0;
    for (const double q : {0., 1.})
        for (const double s : {kFar, 100., 10., 4., 2., 1.5, 1.2, 1.1, 1.05}) {
            const camera::SingletOptics lens{n, kThinFocal_mm, q};
            const double object_mm = s * kThinFocal_mm;
            const auto fnumber = [&](auto fails) -> std::optional<double> {
                const auto h = first_failure(1e-3 * kThinFocal_mm, kThinFocal_mm, fails, 32);
                if (!h) return std::nullopt;
                return kThinFocal_mm / (2 * *h);
            };
            const auto off_by = [&](double most) {
                return fnumber([&, most](double h_mm) {
                    return camera::spherical_aberration_error(lens, object_mm, h_mm) > most;
                });
            };
            const auto one = off_by(0.01), ten = off_by(0.1);
            const auto pixel = fnumber(
                [&](double h_mm) { return film_error_mm(lens, object_mm, h_mm) > kThinPixel_mm; });
            const auto no_ray = fnumber([&](double h_mm) {
                return !camera::traced_spherical_aberration_mm(lens, object_mm, h_mm);
            });
            const auto refused = fnumber([&](double h_mm) {
                return refusal_of([&] {
                           camera::AberratedLensCamera(singlet_camera(glass, q, h_mm, object_mm));
                       }) != "accepted";
            });
            add_row(f, s, q, one, ten, pixel, no_ray, refused);
            if (q == 0 && std::isinf(s)) one_far = *one, ten_far = *ten, px_far = *pixel;
            if (ten.value_or(0) > ten_worst) ten_worst = *ten, ten_worst_at = s;
            if (pixel.value_or(0) > px_worst) px_worst = *pixel, px_worst_at = s;
        }
    f.where = fmt::format(
        "Equiconvex and a distant object: off by 1 % below f/{}, by 10 % below f/{}, by a pixel "
        "below f/{}. Worst of all objects and both shapes: 10 % below f/{} at S = {} f, a pixel "
        "below f/{} at S = {} f",
        number(one_far), number(ten_far), number(px_far), number(ten_worst), number(ten_worst_at),
        number(px_worst), number(px_worst_at));
    f.instead = fmt::format(
        "From 10 % on a warning says from which f-number on the formula holds (at f/1.5: \"{}\"). "
        "An iris at whose rim f(h) falls below half of f is refused: \"{}\".",
        warning_of(glass, 1.5f), refusal_of([&] {
            camera::AberratedLensCamera(singlet_camera(glass, 0, 0.7 * kThinFocal_mm, kFar));
        }));
    return f;
}

namespace {

// Largest distance, in pixels, of a thin lens's rays from the point of the plane in focus at which
// they all should meet. The camera stands away_m from the origin.
double spread_px(double closeness, float away_m) {
    const double focus_mm = kThinFocal_mm * (1 + closeness), film_mm = focus_mm / closeness;
    M44f pose;
    pose[3][0] = pose[3][1] = pose[3][2] = away_m;
    const auto focus_m = static_cast<float>(focus_mm * 1e-3);
    const camera::ThinLensCamera camera({pose, static_cast<float>(2 * std::atan(12 / film_mm)),
                                         1.5f, camera::Iris(camera::Disk{}, kThinFocal_mm / 4),
                                         focus_m});
    const double z_m = double(away_m) - double(focus_m);
    double most_px = 0;
    for (const V2f& film : {V2f(0.5f, 0.5f), V2f(0.9f, 0.2f)}) {
        std::optional<V3d> first;
        for (uint32_t i = 0; i < 256; ++i) {
            const camera::CameraPath path =
                camera.sample({film, Sampler(SamplerKind::Owen, 1, {0, 0, i})}, Bands::rgb())[0];
            const V3d o(path.ray.origin), d(path.ray.direction);
            const V3d p = o + d * ((z_m - o.z) / d.z);
            if (!first) first = p;
            most_px = std::fmax(most_px, (p - *first).length() * 1e3 / (kThinPixel_mm * closeness));
        }
    }
    return most_px;
}

// Of the film's place, by a focus that is a float in metres: the worst of a hundred focal lengths.
double film_place_error(double closeness) {
    double worst = 0;
    for (int i = 0; i < 100; ++i) {
        const double focal_mm = 10 + 1.9 * i, focus_mm = focal_mm * (1 + closeness);
        const double rounded_mm = 1e3 * double(static_cast<float>(focus_mm * 1e-3));
        if (!(rounded_mm > focal_mm)) return kFar;
        worst = std::fmax(worst, std::fabs(camera::image_distance_mm(focal_mm, rounded_mm) /
                                               camera::image_distance_mm(focal_mm, focus_mm) -
                                           1));
    }
    return worst;
}

}  // namespace

Finding focus_near_focal_length() {
    Finding f{.method = "Thin lens near S = f", .fails = "bias, then no answer"};
    f.sweep =
        "The distance in focus S comes down to the focal length, at f/2 and 50 mm. Errors of the "
        "film's place S' because S is a float in metres (the worst of a hundred focal lengths from "
        "10 to 198 mm), and how far the rays of one film point miss each other on the plane in "
        "focus, in pixels of 6 um, with the camera at the origin of the scene and at (1, 1, 1) m.";
    f.table.columns = {"S/f - 1", "magnification S'/S", "error of S'", "miss at the origin (px)",
                       "miss 1.7 m from it (px)"};
    for (int k = 0; k <= 8; ++k) {
        const double closeness = std::pow(10, -k);
        add_row(f, closeness, 1 / closeness, film_place_error(closeness), spread_px(closeness, 0),
                spread_px(closeness, 1));
    }
    const auto place = first_failure(1, 1e-8, [](double c) { return film_place_error(c) > 0.01; });
    const auto here = first_failure(1, 1e-8, [](double c) { return spread_px(c, 0) > 1; });
    const auto away = first_failure(1, 1e-8, [](double c) { return spread_px(c, 1) > 1; });
    f.where = fmt::format(
        "Rays of a point miss each other by a pixel below S/f - 1 = {} with the camera at "
        "(1, 1, 1) m (magnification {}) and below {} at the origin; the film's place is off by 1 % "
        "below {}. At S <= f there is no image",
        number(away), number(1 / away.value_or(0)), number(here), number(place));
    f.instead = fmt::format(
        "Down to the last float the camera renders what it has; for S = f, \"{}\".", refusal_of([] {
            static_cast<void>(camera::image_distance_mm(kThinFocal_mm, kThinFocal_mm));
        }));
    return f;
}

}  // namespace petzval::stability
