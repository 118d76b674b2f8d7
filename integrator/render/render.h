// SPDX-License-Identifier: Apache-2.0
// Rendering of a job to a film: progressive passes over tiles.
#pragma once

#include <optional>
#include <vector>

#include "integrator/render/render_job.h"
#include "integrator/render/sample_batch.h"
#include "integrator/render/tiles.h"
#include "integrator/render/worker_stats.h"

namespace petzval::integrator {

/// Samples [first, end) of a pixel.
struct PixelSamples {
    V2i pixel;
    uint32_t first, end;
};

/// Renders samples of one pixel: each a pure function of job, pixel and index.
template <class Tracer>
void render_samples(const Tracer& tracer, const camera::Camera& camera, const RenderJob& job,
                    const PixelSamples& wanted, Film& film, PathStats& stats) {
    SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
    for (uint32_t i = wanted.first; i < wanted.end; ++i)
        batch.add({wanted.pixel.x, wanted.pixel.y, i});
    batch.render();
}

/// Number of samples of the next pass: it grows so that a first picture comes early, and passes
/// stay short. Never fewer than `least`, but for the last.
[[nodiscard]] inline uint32_t pass_size(uint32_t done, uint32_t wanted, uint32_t least = 1) {
    const uint32_t grown = std::max(done == 0 ? 1 : std::min(done, 16u), least);
    return std::min(grown, wanted - done);
}

/// Number of samples of the next pass within the job's time limit: 0 where it is over. before: what
/// was there when rendering began, elapsed_s ago.
[[nodiscard]] inline uint32_t pass_within(const RenderJob& job, uint32_t done, uint32_t before,
                                          uint32_t wanted, double elapsed_s) {
    const uint32_t pass = pass_size(done, wanted, job.replicates);
    if (!job.time_limit_s || done == 0) return pass;
    const double left_s = *job.time_limit_s - elapsed_s;
    if (done == before) return left_s > 0 ? pass : 0;
    const double fits = left_s / (elapsed_s / (done - before));
    if (!(fits >= 1)) return 0;
    return fits < pass ? static_cast<uint32_t>(fits) : pass;  // fits may be beyond uint32_t
}

/// Renders every pixel of the film's crop. Pixels do not depend on the executor, its threads, the
/// tile size, the crop or the passes. A film that has samples of this job goes on from there: each
/// pixel has the first taken_count() of them.
template <class Executor, class Tracer>
RenderResult render(const Tracer& tracer, const camera::Camera& camera, const RenderJob& job,
                    Film& film, Executor& executor, RenderMonitor& monitor) {
    const double start_s = job.wall_s();
    const std::vector<Rect> tiles = tiles_of(film.pixels(), job.tile_size_px);
    WorkerStats workers(executor.threads());
    const auto [before, most] = film.taken_range();
    const uint32_t wanted = job.end_sample - job.first_sample;
    uint32_t done = before;
    std::optional<uint32_t> pass;  // that is under way: once begun, every pixel gets it
    if (most > before) pass = most - before;
    while (done < wanted && !monitor.stop) {
        if (!pass) {
            pass = pass_within(job, done, before, wanted, job.wall_s() - start_s);
            if (*pass == 0) break;
        }
        executor.run(static_cast<int>(tiles.size()), [&](int task, int worker) {
            if (monitor.stop || monitor.pause) return;
            PathStats& stats = workers.of(worker);
            const Rect& tile = tiles[static_cast<size_t>(task)];
            const uint64_t samples_before = stats.samples;
            SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x)
                    for (uint32_t i = film.taken_count(x, y); i < done + *pass; ++i)
                        batch.add({x, y, job.first_sample + i});
            batch.render();
            stats.tiles += stats.samples > samples_before;
            monitor.pixel_samples_done += stats.samples - samples_before;
        });
        // The tiles that a pause left out are rendered when the pass is run once more.
        if (monitor.pause.exchange(false)) {
            if (job.at_pause && !monitor.stop) job.at_pause(workers.total());
        } else if (!monitor.stop) {
            done += *pass;
            pass.reset();
        }
    }
    RenderResult result;
    result.stats = workers.total();
    result.end_sample = job.first_sample + film.taken_range().least;
    result.stopped = monitor.stop && result.end_sample < job.end_sample;
    result.workers = workers.active();
    return result;
}

class TbbExecutor;
extern template RenderResult render(const PathTracer<>&, const camera::Camera&, const RenderJob&,
                                    Film&, TbbExecutor&, RenderMonitor&);

}  // namespace petzval::integrator
