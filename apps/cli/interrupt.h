// SPDX-License-Identifier: Apache-2.0
// Signals that end a command, as a request to stop a render.
#pragma once

#include <atomic>
#include <csignal>
#include <thread>

#include "integrator/render/render_job.h"

namespace petzval::apps {

/// Handling of SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1 and SIGUSR2: while it lives, a thread of
/// its own waits for them instead of their being delivered, so there is no shared state. Create it
/// before any other thread: they inherit the blocked signals. The first signal after arm() sets the
/// monitor's stop flag; a second one, or one before arm(), ends the process at once with kStopped.
/// A signal that is ignored when it is created stays so: nohup and jobs in the background rely on
/// that.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    /// Monitor of the render that a signal stops.
    [[nodiscard]] integrator::RenderMonitor& monitor() { return monitor_; }
    /// From now on a signal asks the render to stop.
    void arm() { armed_ = true; }
    /// Name of the signal that asked for it, as SIGINT; nullptr where none did.
    [[nodiscard]] const char* signal_name() const;

  private:
    void watch(const std::stop_token&);

    integrator::RenderMonitor monitor_;
    std::atomic<bool> armed_ = false;
    std::atomic<int> signal_ = 0;
    sigset_t signals_;
    std::jthread thread_;
};

}  // namespace petzval::apps
