// SPDX-License-Identifier: Apache-2.0
// The cheapest way to render a scene that stays within a tolerance, and why. Errors are roots of
// the relative MSE of R, G and B, mean of (a - b)^2 / (b^2 + 0.01), against the fullest model:
// wavelengths, one ray for each.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/plan/pilot.h"
#include "apps/setup/render_setup.h"
#include "integrator/executor.h"
#include "integrator/path_options.h"
#include "integrator/render_job.h"

namespace petzval {

inline constexpr double kUsualTolerance = 0.01;
/// Of the squared tolerance, what a simpler model may err; the rest is for noise.
inline constexpr double kBiasShare = 0.5;

struct PlanRequest {
    SceneRequest scene;
    RenderJob job;  ///< sampler and filter count: samples and seed do not, nor does a crop
    PathOptions path;
    double tolerance = kUsualTolerance;  ///< above 0
};

/// A model that is simpler than the fullest.
struct PlanCandidate {
    std::string name;
    SceneRequest scene;  ///< nothing in it is left open
    Estimate square_bias{};
    bool inside = false;   ///< surely within its share of the tolerance
    bool outside = false;  ///< surely beyond it
    double rays = 0;       ///< of a sample, as PilotModel counts them
    /// Variances of the mean of 1, 2, 4, ... samples: well spread points make them fall faster than
    /// in proportion.
    std::vector<Estimate> variances{};

    /// A bound that the error without noise keeps.
    [[nodiscard]] double predicted() const { return std::sqrt(square_bias.high()); }
    /// The same of the variance with so many samples, 1 at least.
    [[nodiscard]] double variance_with(double samples) const;
    /// Samples until noise and bias are inside the tolerance together; bias alone must be.
    [[nodiscard]] double samples_for(double tolerance) const;
};

struct PlanLine {
    std::string choice, chosen, reason;
    std::optional<double> error;  ///< predicted, of what was chosen; absent: nothing is lost
};

/// An option of petzval render with its value; left out where there is none.
using PlanOption = std::pair<std::string, std::optional<std::string>>;

struct Plan {
    SceneRequest scene;
    std::string chosen;               ///< name of the candidate
    std::vector<PlanOption> options;  ///< that lead to it, in place of those that were given
    std::vector<PlanLine> lines;
    std::vector<PlanCandidate> candidates;  ///< chosen or not; last the fullest model
    double bias = 0, noise = 0;             ///< predicted, of what was chosen with `samples`
    double first_noise = 0;                 ///< with one sample
    uint64_t samples = 0;                   ///< of each pixel
    double cpu_s = 0;                       ///< about what they take here

    [[nodiscard]] double error() const { return std::hypot(bias, noise); }
};

/// Looks at the scene through all models; takes up to most_samples in all, some seconds. Throws as
/// open_session does.
[[nodiscard]] Plan make_plan(const PlanRequest&, TbbExecutor&,
                             const std::function<void(const std::string&)>& notice,
                             double most_samples = 4e6);

/// open_session, with what the request leaves open (spectral mode, dispersion) planned: as a look
/// of at most a quarter of a sample for each pixel of the whole frame finds it, and so not a matter
/// of samples, seed or crop. Without a look where nothing depends on wavelength, and for frames too
/// small for one. `notice` and the metadata get the reasons. No camera that was asked for is
/// replaced.
[[nodiscard]] Session open_planned(const PlanRequest&, TbbExecutor&,
                                   const std::function<void(const std::string&)>& notice);

}  // namespace petzval
