// SPDX-License-Identifier: Apache-2.0
// Spots, the images of points: their size, and the contrast (MTF) that they leave.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "camera/bench/aimed_bundle.h"

namespace petzval::camera {

struct SpotSize {
    std::array<double, 2> centroid_mm{};
    double rms_mm = 0;  ///< root of the mean square distance from the centroid
};
/// Spot size in a plane shift_mm behind the one that the rays were traced to. At least one ray.
[[nodiscard]] SpotSize spot_size(std::span<const BundleRay>, double shift_mm = 0);

/// Best focus: shift to the plane of the smallest spot; 0 where all rays are parallel.
[[nodiscard]] double best_shift_mm(std::span<const BundleRay>);

/// Fourier transform of a spot along one axis of the film, about the film's middle: its modulus is
/// the contrast that it leaves of a sine grating whose lines lie across `along`. Geometric: without
/// diffraction, which alone would leave about 1 - 1.27 nm 1e-6 fnumber cycles_per_mm. Williams and
/// Becklund 1989, Introduction to the Optical Transfer Function, ch. 5. At least one ray.
[[nodiscard]] std::complex<double> geometric_transfer(std::span<const BundleRay>,
                                                      double cycles_per_mm, Section along);
/// Its modulus.
[[nodiscard]] double geometric_mtf(std::span<const BundleRay>, double cycles_per_mm, Section along);

/// Transverse aberration of one ray of a line across the aperture.
struct FanPoint {
    double stop;                    ///< position of the ray in the stop, in its radii
    std::array<double, 2> from_mm;  ///< x, y on the film from a point
};
/// Ray fan: rays on a line through the middle of the aperture, `along` the section or across it;
/// only those that pass. from_mm: on the film, usually where the chief ray of the main wavelength
/// arrives.
[[nodiscard]] std::vector<FanPoint> ray_fan(const Lens&, const AimedBundle&, Section along,
                                            double film_mm, std::array<double, 2> from_mm,
                                            int count = 65);

}  // namespace petzval::camera
