// SPDX-License-Identifier: Apache-2.0
#include "io/lens_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera/lens_focus.h"
#include "camera/paraxial.h"
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

bool LoadedLens::disperses() const {
    const auto& surfaces = file.lens.surfaces;
    return std::any_of(surfaces.begin(), surfaces.end(), [](const LensSurface& s) {
        return s.glass && s.glass->index(kLineF_nm) != s.glass->index(kLineC_nm);
    });
}

LoadedLens load_lens_for_film(const std::string& name_or_file, std::optional<V2f> sensor_mm,
                              float aspect) {
    LoadedLens loaded{load_lens(name_or_file), 0, 0, {}};
    const FirstOrder f = first_order(Lens(loaded.file.lens), kLineD_nm);
    if (!(f.focal_length_mm > 0) || !std::isfinite(f.focal_length_mm))
        throw InputError(name_or_file, "", "has no positive focal length: it forms no image");
    loaded.focal_length_mm = f.focal_length_mm;
    loaded.entrance_pupil_mm = f.entrance_pupil_mm;
    const V2f full = sensor_mm ? *sensor_mm : usual_sensor_mm(loaded.file.lens.image_circle_mm);
    loaded.film_mm =
        full.x / full.y > aspect ? V2f(full.y * aspect, full.y) : V2f(full.x, full.x / aspect);
    return loaded;
}

LensSetup set_up_lens(const LensCameraRequest& request, const LoadedLens& loaded,
                      const M44f& to_world, float focus_m, std::optional<float> fstop, int width_px,
                      const std::function<void(const std::string&)>& notice) {
    for (const std::string& warning : loaded.file.warnings) notice("warning: " + warning);
    const Lens filed(loaded.file.lens);
    const auto sharp = focused(loaded.file.lens, loaded.entrance_pupil_mm - 1e3 * double(focus_m));
    if (!sharp)
        throw ArgumentError(
            request.lens, "",
            fmt::format("cannot focus at {:g} m; give --focus a greater distance", focus_m));
    auto lens = std::make_shared<const Lens>(*sharp);
    double stop_mm = loaded.file.lens.surfaces[size_t(filed.stop())].semi_diameter_mm;
    if (fstop) {
        const auto wanted = stop_radius_for(filed, *fstop);
        if (wanted && *wanted <= stop_mm * (1 + 1e-6))
            stop_mm = *wanted;
        else
            notice(fmt::format("warning: {} opens to f/{:.3g} at most, not to f/{:g}",
                               loaded.file.lens.name, fnumber_of(filed, stop_mm), *fstop));
    }
    try {
        const Iris iris(parse_aperture(request.aperture), stop_mm, request.aperture_scale,
                        request.iris_sampling);
        LensCameraInput in{.lens = lens, .iris = iris, .to_world = to_world};
        in.film_mm = lens->film_mm();
        in.film_width_mm = loaded.film_mm.x;
        in.film_height_mm = loaded.film_mm.y;
        in.entrance_pupil_mm = loaded.entrance_pupil_mm;
        in.focus_m = focus_m;
        in.tolerance_rad = static_cast<float>(request.chroma_tolerance_px * loaded.film_mm.x /
                                              width_px / loaded.focal_length_mm);
        in.chroma = Chroma::Shared;
        const double axial = axial_irradiance(LensCamera(in));
        in.chroma = request.chroma;
        if (!(axial > 0))
            throw ArgumentError(request.lens, "",
                                "lets no light through to the middle of the film");
        const double clear_mm = loaded.file.lens.surfaces[size_t(filed.stop())].semi_diameter_mm;
        if (const double lost = iris.share_beyond(clear_mm); lost > 5e-4)
            notice(
                fmt::format("aperture {}: {:.1f} % of it lies beyond the stop's rim and is cut "
                            "off",
                            request.aperture, 100 * lost));
        in.gain = 1 / axial;
        LensSetup setup;
        setup.film_mm = in.film_mm;
        setup.stop_radius_mm = stop_mm;
        setup.fnumber = fnumber_of(filed, stop_mm);
        setup.camera = std::make_unique<LensCamera>(std::move(in));
        return setup;
    } catch (const std::invalid_argument& error) {
        throw ArgumentError(request.aperture, "", error.what());
    }
}

}  // namespace petzval
