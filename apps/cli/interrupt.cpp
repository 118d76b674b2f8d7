// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/interrupt.h"

#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <limits>
#include <optional>

#include "apps/cli/exit_code.h"

namespace petzval::apps {
namespace {

struct Known {
    int signal;
    const char* name;
    /// Time after the first signal in which this one is the same wish, not a second one.
    double same_s;
};
constexpr double kAtOnce_s = 0.1;  // timeout(1) and systemd send two at once
constexpr double kHangup_s = 1;    // a shell passes it on, then the kernel sends it again
constexpr double kAlways_s = std::numeric_limits<double>::infinity();  // setrlimit(2): each second
constexpr std::array<Known, 6> kSignals{{{SIGINT, "SIGINT", kAtOnce_s},
                                         {SIGTERM, "SIGTERM", kAtOnce_s},
                                         {SIGHUP, "SIGHUP", kHangup_s},
                                         {SIGXCPU, "SIGXCPU", kAlways_s},
                                         {SIGUSR1, "SIGUSR1", kAtOnce_s},
                                         {SIGUSR2, "SIGUSR2", kAtOnce_s}}};

/// Wakes the thread when the object goes. SIGRTMIN is none that anybody sends to stop a program.
int wake_signal() {
    return SIGRTMIN;
}

bool is_ignored(int signal) {
    struct sigaction now {};
    return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Handler for threads that were there before the signals were blocked, as some libraries start at
/// load: blocks the signal in its thread too, and passes it on to the one that waits.
void pass_on(int signal, siginfo_t*, void* context) {
    sigaddset(&static_cast<ucontext_t*>(context)->uc_sigmask, signal);
    ::kill(::getpid(), signal);
}

const Known* find(int signal) {
    for (const Known& known : kSignals)
        if (known.signal == signal) return &known;
    return nullptr;
}

}  // namespace

Interrupt::Interrupt() {
    sigemptyset(&signals_);
    struct sigaction passing {};
    passing.sa_sigaction = pass_on;
    passing.sa_flags = SA_SIGINFO | SA_RESTART;
    for (const Known& known : kSignals) {
        if (is_ignored(known.signal)) continue;
        sigaddset(&signals_, known.signal);
        ::sigaction(known.signal, &passing, nullptr);
    }
    sigaddset(&signals_, wake_signal());
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

// The signals stay blocked: what comes now comes to a program that is done.
Interrupt::~Interrupt() {
    thread_.request_stop();
    pthread_kill(thread_.native_handle(), wake_signal());
    thread_.join();
}

const char* Interrupt::signal_name() const {
    const Known* known = find(signal_);
    return known ? known->name : nullptr;
}

void Interrupt::watch(const std::stop_token& stop) {
    std::optional<double> first_s;
    for (;;) {
        int signal = 0;
        sigwait(&signals_, &signal);
        if (stop.stop_requested()) return;
        const Known* known = find(signal);
        if (!known) continue;
        if (!armed_) _exit(kStopped);
        if (!first_s) {
            first_s = integrator::steady_s();
            signal_ = signal;
            monitor_.stop = true;
        } else if (integrator::steady_s() - *first_s > known->same_s) {
            _exit(kStopped);
        }
    }
}

}  // namespace petzval::apps
