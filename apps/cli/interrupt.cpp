// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/interrupt.h"

#include <unistd.h>

namespace petzval {

Interrupt::Interrupt(RenderMonitor& monitor) : monitor_(monitor) {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

Interrupt::~Interrupt() {
    thread_.request_stop();
    pthread_kill(thread_.native_handle(), SIGTERM);  // wakes that thread only
    thread_.join();
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
}

void Interrupt::watch(const std::stop_token& stop) {
    for (;;) {
        int signal = 0;
        sigwait(&signals_, &signal);
        if (stop.stop_requested()) return;
        if (!armed_ || monitor_.stop) _exit(130);
        monitor_.stop = true;
    }
}

}  // namespace petzval
