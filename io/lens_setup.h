// SPDX-License-Identifier: Apache-2.0
// From a lens's name to a camera: film, iris, focus and exposure.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "camera/lens_camera.h"
#include "io/lens_file.h"

namespace petzval {

struct LensCameraRequest {
    std::string lens;  ///< a name in assets/lenses, or a file
    std::string aperture = "circle";
    ApertureScale aperture_scale = ApertureScale::EqualArea;
    std::optional<IrisSampling> iris_sampling;
    Chroma chroma = Chroma::Auto;
    float chroma_tolerance_px = 0.1f;
};

/// A lens that is not yet focused.
struct LoadedLens {
    Lens lens;  ///< as filed
    std::vector<std::string> warnings;
    double focal_length_mm, entrance_pupil_mm;
    V2f film_mm;  ///< width and height, of the picture's aspect

    [[nodiscard]] const std::string& name() const { return lens.prescription().name; }
    [[nodiscard]] double stop_radius_mm() const;
    [[nodiscard]] float yfov_rad() const;
    [[nodiscard]] bool disperses() const;
};

/// sensor_mm: absent for the largest 3:2 rectangle in the image circle, at most 36 x 24. The film
/// is the largest rectangle of the picture's aspect in it. Throws InputError.
[[nodiscard]] LoadedLens load_lens_for_film(const std::string& name_or_file,
                                            std::optional<V2f> sensor_mm, float aspect);

struct LensSetup {
    std::unique_ptr<LensCamera> camera;
    double film_mm, stop_radius_mm, fnumber;  ///< fnumber: of the axial ray at the rim
};

/// focus_m: along the axis from the middle of the entrance pupil. fstop: absent for the stop as it
/// is filed. Throws InputError or ArgumentError: a focus nearer than the lens can, an iris that is
/// none.
[[nodiscard]] LensSetup set_up_lens(const LensCameraRequest&, const LoadedLens&,
                                    const M44f& to_world, float focus_m, std::optional<float> fstop,
                                    int width_px,
                                    const std::function<void(const std::string&)>& notice);

}  // namespace petzval
