// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/lens_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera/lens/blockage.h"
#include "camera/lens/focus.h"
#include "camera/lens/paraxial.h"
#include "camera/models/lens_camera.h"
#include "camera/setup/angle_of_view.h"
#include "camera/setup/exposure.h"
#include "camera/setup/focused_lens.h"
#include "camera/setup/sensor.h"
#include "io/aperture/aperture_file.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

camera::FocusedLens focused_at(const LoadedLens& loaded, float focus_m, camera::FocusBy by,
                               double stop_radius_mm) {
    auto sharp = camera::focused_from_pupil(loaded.lens, 1e3 * double(focus_m), by, stop_radius_mm);
    if (!sharp)
        throw io::ArgumentError(loaded.name(), "",
                                "cannot focus at {:g} m; give ⟨focus⟩ a greater distance", focus_m);
    return *std::move(sharp);
}

// Input of a lens camera: lens, iris, pose and film.
camera::LensCameraInput input_of(const LoadedLens& loaded, const M44f& to_world,
                                 camera::FocusedLens sharp, camera::Iris iris) {
    camera::LensCameraInput in{.lens = std::make_shared<const camera::Lens>(std::move(sharp.lens)),
                               .iris = std::move(iris),
                               .to_world = to_world};
    in.film_mm = in.lens->film_mm();
    in.film_width_mm = loaded.film_mm.x;
    in.film_height_mm = loaded.film_mm.y;
    in.entrance_pupil_mm = sharp.entrance_pupil_mm;
    return in;
}

// Stop radius for --fstop, as far as the lens opens.
double stop_radius_of(const LoadedLens& loaded, std::optional<float> fstop,
                      const io::Notice& notice) {
    const double filed_mm = loaded.stop_radius_mm();
    if (!fstop) return filed_mm;
    const auto wanted_mm = camera::stop_radius_for(loaded.lens, *fstop);
    if (wanted_mm && *wanted_mm <= filed_mm * (1 + 1e-6)) return *wanted_mm;
    notice(fmt::format("warning: {} opens to f/{:.3g} at most, not to f/{:g}: an f-number is {}",
                       loaded.name(), camera::fnumber_of(loaded.lens, filed_mm), *fstop,
                       camera::kTracedFnumber));
    return filed_mm;
}

// Refuses a lens that passes next to nothing of what its pupil promises, or no ray from afar: then
// its f-number is infinite.
void require_light(const std::string& name, const camera::Lens& lens, double axial, double promised,
                   double fnumber) {
    constexpr double kLeastShare = 0.01;
    const auto blockage = camera::find_blockage(lens);
    const bool is_dim = blockage && axial < kLeastShare * promised;
    if (axial > 0 && !is_dim && std::isfinite(fnumber)) return;
    throw io::ArgumentError(name, "",
                            "lets no light through to the middle of the film" +
                                (blockage ? ": " + blockage->text() : std::string()));
}

