// SPDX-License-Identifier: Apache-2.0
// Renders a scene through a real lens into memory:  in_memory SCENE.glb
#include <cstdio>
#include <exception>
#include <vector>

#include "apps/render/render_session.h"

using namespace petzval;

int main(int count, char** words) try {
    if (count != 2) return std::fputs("in_memory SCENE.glb\n", stderr), 2;
    apps::RenderRequest request;
    request.scene.scene = words[1];
    request.scene.size = {96, 64};
    request.scene.camera.lens = "double-gauss-100mm-f2";
    request.samples.count = 16;

    apps::RenderSession session(2);
    session.prepare(request, [](const std::string& line) { std::puts(line.c_str()); });
    integrator::RenderMonitor monitor;
    session.render(monitor);

    const io::PictureRows picture = session.light();
    std::vector<float> row(picture.layout.channels.size() * size_t(picture.layout.width));
    double nits = 0;
    for (int y = 0; y < picture.layout.height; ++y) {
        picture.row(y, row.data());
        for (size_t x = 0; x < row.size(); x += picture.layout.channels.size())
            nits += double(row[x + 1]) / (96 * 64);  // R, G, B, A: green
    }
    std::printf("mean of green: %.4g nits\n", nits);
    return nits > 0 ? 0 : 1;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
