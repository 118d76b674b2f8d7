// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/lens_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "camera/bench/analysis.h"
#include "camera/bench/lens_scale.h"
#include "camera/lens/focus.h"
#include "camera/lens/paraxial.h"
#include "camera/models/exposure.h"
#include "camera/models/lens_camera.h"
#include "camera/models/sensor.h"
#include "io/aperture/aperture_file.h"
#include "io/base/error.h"

namespace petzval {
namespace {

constexpr float kFullFrameCircle_mm = 43.27f;
constexpr double kDistant_mm = -std::numeric_limits<double>::infinity();

V2f usual_sensor_mm(double image_circle_mm) {
    const float circle = image_circle_mm > 0 ? float(image_circle_mm) : kFullFrameCircle_mm;
    const float unit_mm = std::min(circle / std::sqrt(13.f), 12.f);  // of a 3 x 2 rectangle
    return {3 * unit_mm, 2 * unit_mm};
}

// By the ray through the middle of the stop; a lens that sends none there has its paraxial angle.
float yfov_of(const Lens& lens, float film_height_mm, double focal_length_mm) {
    const double half_mm = 0.5 * double(film_height_mm);
    if (const auto distant = focused(lens, kDistant_mm))
        if (const auto deg = field_of_height_deg(*distant, half_mm, distant->film_mm()))
            return static_cast<float>(2 * *deg * M_PI / 180);
    return static_cast<float>(2 * std::atan(half_mm / focal_length_mm));
}

// So large that a distant scene of that height fills the film.
Lens fitted(const Lens& lens, V2f film_mm, float yfov_rad) {
    const double half_deg = double(yfov_rad) / 2 * 180 / M_PI;
    std::optional<double> factor;
    if (const auto distant = focused(lens, kDistant_mm))
        factor = scale_for_field(*distant, double(film_mm.y) / 2, half_deg, distant->film_mm());
    if (!factor)
        throw ArgumentError("--fit", "",
                            fmt::format("{} does not see {:.4g} degrees: take a smaller --fov or "
                                        "another lens",
                                        lens.prescription().name, 2 * half_deg));
    return Lens(scaled(lens.prescription(), *factor));
}

// A lens in focus, and its entrance pupil, which moves with a group that focuses.
struct Sharp {
    Lens lens;
    double entrance_pupil_mm;
};

// Distances count from the pupil, which moves: a few rounds settle both.
Sharp sharp_at(const LoadedLens& loaded, float focus_m, FocusBy by, double stop_radius_mm) {
    constexpr int kRounds = 50;
    constexpr double kSettled_mm = 1e-6;
    const auto pupil_of = [](const Lens& lens) {
        return first_order(lens, kLineD_nm).entrance_pupil_mm;
    };
    const auto focus = [&](double pupil_mm, FocusBy how) {
        auto lens = focused(loaded.lens, pupil_mm - 1e3 * double(focus_m), how, stop_radius_mm);
        if (!lens)
            throw ArgumentError(
                loaded.name(), "",
                fmt::format("cannot focus at {:g} m; give --focus a greater distance", focus_m));
        return *std::move(lens);
    };
    double pupil_mm = pupil_of(loaded.lens);
    Lens lens = focus(pupil_mm, FocusBy::Paraxial);
    for (int i = 0; i < kRounds && std::fabs(pupil_of(lens) - pupil_mm) > kSettled_mm; ++i) {
        pupil_mm = pupil_of(lens);
        lens = focus(pupil_mm, FocusBy::Paraxial);
    }
    if (by == FocusBy::Traced) lens = focus(pupil_mm, by);
    pupil_mm = pupil_of(lens);
    return {std::move(lens), pupil_mm};
}

// All of a camera but its exposure.
LensCameraInput input_of(const LoadedLens& loaded, const M44f& to_world, Sharp sharp, Iris iris) {
    LensCameraInput in{.lens = std::make_shared<const Lens>(std::move(sharp.lens)),
                       .iris = std::move(iris),
                       .to_world = to_world};
    in.film_mm = in.lens->film_mm();
    in.film_width_mm = loaded.film_mm.x;
    in.film_height_mm = loaded.film_mm.y;
    in.entrance_pupil_mm = sharp.entrance_pupil_mm;
    return in;
}

// What --fstop asks for, as far as the lens opens.
double stop_radius_of(const LoadedLens& loaded, std::optional<float> fstop,
                      const std::function<void(const std::string&)>& notice) {
    const double filed_mm = loaded.stop_radius_mm();
    if (!fstop) return filed_mm;
    const auto wanted_mm = stop_radius_for(loaded.lens, *fstop);
    if (wanted_mm && *wanted_mm <= filed_mm * (1 + 1e-6)) return *wanted_mm;
    notice(fmt::format("warning: {} opens to f/{:.3g} at most, not to f/{:g}", loaded.name(),
                       fnumber_of(loaded.lens, filed_mm), *fstop));
    return filed_mm;
}

}  // namespace

double LoadedLens::stop_radius_mm() const {
    return lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
}

bool LoadedLens::disperses() const {
    const auto& media = lens.media();
    return std::any_of(media.begin(), media.end(), [](const Glass& glass) {
        return glass.index(kLineF_nm) != glass.index(kLineC_nm);
    });
}

LoadedLens load_lens_for_film(const std::string& name_or_file, std::span<const AgfCatalog> catalogs,
                              std::optional<V2f> sensor_mm, float aspect,
                              std::optional<float> fit_yfov_rad) {
    LensFile file = load_lens(name_or_file, catalogs);
    LoadedLens loaded{Lens(std::move(file.lens)), std::move(file.warnings), 0, {}, 0};
    loaded.film_mm = film_within(
        sensor_mm.value_or(usual_sensor_mm(loaded.lens.prescription().image_circle_mm)), aspect);
    if (fit_yfov_rad) loaded.lens = fitted(loaded.lens, loaded.film_mm, *fit_yfov_rad);
    const double circle_mm = loaded.lens.prescription().image_circle_mm;
    if (const auto corners_mm = double(loaded.film_mm.length());
        circle_mm > 0 && corners_mm > circle_mm * 1.001)
        loaded.warnings.push_back(
            fmt::format("{} covers a circle of {:.3g} mm{}; the film's corners are {:.3g} mm apart",
                        loaded.name(), circle_mm,
                        fit_yfov_rad ? " once it is scaled to the angle of view" : "", corners_mm));
    const FirstOrder f = first_order(loaded.lens, kLineD_nm);
    if (!(f.focal_length_mm > 0) || !std::isfinite(f.focal_length_mm))
        throw InputError(name_or_file, "", "has no positive focal length: it forms no image");
    loaded.focal_length_mm = f.focal_length_mm;
    loaded.yfov_rad = yfov_of(loaded.lens, loaded.film_mm.y, loaded.focal_length_mm);
    return loaded;
}

LensSetup set_up_lens(const CameraRequest& asked, const LoadedLens& loaded, const M44f& to_world,
                      float focus_m, int width_px,
                      const std::function<void(const std::string&)>& notice) {
    for (const std::string& warning : loaded.warnings) notice("warning: " + warning);
    LensSetup setup;
    setup.stop_radius_mm = stop_radius_of(loaded, asked.fstop, notice);
    setup.fnumber = fnumber_of(loaded.lens, setup.stop_radius_mm);
    Sharp sharp = sharp_at(loaded, focus_m, asked.focus_by, setup.stop_radius_mm);
    const std::string aperture = asked.aperture.value_or("circle");
    std::unique_ptr<LensCamera> camera;
    try {
        const Iris iris(parse_aperture(aperture), setup.stop_radius_mm, asked.aperture_scale,
                        asked.iris_sampling, loaded.stop_radius_mm());
        if (iris.share_cut() > 5e-4)
            notice(
                fmt::format("aperture {}: {:.1f} % of it lies beyond the stop's rim and is cut "
                            "off",
                            aperture, 100 * iris.share_cut()));
        LensCameraInput in = input_of(loaded, to_world, std::move(sharp), iris);
        setup.film_mm = in.film_mm;
        in.dispersion = asked.dispersion.value_or(DispersionMode::Tolerance);
        in.coating = asked.coating;
        in.precision = asked.precision;
        in.focus_m = focus_m;
        // Seen from the rear principal point, where the film is a distance in focus away.
        const FirstOrder f = first_order(*in.lens, kLineD_nm);
        const double from_mm = in.lens->vertex_mm(in.lens->last()) + f.rear_principal_mm;
        in.tolerance_rad =
            static_cast<float>(asked.dispersion_tolerance_px * double(loaded.film_mm.x) / width_px /
                               (in.film_mm - from_mm));
        camera = std::make_unique<LensCamera>(std::move(in));
    } catch (const std::invalid_argument& error) {
        throw ArgumentError(aperture, "", error.what());
    }
    const double axial = camera->irradiance(V2f(0.f), 1024);
    if (!(axial > 0))
        throw ArgumentError(loaded.name(), "", "lets no light through to the middle of the film");
    const bool normalised = asked.exposure == ExposureMode::Normalised;
    camera->set_exposure(
        normalised ? 1 : photographic_gain(axial, double(asked.iso), double(asked.shutter_s)),
        axial);
    setup.camera = std::move(camera);
    return setup;
}

std::unique_ptr<Camera> viewfinder(const LoadedLens& loaded, const M44f& to_world,
                                   std::optional<float> focus_m) {
    constexpr double kStoppedDown = 100;
    constexpr float kFar_m = 1e9f;
    Sharp sharp = sharp_at(loaded, focus_m.value_or(kFar_m), FocusBy::Paraxial, 0);
    return std::make_unique<LensCamera>(input_of(
        loaded, to_world, std::move(sharp), Iris(Disk{}, loaded.stop_radius_mm() / kStoppedDown)));
}

}  // namespace petzval
