// SPDX-License-Identifier: Apache-2.0
// Photographs a scene through a lens:  photograph SCENE.glb PICTURE
#include <apps/render/render_session.h>

#include <cstdio>
#include <exception>

int main(int count, char** words) try {
    if (count != 3) return std::fputs("photograph SCENE.glb PICTURE\n", stderr), 2;
    petzval::apps::RenderRequest request;
    request.scene.scene = words[1];
    request.scene.size = {96, 64};
    request.scene.camera.lens = "double-gauss-100mm-f2";
    request.samples.count = 16;

    petzval::apps::RenderSession session(2);
    session.prepare(request, [](const std::string& line) { std::puts(line.c_str()); });
    petzval::integrator::RenderMonitor monitor;
    session.render(monitor);
    session.write(words[2]);
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