// Tells where a lens lights next to nothing of the film: its picture would be black without a word.
void tell_dark_film(const std::string& name, const camera::LensCamera& camera, V2f film_mm,
                    const io::Notice& notice) {
    constexpr int kAcross = 8;
    constexpr double kLeastLit = 0.1;
    int lit = 0;
    for (int i = 0; i < kAcross * kAcross; ++i) {
        const V2f cell(static_cast<float>(i % kAcross), static_cast<float>(i / kAcross));
        const V2f at = (cell + V2f(0.5f)) / float(kAcross) - V2f(0.5f);
        lit += camera.irradiance(at * film_mm, 4) > 0;
    }
    const double share = double(lit) / (kAcross * kAcross);
    if (share < kLeastLit)
        notice(fmt::format(
            "warning: {} lights {} of the film, which is {:.4g} x {:.4g} mm; give a "
            "smaller ⟨sensor⟩",
            name, lit ? fmt::format("{:.0f} %", 100 * share) : "hardly any", film_mm.x, film_mm.y));
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

LoadedLens load_lens_for_film(const std::string& name_or_file,
                              std::span<const io::AgfCatalog> catalogs,
                              std::optional<V2f> sensor_mm, float aspect,
                              std::optional<float> fit_yfov_rad) {
    io::LensFile file = io::load_lens(name_or_file, catalogs);
    LoadedLens loaded{camera::Lens(std::move(file.lens)), std::move(file.warnings), 0, {}, 0};
    loaded.film_mm = camera::film_within(
        sensor_mm.value_or(camera::usual_sensor_mm(loaded.lens.prescription().image_circle_mm)),
        aspect);
    if (fit_yfov_rad) {
        auto fitted = camera::scaled_to_view(loaded.lens, loaded.film_mm.y, *fit_yfov_rad);
        if (!fitted)
            throw io::ArgumentError("⟨fit⟩", "",
                                    "{} does not see {:.4g} degrees: take a smaller ⟨fov⟩ "
                                    "or another lens",
                                    loaded.name(), double(*fit_yfov_rad) * 180 / kPi);
        loaded.lens = *std::move(fitted);
    }
    const double circle_mm = loaded.lens.prescription().image_circle_mm;
    if (const auto corners_mm = double(loaded.film_mm.length());
        circle_mm > 0 && corners_mm > circle_mm * 1.001)
        loaded.warnings.push_back(
            fmt::format("{} covers a circle of {:.3g} mm{}; the film's corners are {:.3g} mm apart",
                        loaded.name(), circle_mm,
                        fit_yfov_rad ? " once it is scaled to the angle of view" : "", corners_mm));
    const camera::FirstOrder f = camera::first_order(loaded.lens, kLineD_nm);
    if (!(f.focal_length_mm > 0) || !std::isfinite(f.focal_length_mm))
        throw io::InputError(name_or_file, "", "has no positive focal length: it forms no image");
    loaded.focal_length_mm = f.focal_length_mm;
    loaded.yfov_rad =
        camera::angle_of_view_rad(loaded.lens, loaded.film_mm.y, loaded.focal_length_mm);
    return loaded;
}

LensSetup set_up_lens(const CameraRequest& asked, const LoadedLens& loaded, const M44f& to_world,
                      float focus_m, const io::Notice& notice) {
    for (const std::string& warning : loaded.warnings) notice("warning: " + warning);
    LensSetup setup;
    if (asked.coating == camera::Coating::Year && loaded.lens.prescription().year == 0)
        throw io::ArgumentError(loaded.name(), "",
                                "its file states no year, by which ⟨coating⟩=year goes: give "
                                "⟨coating⟩=filed or another");
    setup.stop_radius_mm = stop_radius_of(loaded, asked.fstop, notice);
    setup.fnumber = camera::fnumber_of(loaded.lens, setup.stop_radius_mm);
    camera::FocusedLens sharp = focused_at(loaded, focus_m, asked.focus_by, setup.stop_radius_mm);
    const std::string aperture = asked.aperture.value_or("circle");
    std::unique_ptr<camera::LensCamera> camera;
    std::shared_ptr<const camera::Lens> lens;
    double promised = 0;
    try {
        const camera::Iris iris(
            io::parse_aperture(aperture, {}, asked.iris_pictures.value_or(io::PictureBudget())),
            setup.stop_radius_mm, asked.aperture_scale, asked.iris_sampling,
            loaded.stop_radius_mm());
        if (iris.share_cut() > 5e-4)
            notice(
                fmt::format("aperture {}: {:.1f} % of it lies beyond the stop's rim and is cut off",
                            aperture, 100 * iris.share_cut()));
        camera::LensCameraInput in = input_of(loaded, to_world, std::move(sharp), iris);
        setup.film_mm = in.film_mm;
        lens = in.lens;
        promised = camera::paraxial_irradiance(*lens, iris.area_mm2());
        in.dispersion = asked.dispersion_by(loaded.disperses());
        in.coating = asked.coating;
        in.precision = asked.precision;
        camera = std::make_unique<camera::LensCamera>(std::move(in));
    } catch (const std::invalid_argument& error) {
        throw io::ArgumentError(aperture, "", error.what());
    }
    const double axial = camera->irradiance(V2f(0.f), 1024);
    require_light(loaded.name(), *lens, axial, promised, setup.fnumber);
    tell_dark_film(loaded.name(), *camera, loaded.film_mm, notice);
    const bool normalised = asked.exposure == ExposureMode::Normalised;
    camera->set_exposure(
        normalised ? 1
                   : camera::photographic_gain(axial, double(asked.iso), double(asked.shutter_s)),
        axial);
    setup.camera = std::move(camera);
    return setup;
}

std::unique_ptr<camera::Camera> viewfinder(const LoadedLens& loaded, const M44f& to_world,
                                           std::optional<float> focus_m) {
    constexpr double kStoppedDown = 100;
    camera::FocusedLens sharp =
        focused_at(loaded, focus_m.value_or(kFarthestFocus_m), camera::FocusBy::Paraxial, 0);
    return std::make_unique<camera::LensCamera>(
        input_of(loaded, to_world, std::move(sharp),
                 camera::Iris(camera::Disk{}, loaded.stop_radius_mm() / kStoppedDown)));
}

}  // namespace petzval::apps
