// SPDX-License-Identifier: Apache-2.0
// Noise that a render is to reach: which cells of a frame need how many samples. A cell has two
// sets of pixels, as a chessboard has, and what is decided about one set hangs on the other alone,
// so that no pixel prefers what it shows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/film/film.h"
#include "integrator/render/noise_cells.h"

namespace petzval::integrator {

/// Noise to reach, for the cells of a full frame. The noise of a cell is the root of the mean, over
/// its pixels and R, G and B, of variance / (mean^2 + floor^2).
struct NoiseTarget : NoiseCells {
    double noise = 0;             ///< above 0
    double floor_nits = 0;        ///< above 0, or all is black
    std::vector<uint32_t> least;  ///< samples of each pixel that a cell takes; empty: none

    [[nodiscard]] uint32_t least_of(int i, int j) const {
        return least.empty() ? 0 : least[static_cast<size_t>(j * cells().x + i)];
    }
};

/// Paths on which the noise of a cell must hang for it to be known.
inline constexpr double kKnownPaths = 16;

/// Set of a pixel: 0 or 1.
[[nodiscard]] constexpr int set_of(int x, int y) {
    return (x + y) & 1;
}

/// Fewest samples of a pixel that tell a noise.
inline constexpr uint32_t kLeastOfCell = 16;

/// Steps from a power of two of samples to the next one.
inline constexpr uint32_t kStepsOfCell = 8;

/// What the pixels of one set of a cell say.
struct SetNoise {
    uint32_t taken = 0;  ///< samples of each pixel
    uint32_t begun = 0;  ///< most samples of a pixel: above `taken` in a step that is cut short
    /// Mean relative squares of differences, for the largest power of two P of samples: of the
    /// first P / 4 and P / 2; of the first P / 2 and P; and of the first P and all.
    double early = 0, late = 0, last = 0;
    /// Paths and pixels on which `late` and `last` hang: (sum of v)^2 / sum of v^2, Kish 1965,
    /// "Survey Sampling", section 11.7.
    double paths = 0, pixels = 0;

    /// Variance of half the samples over that of all, from 2 for independent samples to 8: as much
    /// of it as so few pixels can tell.
    [[nodiscard]] double growth() const;
    /// Relative variance of the mean after another number of samples; infinite where the samples
    /// that there are tell nothing.
    [[nodiscard]] double variance(uint32_t samples, double growth) const;
    [[nodiscard]] double variance(uint32_t samples) const { return variance(samples, growth()); }
    /// Samples of a pixel, as far as is known, after which the other set is below a variance;
    /// infinite where these tell nothing.
    [[nodiscard]] double needed(double most_variance) const;
};

/// What a cell renders next: of the pixels of a set the samples before `end`; 0: nothing.
struct CellStep {
    int set = 0;
    uint32_t end = 0;
};

/// What a cell says.
struct CellNoise {
    std::array<SetNoise, 2> sets{};

    /// Samples that each pixel of a set is to have next; as many as it has where it is done.
    [[nodiscard]] uint32_t next_count(size_t set, const NoiseTarget&, uint32_t least) const;
    /// A step that was cut short is finished, then the set with fewer samples goes on: so it does
    /// not matter where a cell was interrupted. most: samples of a pixel.
    [[nodiscard]] CellStep next_step(const NoiseTarget&, uint32_t least, uint32_t most) const;
    [[nodiscard]] bool is_done(const NoiseTarget&, uint32_t least) const;
    /// Relative variance of the picture: of each set by the other one, as decisions have it.
    [[nodiscard]] double decided_variance() const;
    /// Whether the noise hangs on so few paths that it may be larger than the target. Of a cell
    /// that is done: whether it is above it by itself, because of few paths in a set that did not
    /// decide.
    [[nodiscard]] bool is_at_least(const NoiseTarget&, bool done) const;
    /// Samples of a pixel, on average.
    [[nodiscard]] double samples() const { return (sets[0].taken + sets[1].taken) / 2.; }
};
[[nodiscard]] CellNoise cell_noise(const Film&, const Rect& cell, double floor_nits);

/// What a film has reached.
struct NoiseReport {
    /// Of the picture; infinite where a cell has too few samples to tell. Of each set by itself,
    /// which did not decide about it: what a set decided by is too small on average, as it stops
    /// the other one where it looks small.
    /// With fewer than 32 samples it is a cautious figure, but caution does not lift it above the
    /// target where all cells have reached that.
    double noise = 0;
    double worst_cell = 0;  ///< largest noise of a cell, likewise, or that of the picture
    double floor_nits = 0;  ///< of both
    /// All cells; those above the target; and of these those that may take more samples, and those
    /// whose noise is unknown.
    size_t cells = 0, left = 0, open = 0, at_least = 0;
    double mean_samples = 0;  ///< of a pixel
    /// Pixel samples that there will be, as far as is known: no more of a pixel than may be.
    double expected_samples = 0;
    double samples_for_all = 0;  ///< of a pixel of the worst cell, for the target; 0: unknown
};
/// From what the cells of a rectangle of them say, row by row.
[[nodiscard]] NoiseReport noise_report(const std::vector<CellNoise>&, const Rect& cells,
                                       const NoiseTarget&, uint32_t most_samples);
[[nodiscard]] NoiseReport noise_report(const Film&, const NoiseTarget&, uint32_t most_samples);

}  // namespace petzval::integrator
