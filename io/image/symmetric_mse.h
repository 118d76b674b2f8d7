// SPDX-License-Identifier: Apache-2.0
// Symmetric MSE: the measure of errors of plans and charts.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval {

/// Floor of the symmetric MSE as a share of a picture's mid-grey: two stops below it lies the
/// darkest tone that shows texture (zone III: Adams 1981, "The Negative", chapter 4).
inline constexpr double kSymmetricFloorShare = 0.25;

/// Squared relative difference of two values, (a - b)^2 / ((a^2 + b^2) / 2 + floor^2): 0 to 2 where
/// neither is negative, the same for light that is lost and light that is added. The symmetric MSE
/// of two pictures is its mean over pixels and R, G and B. floor: floor_of_symmetric_mse().
[[nodiscard]] inline double symmetric_square(double a, double b, double floor) {
    const double d = a - b, scale = (a * a + b * b) / 2 + floor * floor;
    return scale > 0 ? d * d / scale : 0;
}

/// Most that the symmetric MSE of light can be. Colours beyond sRGB have negative values, whose own
/// square can reach twice that.
inline constexpr double kMostSymmetricMse = 2;

/// What is known of how bright a picture is.
struct Tone {
    double log_average = 0;  ///< of luminances; 0: there is no light
    /// Luminance that a display shows as 0.18, the grey in the middle between black and white; 0:
    /// there is no light.
    double mid_grey = 0;
};

/// Tone of a picture, from the luminances of its pixels. Those of 0 do not count. Mid-grey is the
/// log-average (Reinhard et al. 2002, "Photographic tone reproduction for digital images",
/// equations 1 and 2), or more where more than a tenth would be brighter than white. What is darker
/// than a hundredth of nearly the brightest counts as that.
[[nodiscard]] Tone tone_of(std::vector<double> luminances);

/// Floor of the symmetric MSE for a picture with this tone.
[[nodiscard]] inline double floor_of_symmetric_mse(const Tone& tone) {
    return kSymmetricFloorShare * tone.mid_grey;
}

}  // namespace petzval
