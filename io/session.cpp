// SPDX-License-Identifier: Apache-2.0
#include "io/session.h"

#include <fmt/format.h>

#include <chrono>

#include "io/camera_setup.h"
#include "io/environment.h"
#include "io/gltf.h"
#include "io/numbers.h"
#include "io/read_file.h"

namespace petzval {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Whether a scene would be black by itself. What is unlit needs no light.
bool is_dark(const Scene& scene) {
    bool lit = !scene.lights.empty(), all_unlit = !scene.instances.empty();
    for (const Instance& instance : scene.instances) {
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        lit = lit || material.emits();
        all_unlit = all_unlit && material.unlit;
    }
    return !lit && !all_unlit;
}

Sky sky_of(const SceneRequest& request, const std::function<void(const std::string&)>& notice) {
    if (request.environment)
        return load_sky(*request.environment, request.environment_rotate_deg,
                        request.environment_strength, notice);
    return request.background ? Sky::uniform(*request.background) : Sky();
}

std::vector<std::pair<std::string, std::string>> describe(const SceneRequest& request) {
    std::vector<std::pair<std::string, std::string>> m;
    m.emplace_back("petzval:scene", request.scene.filename().string());
    if (request.environment) {
        m.emplace_back("petzval:environment", name_and_hash(*request.environment));
        m.emplace_back("petzval:environmentRotate_deg",
                       fmt::format("{:.9g}", request.environment_rotate_deg));
        m.emplace_back("petzval:environmentStrength",
                       fmt::format("{:.9g}", request.environment_strength));
    }
    if (const auto& b = request.background)
        m.emplace_back("petzval:background", with_commas(*b));
    m.emplace_back("petzval:lightChoice",
                   request.light_choice == LightChoiceKind::Power ? "power" : "uniform");
    m.emplace_back("petzval:traversal", request.traversal == Traversal::Robust ? "robust" : "fast");
    return m;
}

}  // namespace

Session open_session(const SceneRequest& asked,
                     const std::function<void(const std::string&)>& notice) {
    SceneRequest request = asked;
    Session session;
    const auto load_start = Clock::now();
    GltfFile file = load_gltf(request.scene);
    for (const std::string& warning : file.warnings) notice("warning: " + warning);
    session.scene = std::make_unique<Scene>(std::move(file.scene));
    Scene& scene = *session.scene;
    session.scene_hash = file.hash;
    if (!request.environment && !request.background && is_dark(scene)) {
        request.background = Rgb(1.f);
        notice(
            "no light in the file: a uniform white environment of 1 nit is used (--background "
            "1,1,1)");
    }
    scene.sky = sky_of(request, notice);
    if (request.environment) session.backdrop = request.background;
    finish_scene(scene);
    if (scene.instances.empty())
        notice("warning: the scene is empty: only its background is rendered");
    const CameraPlan plan =
        plan_camera(request.camera, request.scene, file.cameras,
                    static_cast<float>(request.size.x) / static_cast<float>(request.size.y));
    request.spectral.dispersive_lens = plan.dispersive_name();
    SpectralSetup spectra = set_up_spectra(request.spectral, scene, notice);
    session.observer = std::move(spectra.observer);
    session.scale = std::move(spectra.scale);
    session.metadata = describe(request);
    session.metadata.insert(session.metadata.end(), spectra.metadata.begin(),
                            spectra.metadata.end());
    session.load_s = seconds_since(load_start);

    const auto bvh_start = Clock::now();
    session.bvh = std::make_unique<Bvh>(scene, request.traversal);
    session.lights = std::make_unique<LightChoice>(scene, request.light_choice);
    session.bvh_s = seconds_since(bvh_start);

    CameraSetup setup =
        set_up_camera(plan, request.scene.string(), request.size, scene, *session.bvh, notice);
    session.camera = std::move(setup.camera);
    session.camera_report = std::move(setup.report);
    return session;
}

}  // namespace petzval
