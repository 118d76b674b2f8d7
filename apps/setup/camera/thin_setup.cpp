// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/thin_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "camera/models/aberrated_lens.h"
#include "camera/models/thin_lens_optics.h"
#include "camera/setup/exposure.h"
#include "camera/setup/sensor.h"
#include "io/aperture/aperture_file.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

constexpr float kDefaultFov_deg = 40.f;
/// Greatest error of the third-order formula without a warning.
constexpr double kMostFormulaError = 0.1;

/// Farthest distance that differs from infinity, and no float overflows.
constexpr double kAsFarAsInfinity_m = 1e6;

// Result of a closed form. What it refuses becomes an error in words for whoever chose the numbers.
template <class Function>
auto or_argument_error(const CameraModel& model, Function&& function) {
    try {
        return function();
    } catch (const std::invalid_argument& error) {
        throw io::ArgumentError(model.asked.lens.value_or("thin lens"), "", error.what());
    }
}

void require_fov(float fov_deg, const std::string& scene, const std::string& why) {
    if (fov_deg >= kSmallestFov_deg && fov_deg <= kLargestFov_deg) return;
    throw io::ArgumentError(scene, "",
                            "{} gives an angle of view of {:g} degrees; it must be {} to {}", why,
                            fov_deg, kSmallestFov_deg, kLargestFov_deg);
}

camera::Singlet singlet_of(const SingleLens& lens, double focal_mm) {
    if (lens.radii_mm) return {lens.glass, (*lens.radii_mm)[0], (*lens.radii_mm)[1]};
    return camera::Singlet::bent(lens.glass, focal_mm, lens.bending);
}

// Focal length that the request says, be it by the radii of a lens; nothing where it does not.
std::optional<double> asked_focal_length_mm(const CameraModel& model) {
    if (const auto* lens = std::get_if<SingleLens>(&model.optics); lens && lens->radii_mm)
        return singlet_of(*lens, 0).at(kLineD_nm).focal_mm;
    return model.asked.focal_length_mm;
}

void warn_of_formula(const camera::Singlet& singlet, const CameraModel& model, double focus_mm,
                     double radius_mm, const io::Notice& notice) {
    const camera::SingletOptics at = singlet.at(kLineD_nm);
    const double error = camera::spherical_aberration_error(at, focus_mm, radius_mm);
    if (!(error > kMostFormulaError)) return;
    const double fits_mm = camera::radius_within_error(at, focus_mm, radius_mm, kMostFormulaError);
    notice(
        fmt::format("warning: {} at f/{:.3g}: the formula of its spherical aberration is {} off "
                    "at the rim of the iris; it is within {:g} % from f/{:.3g} on",
                    *model.asked.lens, at.focal_mm / (2 * radius_mm),
                    std::isfinite(error) ? fmt::format("{:.0f} %", 100 * error) : "far",
                    100 * kMostFormulaError, at.focal_mm / (2 * fits_mm)));
}

}  // namespace

ThinView thin_view(const CameraModel& model, const std::string& scene, float aspect) {
    const CameraRequest& asked = model.asked;
    ThinView view{};
    view.sensor_mm = camera::film_within(asked.sensor_mm.value_or(V2f(36.f, 24.f)), aspect);
    const float half_mm = view.sensor_mm.y / 2;
    view.focal_mm = or_argument_error(model, [&] { return asked_focal_length_mm(model); });
    const auto of_half = [&](double distance_mm) {
        return 2 * std::atan(half_mm / static_cast<float>(distance_mm)) / kDegree_rad;
    };
    if (asked.film_distance_mm) {
        view.yfov_deg = of_half(*asked.film_distance_mm);
        require_fov(view.yfov_deg, scene, "⟨film-distance⟩");
        if (view.focal_mm)
            view.focus_m = static_cast<float>(or_argument_error(model, [&] {
                return std::fmin(1e-3 * camera::object_distance_mm(*view.focal_mm,
                                                                   double(*asked.film_distance_mm)),
                                 kAsFarAsInfinity_m);
            }));
    } else if (model.from && !asked.fov_deg && !view.focal_mm) {
        view.angle_of_file = true;
        view.yfov_rad = model.from->yfov_rad;
        view.yfov_deg = view.yfov_rad / kDegree_rad;
    } else if (asked.fov_deg || !view.focal_mm) {
        view.yfov_deg = asked.fov_deg.value_or(kDefaultFov_deg);
    } else {
        view.angle_by_focal = true;
        view.yfov_deg = of_half(*view.focal_mm);
        require_fov(view.yfov_deg, scene,
                    fmt::format("a focal length of {:g} mm with a sensor {:g} mm high",
                                *view.focal_mm, view.sensor_mm.y));
    }
    if (view.yfov_rad == 0) view.yfov_rad = view.yfov_deg * kDegree_rad;
    if (!view.focal_mm && !asked.film_distance_mm)
        view.focal_mm = half_mm / std::tan(view.yfov_rad / 2);
    return view;
}

