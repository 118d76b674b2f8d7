// SPDX-License-Identifier: Apache-2.0
// A look at a few pixels of a render through several models of it, all with the same random
// numbers: what each costs, how noisy it is, and how far it is off.
#pragma once

#include <array>
#include <vector>

#include "apps/setup/render_setup.h"
#include "integrator/executor.h"
#include "integrator/path.h"
#include "integrator/render_job.h"

namespace petzval {

/// Independent replicates of the sampler in each pixel: what they have in common is no noise.
inline constexpr uint32_t kPilotReplicates = 4;

/// Of a mean over pixels; error: standard, from their spread.
struct Estimate {
    double mean = 0, error = 0;

    /// Standard errors from the mean to a bound: more than the 1.645 of 95 %, as pixels have long
    /// tails and a few of them hide the worst.
    static constexpr double kSure = 2;
    [[nodiscard]] double high() const { return std::max(mean, 0.) + kSure * error; }
    [[nodiscard]] double low() const { return std::max(mean - kSure * error, 0.); }
};

/// One model of the render.
class PilotModel {
  public:
    [[nodiscard]] const Session& session() const { return session_; }
    [[nodiscard]] uint32_t samples() const { return samples_; }  ///< of each look at a pixel
    /// What a sample costs, the same on every machine: rays that are cast, and one more for a way
    /// through glass. After the first look.
    [[nodiscard]] double rays_per_sample() const;
    [[nodiscard]] double cpu_s_per_sample() const {
        return cpu_s_ / static_cast<double>(stats_.samples);
    }

  private:
    friend class Pilot;
    PilotModel(Session, const RenderJob&, const PathOptions&, size_t pixels);

    Session session_;
    RenderJob job_;
    PathTracer<> tracer_;
    std::vector<std::array<V3d, kPilotReplicates>> sums_;  ///< of the samples of each pixel
    std::vector<std::vector<V3d>> variances_;              ///< of one look at each pixel, by turn
    uint32_t samples_ = 0;
    PathStats stats_;
    double cpu_s_ = 0;
};

/// A model that counts `factor` times in a difference.
struct PilotTerm {
    const PilotModel* model;
    double factor;
};

/// The pixels. They, and all that is found but times, follow from size and seed alone.
class Pilot {
  public:
    /// wanted: about so many pixels, one in each cell of an even grid.
    Pilot(V2i size_px, int wanted, TbbExecutor&, uint32_t seed = 0);

    [[nodiscard]] size_t pixels() const { return pixels_.size(); }
    /// Of job only sampler and filter count.
    [[nodiscard]] std::unique_ptr<PilotModel> model(Session, const RenderJob&,
                                                    const PathOptions&) const;
    /// Goes on until each look has so many samples.
    void look(PilotModel&, uint32_t samples) const;

    /// Mean over pixels and channels of the square, over b^2 + kRelativeMseEpsilon, of what the
    /// terms add up to with endless samples; b: what `scale` shows. Not biased, so it may be
    /// negative: only products of different looks count. All have as many samples.
    [[nodiscard]] Estimate square(const std::vector<PilotTerm>&, const PilotModel& scale) const;
    /// The same mean of the variance of one look, as it was after each turn of look().
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
