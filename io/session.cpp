// SPDX-License-Identifier: Apache-2.0
#include "io/session.h"

#include <fmt/format.h>

#include <chrono>

#include "io/camera_setup.h"
#include "io/environment.h"
#include "io/gltf.h"

namespace petzval {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// The sky that lights the scene: a picture, else the background's colour, else white where nothing
// else would shine.
Sky choose_sky(const SceneRequest& request, const Scene& scene,
               const std::function<void(const std::string&)>& notice) {
    if (request.environment)
        return load_sky(*request.environment, request.environment_rotate_deg,
                        request.environment_strength, notice);
    if (request.background) return Sky::uniform(*request.background);
    bool lit = !scene.lights.empty(), all_unlit = !scene.instances.empty();
    for (const Instance& instance : scene.instances) {
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        lit = lit || material.emits();
        all_unlit = all_unlit && material.unlit;
    }
    if (lit || all_unlit) return Sky();
    notice(
        "no light in the file: a uniform white environment of 1 nit is used (--background 1,1,1)");
    return Sky::uniform(Rgb(1.f));
}

// Of a file its name alone: equal renders in other folders are equal files.
std::vector<std::pair<std::string, std::string>> describe(const SceneRequest& request) {
    std::vector<std::pair<std::string, std::string>> m;
    m.emplace_back("petzval:scene", request.scene.filename().string());
    if (request.environment) {
        m.emplace_back("petzval:environment", request.environment->filename().string());
        m.emplace_back("petzval:environmentRotate_deg",
                       fmt::format("{:.9g}", request.environment_rotate_deg));
        m.emplace_back("petzval:environmentStrength",
                       fmt::format("{:.9g}", request.environment_strength));
    }
    if (const auto& b = request.background)
        m.emplace_back("petzval:background",
                       fmt::format("{:.9g},{:.9g},{:.9g}", (*b)[0], (*b)[1], (*b)[2]));
    m.emplace_back("petzval:lightChoice",
                   request.light_choice == LightChoiceKind::Power ? "power" : "uniform");
    m.emplace_back("petzval:traversal",
                   request.traversal == Traversal::Robust ? "robust" : "fast");
    return m;
}

}  // namespace

Session open_session(const SceneRequest& request,
                     const std::function<void(const std::string&)>& notice) {
    Session session;
    const auto load_start = Clock::now();
    GltfFile file = load_gltf(request.scene);
    for (const std::string& warning : file.warnings) notice("warning: " + warning);
    session.scene = std::make_unique<Scene>(std::move(file.scene));
    Scene& scene = *session.scene;
    session.scene_hash = file.hash;
    scene.sky = choose_sky(request, scene, notice);
    if (request.environment) session.backdrop = request.background;
    finish_scene(scene);
    if (scene.instances.empty())
        notice("warning: the scene is empty: only its background is rendered");
    SpectralSetup spectra = set_up_spectra(request.spectral, scene, notice);
    session.observer = std::move(spectra.observer);
    session.metadata = describe(request);
    session.metadata.insert(session.metadata.end(), spectra.metadata.begin(),
                            spectra.metadata.end());
    session.load_s = seconds_since(load_start);

    const auto bvh_start = Clock::now();
    session.bvh = std::make_unique<Bvh>(scene, request.traversal);
    session.lights = std::make_unique<LightChoice>(scene, request.light_choice);
    session.bvh_s = seconds_since(bvh_start);

    CameraSetup setup = set_up_camera(request, file.cameras, scene, *session.bvh, notice);
    session.camera = std::move(setup.camera);
    session.camera_report = setup.report;
    return session;
}

}  // namespace petzval