float yfov_at_rad(const ThinView& view, std::optional<float> focus_m) {
    const double focus_mm = focus_m ? 1e3 * double(*focus_m) : 0;
    // Nearer than the focal length nothing is sharp; set_up_thin() will say so.
    if (!view.angle_by_focal || !(focus_mm > *view.focal_mm)) return view.yfov_rad;
    const double film_mm = camera::image_distance_mm(*view.focal_mm, focus_mm);
    return 2 * std::atan(view.sensor_mm.y / 2 / static_cast<float>(film_mm));
}

ThinSetup set_up_thin(const CameraModel& model, const ThinView& view, camera::ThinLens lens,
                      std::optional<float> focus_m, const io::Notice& notice) {
    const CameraRequest& asked = model.asked;
    const bool photographic = asked.exposure == ExposureMode::Photographic;
    const bool vignettes = asked.natural_vignetting.value_or(photographic);
    ThinSetup setup{};
    setup.natural_vignetting = vignettes;
    if (!focus_m) {
        setup.focal_mm = view.focal_mm.value_or(0);
        if (vignettes) lens.vignetting = camera::NaturalVignetting();
        setup.camera = std::make_unique<camera::ThinLensCamera>(std::move(lens));
        return setup;
    }
    double focus_mm = 1e3 * double(*focus_m);
    or_argument_error(model, [&] {
        setup.focal_mm = view.focal_mm ? *view.focal_mm
                                       : camera::focal_length_between_mm(
                                             focus_mm, double(*asked.film_distance_mm));
        // Both come as floats: what is the same in their digits is the same.
        if (focus_mm <= setup.focal_mm * (1 + 4 * double(rounding_bound(1))))
            focus_mm = std::fmin(focus_mm, setup.focal_mm);
        setup.film_mm = camera::image_distance_mm(setup.focal_mm, focus_mm);
        setup.lens_radius_m = asked.lens_radius_m ? double(*asked.lens_radius_m)
                                                  : setup.focal_mm * 1e-3 / (2 * *asked.fstop);
        const double radius_mm = 1e3 * setup.lens_radius_m;
        camera::Iris iris(io::parse_aperture(asked.aperture.value_or("circle"), {},
                                             asked.iris_pictures.value_or(io::PictureBudget())),
                          radius_mm, asked.aperture_scale, asked.iris_sampling);
        lens.focus_m = *focus_m;
        if (photographic)
            lens.exposure = static_cast<float>(camera::photographic_gain(
                camera::thin_lens_irradiance(radius_mm, setup.film_mm, iris.area_mm2()),
                double(asked.iso), double(asked.shutter_s)));
        // In photographic exposure the factors average to what the iris lets through in truth, as
        // thin_lens_irradiance() has the mean of a round stop for any shape.
        if (vignettes)
            lens.vignetting = camera::NaturalVignetting(
                setup.film_mm, photographic
                                   ? camera::NaturalVignetting::axial_mean(radius_mm, setup.film_mm)
                                   : camera::NaturalVignetting::axial_mean(iris, setup.film_mm));
        if (const auto* single = std::get_if<SingleLens>(&model.optics)) {
            camera::AberratedLens glass{lens.to_world,   singlet_of(*single, setup.focal_mm),
                                        std::move(iris), double(*focus_m),
                                        lens.yfov_rad,   lens.aspect};
            glass.dispersion = asked.dispersion_by(!model.dispersive_lens().empty());
            glass.exposure = lens.exposure;
            glass.vignetting = lens.vignetting;
            warn_of_formula(glass.singlet, model, focus_mm, glass.iris.bounding_radius_mm(),
                            notice);
            setup.camera = std::make_unique<camera::AberratedLensCamera>(std::move(glass));
        } else {
            lens.iris = std::move(iris);
            setup.camera = std::make_unique<camera::ThinLensCamera>(std::move(lens));
        }
    });
    return setup;
}

}  // namespace petzval::apps
