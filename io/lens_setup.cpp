// SPDX-License-Identifier: Apache-2.0
#include "io/lens_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera/lens_focus.h"
#include "camera/paraxial.h"
#include "camera/sensor.h"
#include "io/aperture_file.h"
#include "io/error.h"

namespace petzval {
namespace {

constexpr float kFullFrameCircle_mm = 43.27f;

V2f usual_sensor_mm(double image_circle_mm) {
    const float circle = image_circle_mm > 0 ? float(image_circle_mm) : kFullFrameCircle_mm;
    const float unit_mm = std::min(circle / std::sqrt(13.f), 12.f);  // of a 3 x 2 rectangle
    return {3 * unit_mm, 2 * unit_mm};
}

}  // namespace

float LoadedLens::yfov_rad() const {
    return 2 * std::atan(film_mm.y / 2 / static_cast<float>(focal_length_mm));
}

double LoadedLens::stop_radius_mm() const {
    return lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
}

bool LoadedLens::disperses() const {
    const auto& media = lens.media();
    return std::any_of(media.begin(), media.end(), [](const Glass& glass) {
        return glass.index(kLineF_nm) != glass.index(kLineC_nm);
    });
}

LoadedLens load_lens_for_film(const std::string& name_or_file, std::optional<V2f> sensor_mm,
                              float aspect) {
    LensFile file = load_lens(name_or_file);
    LoadedLens loaded{Lens(std::move(file.lens)), std::move(file.warnings), 0, 0, {}};
    const FirstOrder f = first_order(loaded.lens, kLineD_nm);
    if (!(f.focal_length_mm > 0) || !std::isfinite(f.focal_length_mm))
        throw InputError(name_or_file, "", "has no positive focal length: it forms no image");
    loaded.focal_length_mm = f.focal_length_mm;
    loaded.entrance_pupil_mm = f.entrance_pupil_mm;
    loaded.film_mm = film_within(
        sensor_mm.value_or(usual_sensor_mm(loaded.lens.prescription().image_circle_mm)), aspect);
    return loaded;
}

LensSetup set_up_lens(const LensCameraRequest& request, const LoadedLens& loaded,
                      const M44f& to_world, float focus_m, std::optional<float> fstop, int width_px,
                      const std::function<void(const std::string&)>& notice) {
    for (const std::string& warning : loaded.warnings) notice("warning: " + warning);
    auto sharp = focused(loaded.lens, loaded.entrance_pupil_mm - 1e3 * double(focus_m));
    if (!sharp)
        throw ArgumentError(
            request.lens, "",
            fmt::format("cannot focus at {:g} m; give --focus a greater distance", focus_m));
    LensSetup setup;
    setup.stop_radius_mm = loaded.stop_radius_mm();
    if (fstop) {
        const auto wanted = stop_radius_for(loaded.lens, *fstop);
        if (wanted && *wanted <= setup.stop_radius_mm * (1 + 1e-6))
            setup.stop_radius_mm = *wanted;
        else
            notice(fmt::format("warning: {} opens to f/{:.3g} at most, not to f/{:g}",
                               loaded.name(), fnumber_of(loaded.lens, setup.stop_radius_mm),
                               *fstop));
    }
    setup.fnumber = fnumber_of(loaded.lens, setup.stop_radius_mm);
    try {
        const Iris iris(parse_aperture(request.aperture), setup.stop_radius_mm,
                        request.aperture_scale, request.iris_sampling);
        if (const double lost = iris.share_beyond(loaded.stop_radius_mm()); lost > 5e-4)
            notice(
                fmt::format("aperture {}: {:.1f} % of it lies beyond the stop's rim and is cut "
                            "off",
                            request.aperture, 100 * lost));
        LensCameraInput in{.lens = std::make_shared<const Lens>(*std::move(sharp)),
                           .iris = iris,
                           .to_world = to_world};
        in.film_mm = setup.film_mm = in.lens->film_mm();
        in.film_width_mm = loaded.film_mm.x;
        in.film_height_mm = loaded.film_mm.y;
        in.entrance_pupil_mm = loaded.entrance_pupil_mm;
        in.chroma = request.chroma;
        in.focus_m = focus_m;
        in.tolerance_rad = static_cast<float>(request.chroma_tolerance_px * loaded.film_mm.x /
                                              width_px / loaded.focal_length_mm);
        setup.camera = std::make_unique<LensCamera>(std::move(in));
    } catch (const std::invalid_argument& error) {
        throw ArgumentError(request.aperture, "", error.what());
    }
    const double axial = setup.camera->irradiance(V2f(0.f), 64);
    if (!(axial > 0))
        throw ArgumentError(request.lens, "", "lets no light through to the middle of the film");
    setup.camera->set_gain(1 / axial);
    return setup;
}

}  // namespace petzval
