// SPDX-License-Identifier: Apache-2.0
// Cross-sections of lenses, as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "camera/lens/lens.h"
#include "camera/lens/profile.h"

namespace petzval::io {

/// A ray of a drawing.
struct SvgRay {
    camera::Outline path;  ///< {z, height}, mm
    std::string colour;    ///< as SVG names it, #2060d0 say
};

struct LensDrawing {
    camera::Section section = camera::Section::Y;
    double film_mm = 0;         ///< from the first vertex
    double film_radius_mm = 0;  ///< half of the height that is drawn
    std::vector<SvgRay> rays;
    std::string caption;  ///< one line below
};

/// SVG of a lens's cross-section: glass, stop, film, axis and rays, z to the right, in the same
/// scale both ways; a millimetre is a unit of the SVG's viewBox. Every face, the stop and the film
/// have an id: face0, stop, film.
[[nodiscard]] std::string lens_svg(const camera::Lens&, const LensDrawing&);

/// Checks early that a drawing can be written. Throws InputError where the name does not end in
/// .svg or cannot be written.
void check_drawing(const std::filesystem::path&);
/// Writes the SVG of lens_svg(). Throws InputError where the file cannot be written.
void write_drawing(const std::filesystem::path&, const camera::Lens&, const LensDrawing&);

}  // namespace petzval::io
