// SPDX-License-Identifier: Apache-2.0
// Rays and pattern: an image made of a spot of rays and the diffraction pattern of a pupil without
// aberrations, against the image by waves.
#pragma once

#include <optional>
#include <span>

#include "camera/waves/pupil_function.h"

namespace petzval::camera {

/// How far the contrast of an image in which each ray is spread by the pattern of its pupil without
/// aberrations is from that by waves. It is near where the wave has hardly an error, and where the
/// spot is so wide that waves add up to rays.
struct RaysAndPattern {
    /// Largest difference of the two, and where it is.
    double contrast_error = 0;
    double cycles_per_mm = 0;
    Section along = Section::Y;
    double by_waves = 1, by_rays_and_pattern = 1;  ///< contrast there
    /// Largest difference from the image by waves of rays alone, and of the pattern alone, about
    /// the middle of each bundle's spot.
    double error_of_rays = 0, error_of_pattern = 0;
    /// RMS of the wave, mean and tilt taken out, in wavelengths: of the worst of the bundles.
    double rms_waves = 0;
    /// Twice the RMS radius of the spot, over wavelength and f-number: of the smallest spot.
    double blur = 0;
    bool sharp_or_wide = true;  ///< each bundle is, as sharp_or_wide() has it
};

/// Whether a wave's RMS is below a tenth of a wavelength or the blur of its spot above 4
/// wavelengths times f-number: a rule of thumb. docs/measured/waves.md says where it fails.
[[nodiscard]] bool sharp_or_wide(double rms_waves, double blur);

/// Errors of a point's image on a film, in both sections, up to a frequency above 0. Bundles: of
/// that point, one for each wavelength, with weights that add up to 1. At least one frequency is
/// looked at, 7 cycles per mm at f/1, 0.8 at f/8; at most 20. Of an iris, rays pass where it
/// transmits half. Differences below 0.01 are partly those of rays' and cells' finite numbers.
/// Nothing where a bundle sends no light, or parallel rays.
[[nodiscard]] std::optional<RaysAndPattern> rays_and_pattern(std::span<const AimedBundle>,
                                                             std::span<const double> weights,
                                                             double film_mm,
                                                             double most_cycles_per_mm,
                                                             const StopTransmission& iris = {});

/// The worst of some fields of a lens.
struct DiffractionLimits {
    double field_deg = 0;
    RaysAndPattern worst;
    bool sharp_or_wide = true;  ///< all fields are
};
/// Wavelength and its weight in an image.
struct WeighedWavelength {
    double nm, weight;  ///< weights add up to 1
};
/// The worst of fields, degrees from the axis towards +y, that send light to a film; distance_mm:
/// of the object, as ObjectPoint has it. Nothing where none does. Some 0.1 s of CPU time for a
/// field of three wavelengths.
[[nodiscard]] std::optional<DiffractionLimits> diffraction_limits(
    const Lens&, double film_mm, double distance_mm, std::span<const double> fields_deg,
    std::span<const WeighedWavelength>, double most_cycles_per_mm,
    const StopTransmission& iris = {});

}  // namespace petzval::camera
