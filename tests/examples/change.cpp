// SPDX-License-Identifier: Apache-2.0
// Changes the exposure, then the camera, of a render:  change SCENE.glb FOLDER
#include <cstdio>
#include <exception>

#include "apps/render/render_session.h"

using namespace petzval;

int main(int count, char** words) try {
    if (count != 3) return std::fputs("change SCENE.glb FOLDER\n", stderr), 2;
    const std::filesystem::path folder = words[2];
    apps::RenderRequest request;
    request.scene.scene = words[1];
    request.scene.size = {96, 64};
    request.samples.count = 8;

    apps::RenderSession session(2);
    const auto render = [&](const char* name) {
        session.prepare(request, [](const std::string&) {});
        const auto* const scene = session.setup().prepared.scene.get();
        const auto before = session.film().taken_count();
        integrator::RenderMonitor monitor;
        session.render(monitor);
        session.write(folder / name);
        std::printf("%s: scene %p, samples before %llu\n", name, static_cast<const void*>(scene),
                    static_cast<unsigned long long>(before));
    };
    render("first.png");
    request.display.exposure = apps::ExposureRequest{false, 1};  // keeps the samples
    render("brighter.png");
    request.scene.camera.fov_deg = 30;  // keeps the scene and its BVH
    render("nearer.png");
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
