// SPDX-License-Identifier: Apache-2.0
// Executors of tiles. The tile loop takes either; ThreadExecutor exists because thread sanitizers
// do not see into oneTBB's library.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "camera/run_tasks.h"

namespace petzval::integrator {

/// Runs f(task, worker) for every task in [0, count); worker < threads(), and no two tasks run at
/// once with the same worker.
class TbbExecutor {
  public:
    /// threads >= 1; more than the machine has cores is allowed.
    explicit TbbExecutor(int threads) : arena_(threads) {
        // A limit is one for all of the process, and the smallest of several holds. So there is
        // none but where it allows more.
        if (threads > tbb::info::default_concurrency())
            limit_.emplace(tbb::global_control::max_allowed_parallelism,
                           static_cast<size_t>(threads));
    }
    [[nodiscard]] int threads() const { return arena_.max_concurrency(); }
    /// Sets what is called before each task, by several threads at once; empty: nothing. Where it
    /// throws, no more tasks are begun, and run() throws the same.
    void before_task(std::function<void()> f) { before_task_ = std::move(f); }

    template <class F>
    void run(int count, const F& f) {
        arena_.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<int>(0, count, 1),
                [&](const tbb::blocked_range<int>& range) {
                    const int worker = tbb::this_task_arena::current_thread_index();
                    for (int i = range.begin(); i < range.end(); ++i) {
                        if (before_task_) before_task_();
                        f(i, worker);
                    }
                },
                tbb::simple_partitioner());
        });
    }
    /// Runs f inside the arena: work that f starts there uses these threads only.
    template <class F>
    auto inside(const F& f) {
        return arena_.execute(f);
    }

  private:
    std::optional<tbb::global_control> limit_;
    tbb::task_arena arena_;
    std::function<void()> before_task_;
};

/// What runs tasks on the threads of the arena that its caller is in, or of the machine where that
/// is in none. before_task is called before each, by several threads: an exception of it ends them.
inline camera::RunTasks run_here(std::function<void()> before_task) {
    return [before = std::move(before_task)](size_t count, const std::function<void(size_t)>& f) {
        tbb::parallel_for(size_t{0}, count, [&](size_t task) {
            before();
            f(task);
        });
    };
}

class ThreadExecutor {
  public:
    explicit ThreadExecutor(int threads) : threads_(threads) {}
    [[nodiscard]] int threads() const { return threads_; }

    template <class F>
    void run(int count, const F& f) {
        std::atomic<int> next = 0;
        std::vector<std::jthread> pool;
        for (int worker = 0; worker < threads_; ++worker) {
            pool.emplace_back([&, worker] {
                for (int i = next++; i < count; i = next++) f(i, worker);
            });
        }
    }

  private:
    int threads_;
};

}  // namespace petzval::integrator
