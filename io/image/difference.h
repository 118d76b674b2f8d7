// SPDX-License-Identifier: Apache-2.0
// Differences between two pictures: symmetric MSE, RMSE, relative MSE, PSNR, layer by layer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// Added to the square of the reference in relative_mse, so that black does not divide by zero:
/// Rousselle et al. 2011, "Adaptive Sampling and Reconstruction using Greedy Error Minimization",
/// section 5.
inline constexpr double kRelativeMseEpsilon = 0.01;

/// Differences in one layer: "RGB", "A", or the name before the last point in the names of its
/// channels; the error of a layer is a layer of its own. So is each channel of a layer of which a
/// picture has only a part. Values that are not finite in either
/// picture are counted and left out of everything else.
struct LayerDifference {
    std::string layer;
    uint64_t value_count = 0;  ///< compared: pixels times channels
    uint64_t not_finite = 0;   ///< left out
    /// Mean of symmetric_square() with floor_against(b); nothing for layers without such a floor.
    std::optional<double> symmetric_mse;
    double rmse = 0.;          ///< root of the mean of (a - b)^2
    double relative_mse = 0.;  ///< mean of (a - b)^2 / (b^2 + kRelativeMseEpsilon)
    double peak = 0.;          ///< largest absolute value of b
    double psnr_db = 0.;       ///< 20 log10(peak / rmse); infinite where rmse is 0
    double max_abs = 0.;       ///< largest absolute difference,
    std::string max_channel;   ///< in this channel ("" where max_abs is 0)
    int max_x = 0, max_y = 0;  ///< of this pixel of the full frame
};

/// Floor of the symmetric MSE against a reference, from the luminances of its finite pixels.
/// Nothing where it has neither R, G and B nor Y, or holds values for a display.
[[nodiscard]] std::optional<double> floor_against(const Picture& reference);

/// Reason why two pictures cannot be compared (size, crop, light or display values, wavelengths, no
/// channel in both), where a is called the former, b the latter; empty where they can.
[[nodiscard]] std::string why_not_comparable(const Picture& a, const Picture& b);
/// Names of the channels that only one of two pictures has; empty where both have the same.
[[nodiscard]] std::string channels_of_one(const Picture& a, const Picture& b);
/// Differences of a from the reference b, layer by layer in b's order, by the channels that both
/// have. The pictures must be comparable; the order of the channels may differ.
[[nodiscard]] std::vector<LayerDifference> compare(const Picture& a, const Picture& b);

/// What compare_files() finds.
struct FileDifferences {
    std::vector<LayerDifference> layers;
    std::string channels_of_one;  ///< those that are not compared
};
/// Differences between two picture files. Throws InputError where they cannot be read or compared.
[[nodiscard]] FileDifferences compare_files(const std::filesystem::path& a,
                                            const std::filesystem::path& b,
                                            PictureBudget = PictureBudget());

}  // namespace petzval::io
