// SPDX-License-Identifier: Apache-2.0
// A pilot renders a few pixels of a picture through several models, all with the same random
// numbers, to measure what each costs, how noisy it is, and how far it is off.
#pragma once

#include <array>
#include <vector>

#include "apps/plan/estimate.h"
#include "apps/setup/render_setup.h"
#include "integrator/executor.h"
#include "integrator/path.h"
#include "integrator/render_job.h"

namespace petzval {

/// Another view of a scene that is set up, without notices.
[[nodiscard]] RenderSetup view_of(const RenderSetup& first, const SceneRequest&, TbbExecutor&);

/// Independent replicates of the sampler in each pixel: what they have in common is no noise.
inline constexpr uint32_t kPilotReplicates = 4;

/// One model of the render.
class PilotModel {
  public:
    [[nodiscard]] const RenderSetup& setup() const { return setup_; }
    [[nodiscard]] uint32_t samples() const { return samples_; }  ///< of each replicate of a pixel
    /// Cost of a sample, the same on every machine: rays that are cast, and up to three more for
    /// the way through glass. Only after sample().
    [[nodiscard]] double rays_per_sample() const;
    [[nodiscard]] double cpu_s_per_sample() const {
        return cpu_s_ / static_cast<double>(stats_.samples);
    }

  private:
    friend class Pilot;
    PilotModel(RenderSetup, const RenderJob&, const PathOptions&, size_t pixels);
    [[nodiscard]] double lens_rays() const;

    RenderSetup setup_;
    RenderJob job_;
    PathTracer<> tracer_;
    std::vector<std::array<V3d, kPilotReplicates>> sums_;  ///< by pixel and replicate
    std::vector<std::vector<V3d>> variances_;              ///< of one replicate, by turn and pixel
    uint32_t samples_ = 0;
    PathStats stats_;
    double cpu_s_ = 0;
};

/// A model that counts `factor` times in a difference.
struct PilotTerm {
    const PilotModel* model;
    double factor;
};

/// Pixels that a pilot renders. They, and all that is measured but times, follow from size and seed
/// alone.
class Pilot {
  public:
    /// wanted: about so many pixels, one in each cell of an even grid.
    Pilot(V2i size_px, int wanted, TbbExecutor&, uint32_t seed = 0);

    [[nodiscard]] size_t pixels() const { return pixels_.size(); }
    /// Uses job.sampler, job.filter and job.replicates; ignores the rest.
    [[nodiscard]] std::unique_ptr<PilotModel> model(RenderSetup, const RenderJob&,
                                                    const PathOptions&) const;
    /// Renders on until each replicate of a pixel has so many samples.
    void sample(PilotModel&, uint32_t samples) const;

    /// Squared relative error: mean over pixels and channels of the square of what the terms add up
    /// to with endless samples, over b^2 + kRelativeMseEpsilon; b: what `scale` shows. Unbiased, so
    /// it may be negative: only products of different replicates count. All must have as many
    /// samples.
    [[nodiscard]] Estimate square(const std::vector<PilotTerm>&, const PilotModel& scale) const;
    /// Relative variance of one replicate, the same mean as in square(), after each turn of
    /// sample().
    [[nodiscard]] std::vector<Estimate> variances(const PilotModel&, const PilotModel& scale) const;
    [[nodiscard]] Estimate variance(const PilotModel& model, const PilotModel& scale) const {
        return variances(model, scale).back();
    }

  private:
    [[nodiscard]] std::vector<V3d> variances_of(const PilotModel&) const;
    [[nodiscard]] std::vector<V3d> weights(const PilotModel& scale) const;

    V2i size_px_;
    uint32_t seed_;
    std::vector<std::array<int, 2>> pixels_;
    TbbExecutor& executor_;
};

}  // namespace petzval
