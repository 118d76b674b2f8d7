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

namespace petzval::integrator {

/// Renders the next step of the rows y0 .. y1 - 1 of a cell. Each pixel gets all of it or nothing.
template <class Tracer>
void render_rows(const Tracer& tracer, const camera::Camera& camera, const RenderJob& job,
                 const Rect& rows, const CellStep& step, Film& film, PathStats& stats) {
    SampleBatch<Tracer> batch(tracer, camera, job, film.full_size(), &film, stats);
    const auto each_pixel = [&](const auto& use) {
        for (int y = rows.y0; y < rows.y1; ++y)
            for (int x = rows.x0; x < rows.x1; ++x)
                if (set_of(x, y) == step.set) use(x, y);
    };
    bool any = true;
    while (any) {
        any = false;
        each_pixel([&](int x, int y) {
            const uint32_t taken = film.taken_count(x, y);
            if (taken >= step.end) return;
            any = true;
            if (std::has_single_bit(taken)) film.close_block(x, y);
            const uint32_t to = std::min(step.end, 2 * std::max(1u, std::bit_floor(taken)));
            for (uint32_t n = taken; n < to; ++n) batch.add({x, y, n});
        });
        batch.render();
    }
}

/// Cells of a film's crop that are rendered to a noise: what they say, and what each needs next.
class NoisyCells {
  public:
    NoisyCells(const Film& film, const RenderJob& job)
        : film_(film),
          target_(*job.noise),
          most_(job.end_sample),
          cells_(target_.cells_of(film.crop())),
          found_(static_cast<size_t>(cells_.width()) * static_cast<size_t>(cells_.height())) {
        for (int n = 0; n < static_cast<int>(found_.size()); ++n) open_.push_back({n, {}});
    }
    /// Looks at the cells that are open: those that are not any more leave.
    template <class Executor>
    void look(Executor& executor) {
        executor.run(static_cast<int>(open_.size()), [&](int task, int) {
            Open& one = open_[static_cast<size_t>(task)];
            CellNoise& now = found_[static_cast<size_t>(one.cell)];
            now = cell_noise(film_, rect_of(one.cell), target_.floor_nits);
            one.step = now.next_step(
                target_, target_.least_of(column_of(one.cell), row_of(one.cell)), most_);
        });
        std::erase_if(open_, [](const Open& one) { return one.step.end == 0; });
    }
    [[nodiscard]] bool any() const { return !open_.empty(); }
    [[nodiscard]] NoiseReport report() const {
        return noise_report(found_, cells_, target_, most_);
    }
    /// Tasks of the next step: where few cells are open each is several, so that all threads work.
    [[nodiscard]] int tasks(int threads) {
        constexpr int kTasksOfThread = 8;
        parts_ = std::clamp(kTasksOfThread * threads / static_cast<int>(open_.size()), 1,
                            NoiseTarget::kCell_px);
        return parts_ * static_cast<int>(open_.size());
    }
    struct Task {
        Rect rows;
        CellStep step;
    };
    [[nodiscard]] Task task(int number) const {
        const Open& one = open_[static_cast<size_t>(number / parts_)];
        const Rect cell = rect_of(one.cell);
        const auto row = [&](int part) { return cell.y0 + cell.height() * part / parts_; };
        const int part = number % parts_;
        return {{cell.x0, row(part), cell.x1, row(part + 1)}, one.step};
    }

  private:
    struct Open {
        int cell;
        CellStep step;
    };
    [[nodiscard]] int column_of(int cell) const { return cells_.x0 + cell % cells_.width(); }
    [[nodiscard]] int row_of(int cell) const { return cells_.y0 + cell / cells_.width(); }
    [[nodiscard]] Rect rect_of(int cell) const {
        return target_.cell(column_of(cell), row_of(cell));
    }

    const Film& film_;
    const NoiseTarget& target_;
    uint32_t most_;
    Rect cells_;
    std::vector<CellNoise> found_;
    std::vector<Open> open_;
    int parts_ = 1;
};

/// Renders the cells of the film's crop, which must be of whole cells, until each has reached the
/// job's noise, or its samples or time are over. A cell depends on nothing but itself: not on the
/// executor, its threads, the crop, or on when it was stopped. A film of this job's goes on.
template <class Executor, class Tracer>
RenderResult render_to_noise(const Tracer& tracer, const camera::Camera& camera,
                             const RenderJob& job, Film& film, Executor& executor,
                             RenderMonitor& monitor) {
    const double start_s = job.wall_s();
    WorkerStats workers(executor.threads());
    NoisyCells cells(film, job);
    std::atomic<bool> late = false;
    for (;;) {
        cells.look(executor);
        const NoiseReport reached = cells.report();
        monitor.noise = reached.noise;
        monitor.expected_pixel_samples = static_cast<uint64_t>(reached.expected_samples);
        if (monitor.pause.exchange(false) && job.at_pause && !monitor.stop)
            job.at_pause(workers.total());
        if (!cells.any() || monitor.stop || late) break;
        executor.run(cells.tasks(executor.threads()), [&](int number, int worker) {
            if (monitor.stop || monitor.pause) return;
            if (job.time_limit_s && job.wall_s() - start_s >= *job.time_limit_s) {
                late = true;
                return;
            }
            const auto [rows, step] = cells.task(number);
            PathStats& stats = workers.of(worker);
            const uint64_t before = stats.samples;
            render_rows(tracer, camera, job, rows, step, film, stats);
            stats.tiles += stats.samples > before;
            monitor.pixel_samples_done += stats.samples - before;
        });
    }
    RenderResult result;
    result.stats = workers.total();
    result.end_sample = film.taken_range().least;
    result.stopped = monitor.stop && cells.any();
    result.workers = workers.active();
    return result;
}

class TbbExecutor;
extern template RenderResult render_to_noise(const PathTracer<>&, const camera::Camera&,
                                             const RenderJob&, Film&, TbbExecutor&, RenderMonitor&);

}  // namespace petzval::integrator
