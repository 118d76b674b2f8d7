// SPDX-License-Identifier: Apache-2.0
// Cancels a render after 10 ms, goes on with it, and writes it:  cancel SCENE.glb PICTURE.exr
#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>

#include "apps/render/render_session.h"

using namespace petzval;

int main(int count, char** words) try {
    if (count != 3) return std::fputs("cancel SCENE.glb PICTURE.exr\n", stderr), 2;
    apps::RenderRequest request;
    request.scene.scene = words[1];
    request.scene.size = {320, 180};
    request.samples.count = 64;

    apps::RenderSession session(2);
    session.prepare(request, [](const std::string&) {});
    integrator::RenderMonitor monitor;
    std::jthread watch([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        monitor.stop = true;
    });
    const bool stopped = session.render(monitor).stopped;
    watch.join();
    std::printf("stopped: %d, samples of all pixels: %llu\n", stopped,
                static_cast<unsigned long long>(session.film().taken_count()));

    integrator::RenderMonitor patient;
    session.render(patient);
    session.write(words[2]);
    return stopped ? 0 : 1;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
