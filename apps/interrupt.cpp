// SPDX-License-Identifier: Apache-2.0
#include "apps/interrupt.h"

#include <unistd.h>

#include <ctime>

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
    thread_.join();
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
}

void Interrupt::watch(const std::stop_token& stop) {
    const timespec patience{0, 50'000'000};
    while (!stop.stop_requested()) {
        if (sigtimedwait(&signals_, nullptr, &patience) < 0) continue;
        if (!armed_ || monitor_.stop) _exit(130);
        monitor_.stop = true;
    }
}

}  // namespace petzval
