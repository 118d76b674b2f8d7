// SPDX-License-Identifier: Apache-2.0
// How the parts of a search before the first sample are run: whoever has threads says.
#pragma once

#include <cstddef>
#include <functional>

#include "core/math/math.h"

namespace petzval::camera {

/// Runs a task for each number in [0, count), in any order and several at once, and returns when
/// all are done.
using RunTasks = std::function<void(size_t count, const std::function<void(size_t)>& task)>;

/// Runs them one after another.
inline void one_by_one(size_t count, const std::function<void(size_t)>& task) {
    for (size_t i = 0; i < count; ++i) task(i);
}

/// Runs f(number, place) for each cell of a grid: a task each, numbered row by row.
template <class F>
void run_cells(const RunTasks& run, V2i cells, const F& f) {
    const auto width = static_cast<size_t>(cells.x);
    run(width * static_cast<size_t>(cells.y),
        [&](size_t n) { f(n, V2i(static_cast<int>(n % width), static_cast<int>(n / width))); });
}

}  // namespace petzval::camera
