// SPDX-License-Identifier: Apache-2.0
// Counts of the threads of a render.
#pragma once

#include <algorithm>
#include <vector>

#include "integrator/path/stats.h"

namespace petzval::integrator {

/// Counts of each worker of an executor.
class WorkerStats {
  public:
    explicit WorkerStats(int workers) : workers_(static_cast<size_t>(workers)) {}

    [[nodiscard]] PathStats& of(int worker) { return workers_[static_cast<size_t>(worker)].stats; }
    [[nodiscard]] PathStats total() const {
        PathStats sum;
        for (const Worker& worker : workers_) sum += worker.stats;
        return sum;
    }
    /// Workers that rendered at least one tile.
    [[nodiscard]] int active() const {
        return static_cast<int>(std::count_if(workers_.begin(), workers_.end(),
                                              [](const Worker& w) { return w.stats.tiles > 0; }));
    }

  private:
    struct alignas(128) Worker {  // a cache-line pair each, so that counting does not contend
        PathStats stats;
    };
    std::vector<Worker> workers_;
};

}  // namespace petzval::integrator
