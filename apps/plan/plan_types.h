// SPDX-License-Identifier: Apache-2.0
// Values of a plan: its request, the models, and what is measured of each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "apps/plan/pilot_error.h"
#include "apps/plan/rare_light.h"
#include "apps/request/render_request.h"
#include "apps/setup/render_setup.h"
#include "integrator/path/path_options.h"
#include "integrator/render/render_job.h"
#include "io/image/symmetric_mse.h"

namespace petzval::apps {

/// Share of the squared tolerance that a simpler model may err; the rest is for noise.
inline constexpr double kBiasShare = 0.5;

inline constexpr double kMostPlannedSamples = 1 << 30;

struct PlanRequest {
    SceneRequest scene;
    integrator::RenderJob
        job;  ///< sampler and filter count: samples and seed do not, nor does a crop
    integrator::PathOptions path;
    double tolerance = kUsualTolerance;  ///< above 0
    const RenderSetup* like = nullptr;   ///< a setup of which what is the same is taken
    FrameReuse* frames = nullptr;        ///< of a sequence, which it is part of
};

/// Ways to render a scene, simplest first. Shared to Split carry wavelengths through a lens.
enum class PlanModel : uint8_t { Pinhole, Thin, Rgb, Shared, Hero, Split, Full };

/// Whether the model replaces the camera that was asked for.
[[nodiscard]] constexpr bool replaces_camera(PlanModel model) {
    return model == PlanModel::Pinhole || model == PlanModel::Thin;
}

/// Choices that a request leaves to the plan.
struct PlanOpen {
    bool spectral = false;         ///< RGB or wavelengths
    bool dispersion = false;       ///< whether wavelengths may share a ray through the lens
    bool dispersion_mode = false;  ///< how they are carried, even where nothing may be left out

    PlanOpen(const SceneRequest&, const RenderSetup&);
    [[nodiscard]] bool any() const { return spectral || dispersion; }
};

/// A model, how far it is off from the fullest one, and what it costs.
struct PlanCandidate {
    PlanModel model;
    SceneRequest scene;  ///< nothing in it is left open
    Estimate square_bias{};
    bool inside = false;   ///< surely within its share of the tolerance
    bool outside = false;  ///< surely beyond it
    double rays = 0;       ///< of a sample, as PilotModel counts them
    PilotNoise noise{};
    RareLight rare{};

    /// Upper bound of the error without noise.
    [[nodiscard]] double predicted() const {
        return std::sqrt(std::min(square_bias.high(), io::kMostSymmetricMse));
    }
    /// Measured error.
    [[nodiscard]] double found() const {
        return std::sqrt(std::clamp(square_bias.mean, 0., io::kMostSymmetricMse));
    }
    /// Upper bound of the variance with so many samples, 1 at least, with what light that was
    /// hardly met may add: of the symmetric MSE by noise where noise is small, and never more than
    /// kMostSymmetricMse.
    [[nodiscard]] double variance_with(uint64_t samples) const;
    /// Variance of one sample, without what light that was hardly met may add.
    [[nodiscard]] double variance_of_one() const;
    /// Upper bound of the variance of 2^digit samples, without the same.
    [[nodiscard]] double block_variance(size_t digit) const;
    /// Whether the noise may be larger: paths that were hardly met, or not at all, hold some of it.
    [[nodiscard]] bool noise_at_least() const;
    /// Samples until noise and bias are inside the tolerance together; infinite where bias alone is
    /// not, or where they would be more than kMostPlannedSamples.
    [[nodiscard]] double samples_for(double tolerance) const;
};

}  // namespace petzval::apps
