// SPDX-License-Identifier: Apache-2.0
// Symmetric MSE: the measure of errors of plans and charts.
#pragma once

#include <cmath>

namespace petzval::io {

/// Squared relative difference of two values, (a - b)^2 / ((a^2 + b^2) / 2 + floor^2): 0 to 2 where
/// neither is negative, the same for light that is lost and light that is added. The symmetric MSE
/// of two pictures is its mean over pixels and R, G and B. floor: SymmetricFloor's, of the
/// reference.
[[nodiscard]] inline double symmetric_square(double a, double b, double floor) {
    const double d = a - b, scale = (a * a + b * b) / 2 + floor * floor;
    return scale > 0 ? d * d / scale : 0;
}

/// Most that the symmetric MSE of light can be. Colours beyond sRGB have negative values, whose own
/// square can reach twice that.
inline constexpr double kMostSymmetricMse = 2;

/// Floor of the symmetric MSE as a share of a picture's mid-grey: two stops below it lies the
/// darkest tone that shows texture (zone III: Adams 1981, "The Negative", chapter 4).
inline constexpr double kSymmetricFloorShare = 0.25;

/// Floor of the symmetric MSE for a picture, a quarter of its mid-grey: below it differences matter
/// less. Mid-grey is the log-average of the luminance (Reinhard et al. 2002, "Photographic tone
/// reproduction for digital images", equation 1), where each pixel counts by its lightness, the
/// cube root of its luminance (CIE 1976): black pixels do not count, and the traces of light that
/// more samples find in them change nothing.
class SymmetricFloor {
  public:
    /// Adds a pixel's luminance. weight: how many pixels it stands for.
    void add(double luminance, double weight = 1) {
        if (!(luminance > 0) || !std::isfinite(luminance)) return;
        const double lightness = weight * std::cbrt(luminance);
        lightness_ += lightness;
        logs_ += lightness * std::log(luminance);
    }
    /// 0 for a picture without light.
    [[nodiscard]] double floor() const {
        return lightness_ > 0 ? kSymmetricFloorShare * std::exp(logs_ / lightness_) : 0;
    }

  private:
    double lightness_ = 0, logs_ = 0;
};

}  // namespace petzval::io
