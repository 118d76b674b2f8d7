// SPDX-License-Identifier: Apache-2.0
// Rendering until the noise of each cell is below a target.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <vector>

#include "integrator/render/noise_target.h"
#include "integrator/render/render_job.h"
#include "integrator/render/sample_batch.h"
#include "integrator/render/worker_stats.h"

namespace petzval {

/// Renders the next samples of one cell: for the pixels of each set as many as the other one says.
/// Returns whether there were any that the job allows.
template <class Tracer>
bool render_cell(const Tracer& tracer, const Camera& camera, const RenderJob& job, int i, int j,
                 Film& film, PathStats& stats) {
    const NoiseTarget& target = *job.noise;
    const Rect cell = target.cell(i, j);
    const CellNoise now = cell_noise(film, cell, target.floor_nits);
    SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
    const auto each_pixel = [&](int set, const auto& use) {
        for (int y = cell.y0; y < cell.y1; ++y)
            for (int x = cell.x0; x < cell.x1; ++x)
                if (set_of(x, y) == set) use(x, y);
    };
    bool any = false;
    for (int set = 0; set < 2; ++set) {
        const auto k = static_cast<size_t>(set);
        uint32_t taken = now.sets[k].taken;
        const uint32_t end =
            std::min(job.end_sample, now.next_count(k, target, target.least_of(i, j)));
        any = any || taken < end;
        while (taken < end) {
            if (std::has_single_bit(taken))
                each_pixel(set, [&](int x, int y) { film.close_block(x, y); });
            const uint32_t to = std::min(end, 2 * std::max(1u, std::bit_floor(taken)));
            each_pixel(set, [&](int x, int y) {
                for (uint32_t n = taken; n < to; ++n) batch.add({x, y, n});
            });
            batch.render();
            taken = to;
        }
    }
    return any;
}

/// Renders the cells of the film's crop, which must be of whole cells, until each has reached the
/// job's noise, or its samples or time are over. A cell depends on nothing but itself: not on the
/// executor, its threads, the crop, or on when it was stopped. A film of this job's goes on.
template <class Executor, class Tracer>
RenderResult render_to_noise(const Tracer& tracer, const Camera& camera, const RenderJob& job,
                             Film& film, Executor& executor, RenderMonitor& monitor) {
    const double start_s = job.wall_s();
    const Rect cells = job.noise->cells_of(film.crop());
    WorkerStats workers(executor.threads());
    std::vector<uint8_t> open(
        static_cast<size_t>(cells.width()) * static_cast<size_t>(cells.height()), 1);
    std::atomic<bool> late = false;
    const auto is_open = [&] { return std::find(open.begin(), open.end(), 1) != open.end(); };
    while (is_open() && !monitor.stop && !late) {
        executor.run(static_cast<int>(open.size()), [&](int task, int worker) {
            uint8_t& is_open_cell = open[static_cast<size_t>(task)];
            if (monitor.stop || monitor.pause || !is_open_cell) return;
            if (job.time_limit_s && job.wall_s() - start_s >= *job.time_limit_s) {
                late = true;
                return;
            }
            PathStats& stats = workers.of(worker);
            const uint64_t before = stats.samples;
            is_open_cell = render_cell(tracer, camera, job, cells.x0 + task % cells.width(),
                                       cells.y0 + task / cells.width(), film, stats);
            stats.tiles += stats.samples > before;
            monitor.pixel_samples_done += stats.samples - before;
        });
        const NoiseReport reached = noise_report(film, *job.noise, job.end_sample);
        monitor.noise = reached.noise;
        monitor.expected_pixel_samples = static_cast<uint64_t>(reached.expected_samples);
        if (monitor.pause.exchange(false) && job.at_pause && !monitor.stop)
            job.at_pause(workers.total());
    }
    RenderResult result;
    result.stats = workers.total();
    result.end_sample = film.taken_range().least;
    result.stopped = monitor.stop && is_open();
    result.workers = workers.active();
    return result;
}

class TbbExecutor;
extern template RenderResult render_to_noise(const PathTracer<>&, const Camera&, const RenderJob&,
                                             Film&, TbbExecutor&, RenderMonitor&);

}  // namespace petzval
