// SPDX-License-Identifier: Apache-2.0
// True errors of models, by brute force: apart from apps/plan's pilot, with other seeds.
#pragma once

#include <array>
#include <vector>

#include "apps/plan/plan_types.h"
#include "integrator/render/executor.h"
#include "tests/support/plan_scenes/plan_scenes.h"

namespace petzval {

inline constexpr size_t kTruthReplicates = 8;

/// A figure and its bounds, each with a probability of 95 %. All are squares.
struct Bounded {
    double value = 0, low = 0, high = 0;
};

/// A pixel that is rendered.
struct TruthPixel {
    int x, y;
    double stands_for;  ///< so many pixels of the frame
    bool matters;       ///< models may differ there
};
/// Every pixel that matters, and some of the others.
[[nodiscard]] std::vector<TruthPixel> truth_pixels(const test::PlanScene&);

/// Means of independent replicates, by pixel.
using Replicates = std::vector<std::array<V3d, kTruthReplicates>>;

/// Renders pixels, each replicate with as many samples as `samples` says for its pixel; where that
/// is 0, `into` stays as it is. turn: another one has other seeds.
void render_replicates(const apps::RenderSetup&, const apps::PlanRequest&,
                       const std::vector<TruthPixel>&, const std::vector<uint32_t>& samples,
                       uint32_t turn, integrator::TbbExecutor&, Replicates& into);

/// Pictures of models through the same pixels, with the same seeds.
struct TruthPictures {
    std::vector<TruthPixel> pixels;
    std::vector<uint32_t> samples;  ///< of a replicate of each pixel
    std::vector<Replicates> shown;  ///< by model
    double floor = 0;               ///< of the symmetric MSE, from the last
};
/// Pictures of models, the last of them the fullest, with about so many samples in all. Half of
/// them is spread evenly. The other half goes to pixels about which the first found noise in the
/// differences. They are rendered anew: what they had before is dropped.
[[nodiscard]] TruthPictures truth_pictures(const test::PlanScene&, const apps::PlanRequest&,
                                           const std::vector<const apps::RenderSetup*>& models,
                                           double budget, integrator::TbbExecutor&);

/// Symmetric MSE of two models without noise. Of where models may differ, or of the other pixels:
/// what these add must be nothing.
///
/// Numerators are products of differences of different replicates. Denominators are taken from the
/// other half of the replicates, which gives too much where light is rare, and from all of them,
/// which gives too little there. The value is the mean of the two; the lower bound is the lower one
/// of either, the upper likewise. Each lies 1.645 standard errors away, from a jackknife over the
/// replicates of each pixel: pixels have random numbers of their own. What no sample has met is
/// missing from all of them.
[[nodiscard]] Bounded square_bias(const TruthPictures&, size_t model, bool matters);

/// Symmetric MSE by noise of a picture with so many samples, against many samples of the same
/// model. With `budget` samples of all pixels together it measures only as many of them as that
/// pays, drawn by their share of the noise. Beyond 2048 samples it falls in proportion.
[[nodiscard]] Bounded square_noise(const TruthPictures&, size_t model, const apps::RenderSetup&,
                                   const apps::PlanRequest&, uint64_t samples, double budget,
                                   integrator::TbbExecutor&);

}  // namespace petzval
