// SPDX-License-Identifier: Apache-2.0
// Errors of models that a pilot has rendered, as symmetric MSE (io/image/symmetric_mse.h): how far
// a model is off without noise, and how noisy it is.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "apps/plan/pilot.h"

namespace petzval::apps {

/// A model that counts `factor` times in a difference.
struct PilotTerm {
    const PilotModel* model;
    double factor;
};

/// The two pictures whose mean square scales an error.
struct PilotScale {
    const PilotModel *a, *b;
    double floor;
    /// Least mean of each pilot pixel, where it is known from others that the samples of one pixel
    /// are too few to find its light; empty: none is.
    std::vector<V3d> least{};
};

/// Mean luminance of a picture, as the pilot sees it.
[[nodiscard]] double mean_luminance(const Pilot&, const PilotModel&);

/// Floor of the symmetric MSE, from what the pilot sees of a picture. least: as in PilotScale; what
/// a pilot pixel shows by chance does not count where it is above 0.
[[nodiscard]] double pilot_floor(const Pilot&, const PilotModel&,
                                 const std::vector<V3d>& least = {});

/// Symmetric MSE of what the terms add up to with endless samples. Unbiased but for third orders of
/// the noise, so it may be negative: only products of different replicates count, and the others
/// give the scale. All must have as many samples.
[[nodiscard]] Estimate square_error(const Pilot&, const std::vector<PilotTerm>&, const PilotScale&);

/// Symmetric variance of a model.
struct PilotNoise {
    /// Of the mean of 1, 2, 4, ... samples: well spread points make them fall faster than in
    /// proportion.
    std::vector<Estimate> variances;
    /// Number of equal parts that would spread the last of them as unevenly: replicates of pixels
    /// that hold it. (sum of v)^2 / sum of v^2: Kish 1965, "Survey Sampling", section 11.7.
    double parts = 0;
    /// Contributions of the pilot pixels to the last of them, each no more than a pixel can be off,
    /// in blocks that a hash spreads over the frame.
    std::array<double, 16> blocks{};
};
/// Median over the blocks of the noise of one over that of the other: a few bright samples, which
/// lie in few blocks, do not turn it. Nothing where hardly a block has noise of both.
[[nodiscard]] std::optional<double> typical_ratio(const PilotNoise&, const PilotNoise& other);
[[nodiscard]] PilotNoise noise_of(const Pilot&, const PilotModel&, const PilotScale&);

}  // namespace petzval::apps
