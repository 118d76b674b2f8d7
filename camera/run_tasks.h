// SPDX-License-Identifier: Apache-2.0
// How the parts of a search before the first sample are run: whoever has threads says.
#pragma once

#include <cstddef>
#include <functional>

namespace petzval::camera {

/// Runs a task for each number in [0, count), in any order and several at once, and returns when
/// all are done.
using RunTasks = std::function<void(size_t count, const std::function<void(size_t)>& task)>;

/// Runs them one after another.
inline void one_by_one(size_t count, const std::function<void(size_t)>& task) {
    for (size_t i = 0; i < count; ++i) task(i);
}

}  // namespace petzval::camera
