// SPDX-License-Identifier: Apache-2.0
// A pilot renders a few pixels of a picture through several models, all with the same random
// numbers, to measure what each costs, how noisy it is, and how far it is off.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "apps/plan/estimate.h"
#include "apps/plan/pilot_pixels.h"
#include "apps/setup/render_setup.h"
#include "integrator/path/path.h"
#include "integrator/render/executor.h"
#include "integrator/render/render_job.h"

namespace petzval::apps {

/// Another view of a scene that is set up, without notices.
[[nodiscard]] RenderSetup view_of(const RenderSetup& first, const SceneRequest&,
                                  integrator::TbbExecutor&);

/// Independent replicates of the sampler in each pixel: what they have in common is no noise.
inline constexpr uint32_t kPilotReplicates = 4;
/// Values of a pixel, one of each replicate.
using PilotValues = std::array<V3d, kPilotReplicates>;

/// One model of the render.
class PilotModel {
  public:
    [[nodiscard]] const RenderSetup& setup() const { return setup_; }
    [[nodiscard]] uint32_t samples() const { return samples_; }  ///< of each replicate of a pixel
    [[nodiscard]] const integrator::PathStats& stats() const { return stats_; }
    /// Mean of each replicate of a pilot pixel.
    [[nodiscard]] PilotValues means(size_t pixel) const;
    /// Means after each turn of Pilot::sample(), by turn and pilot pixel.
    [[nodiscard]] const std::vector<std::vector<PilotValues>>& turns() const { return turns_; }
    /// Cost of a sample, the same on every machine: rays that are cast, and up to three more for
    /// the way through glass. Only after sample().
    [[nodiscard]] double rays_per_sample() const;
    /// CPU time of a sample, the mean over the frame.
    [[nodiscard]] double cpu_s_per_sample() const;

  private:
    friend class Pilot;
    PilotModel(RenderSetup, const integrator::RenderJob&, const integrator::PathOptions&,
               const std::vector<PilotPixel>&);
    [[nodiscard]] double lens_rays() const;
    [[nodiscard]] double rays_to_find_targets() const;

    RenderSetup setup_;
    integrator::RenderJob job_;
    integrator::PathTracer<> tracer_;
    std::vector<double> weights_;  ///< of the pilot pixels
    std::vector<PilotValues> sums_;
    std::vector<std::vector<PilotValues>> turns_;
    std::vector<double> pixel_s_;  ///< time that each pilot pixel took, as the thread saw it
    uint32_t samples_ = 0;
    integrator::PathStats stats_;
    double cpu_s_ = 0;
};

/// Pixels that a pilot renders. They, and all that is measured but times, follow from size, pilot
/// pixels and seed alone.
class Pilot {
  public:
    Pilot(V2i size_px, PilotPixels, integrator::TbbExecutor&, uint32_t seed = 0);
    /// wanted: about so many pixels, one in each cell of an even grid.
    Pilot(V2i size_px, int wanted, integrator::TbbExecutor&, uint32_t seed = 0);

    [[nodiscard]] size_t pixels() const { return chosen_.pixels.size(); }
    [[nodiscard]] V2i size_px() const { return size_px_; }
    [[nodiscard]] const PilotPixels& chosen() const { return chosen_; }
    /// Uses job.sampler, job.filter and job.replicates; ignores the rest.
    [[nodiscard]] std::unique_ptr<PilotModel> model(RenderSetup, const integrator::RenderJob&,
                                                    const integrator::PathOptions&) const;
    /// Renders on until each replicate of a pixel has so many samples.
    void sample(PilotModel&, uint32_t samples) const;

  private:
    V2i size_px_;
    uint32_t seed_;
    PilotPixels chosen_;
    integrator::TbbExecutor& executor_;
};

}  // namespace petzval::apps
