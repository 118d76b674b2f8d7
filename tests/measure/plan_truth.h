// SPDX-License-Identifier: Apache-2.0
// True errors of models, by brute force: apart from apps/plan's pilot, with other seeds.
#pragma once

#include <array>
#include <vector>

#include "apps/plan/plan_types.h"
#include "integrator/executor.h"
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

/// Renders pixels with seeds of its own; turn: another one has other seeds.
[[nodiscard]] Replicates render_replicates(const RenderSetup&, const PlanRequest&,
                                           const std::vector<TruthPixel>&, uint32_t samples,
                                           uint32_t turn, TbbExecutor&);

/// Floor of the symmetric MSE for a picture.
[[nodiscard]] double floor_of(const Replicates&, const std::vector<TruthPixel>&);

/// Symmetric MSE of two models without noise. Of where models may differ, or of the other pixels:
/// what these add must be nothing.
///
/// Numerators are products of differences of different replicates. `value` takes denominators from
/// the other half of the replicates, so that it has no share in their noise; where light is rare it
/// is too high all the same. Denominators from all replicates give too little there. The bounds
/// hold both: the lower is the lower one of either, the upper likewise. Each lies 1.645 standard
/// errors away, from a jackknife over the replicates of each pixel: pixels have random numbers of
/// their own.
[[nodiscard]] Bounded square_bias(const Replicates& a, const Replicates& b,
                                  const std::vector<TruthPixel>&, double floor, bool matters);

/// Symmetric MSE by noise of a picture with so many samples, against many samples of the same
/// model; seen: replicates of it with `seen_samples`, which tell where noise is. With `most`
/// samples of all pixels together it measures only as many of them as that pays, drawn by their
/// share of the noise.
[[nodiscard]] Bounded square_noise(const RenderSetup&, const PlanRequest&,
                                   const std::vector<TruthPixel>&, const Replicates& seen,
                                   uint32_t seen_samples, uint64_t samples, double floor,
                                   double most, TbbExecutor&);

}  // namespace petzval
