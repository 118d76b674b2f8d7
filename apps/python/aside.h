// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>

namespace petzval::apps {

class ForkedError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Throws ForkedError in a fork of a process that has called it: the threads of libraries,
/// which began there, are not in the child, and who waits for them waits for ever.
void require_own_threads();

/// Runs work in a thread of its own, without Python's lock, so that other threads of Python run and
/// the caller's numbers keep their denormals. tick: called with the lock ten times a second. Where
/// it throws, or Ctrl-C is pressed, calls stop; that exception is thrown once the work has ended,
/// in place of one of the work.
void run_aside(const std::function<void()>& work, const std::function<void()>& tick,
               const std::function<void()>& stop);

}  // namespace petzval::apps
