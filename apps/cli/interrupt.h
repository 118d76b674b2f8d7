// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and termination as a request to stop a render.
#pragma once

#include <csignal>
#include <thread>

#include "integrator/render_job.h"

namespace petzval {

/// Handling of SIGINT and SIGTERM: while it lives, a thread of its own waits for them instead of
/// their being delivered, so there is no handler and no shared state. Create it before any other
/// thread: they inherit the blocked signals. The first signal while a render is armed sets its stop
/// flag; a second one, or one at any other time, ends the process at once with 130.
class Interrupt {
  public:
    explicit Interrupt(RenderMonitor&);
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    /// From now on a signal asks the render to stop.
    void arm() { armed_ = true; }

  private:
    void watch(const std::stop_token&);

    RenderMonitor& monitor_;
    std::atomic<bool> armed_ = false;
    sigset_t signals_;
    std::jthread thread_;
};

}  // namespace petzval
