// SPDX-License-Identifier: Apache-2.0
// Render job, the monitor of its progress, and its result.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"
#include "core/spectrum/observer.h"
#include "integrator/path/stats.h"

namespace petzval::integrator {

/// Seconds of a clock that never goes back.
[[nodiscard]] inline double steady_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class Velocity;
struct NoiseTarget;

struct RenderJob {
    uint32_t first_sample = 0, end_sample = 64;  ///< sample indices [first, end) of every pixel
    std::optional<double> time_limit_s;  ///< ends with the pass that reaches it, end_sample or not
    std::function<double()> wall_s = steady_s;  ///< clock of the time limit; tests step their own
    /// Called in the rendering thread after the monitor said pause, while no sample is under way:
    /// the film may be read. It gets the counts so far.
    std::function<void(const PathStats&)> at_pause;
    uint32_t seed = 0;
    SamplerKind sampler = SamplerKind::Owen;
    Filter filter{FilterKind::BlackmanHarris, 1.5f};
    int tile_size_px = 16;
    Observer observer;                   ///< draws what the lanes carry
    uint32_t replicates = 1;             ///< kReplicates for a film with bins
    const Velocity* velocity = nullptr;  ///< where that layer is wanted; must outlive the job
    /// Largest R, G or B of a sample: a brighter one is made as bright, in its colour.
    std::optional<float> clamp_nits;
    /// Noise to reach, of a film with blocks. nullptr: all pixels get the same samples.
    std::shared_ptr<const NoiseTarget> noise;
    /// Error that the denoised picture is to have at most, of a film with halves; the samples end
    /// where it has.
    std::optional<double> denoised_error;
    bool timing = false;  ///< measure where the time goes, on a sixteenth of the samples
};

/// Progress of a running render, and the flag that stops it. Any thread may use it.
struct RenderMonitor {
    std::atomic<bool> stop = false;  ///< set it: tiles under way are finished, no more begun
    std::atomic<bool> pause =
        false;  ///< likewise; then at_pause() is called, and rendering goes on
    std::atomic<uint64_t> pixel_samples_done = 0;
    /// Where a job has a target: the noise of the picture so far, and pixel samples that there will
    /// be, as far as is known; 0 before.
    std::atomic<double> noise = 0;
    std::atomic<uint64_t> expected_pixel_samples = 0;
};

struct RenderResult {
    PathStats stats;
    int workers = 0;          ///< threads that rendered at least one tile
    uint32_t end_sample = 0;  ///< samples [first, end) are complete in every pixel
    bool stopped = false;     ///< the monitor said stop, and samples are left to render
};

}  // namespace petzval::integrator
