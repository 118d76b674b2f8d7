// SPDX-License-Identifier: Apache-2.0
#include "apps/python/aside.h"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace petzval::apps {

namespace py = pybind11;

void require_own_threads() {
    static const pid_t first = ::getpid();
    if (::getpid() != first)
        throw ForkedError(
            "this process was forked from one that has rendered, and lacks its threads; start it "
            "by multiprocessing.get_context(\"spawn\"), or render in the child alone");
}

void run_aside(const std::function<void()>& work, const std::function<void()>& tick,
               const std::function<void()>& stop) {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::exception_ptr of_work, of_caller;
    std::thread worker([&] {
        try {
            work();
        } catch (...) {
            of_work = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        done = true;
        changed.notify_one();
    });
    for (;;) {
        {
            const py::gil_scoped_release released;
            std::unique_lock lock(mutex);
            if (changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return done; })) break;
        }
        if (of_caller) continue;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            tick();
        } catch (...) {
            of_caller = std::current_exception();
            stop();
        }
    }
    worker.join();
    if (of_caller) std::rethrow_exception(of_caller);
    if (of_work) std::rethrow_exception(of_work);
}

}  // namespace petzval::apps
