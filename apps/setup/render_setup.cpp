// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/render_setup.h"

#include <fmt/format.h>

#include <chrono>

#include "apps/setup/camera_setup.h"
#include "io/base/format.h"
#include "io/base/read_file.h"
#include "io/gltf/gltf.h"
#include "io/image/environment.h"

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

std::string word_of(LightChoiceKind kind) {
    switch (kind) {
        case LightChoiceKind::Power:
            return "power";
        case LightChoiceKind::Uniform:
            return "uniform";
        case LightChoiceKind::Tree:
            break;
    }
    return "tree";
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
    if (const auto& b = request.background) m.emplace_back("petzval:background", with_commas(*b));
    m.emplace_back("petzval:lightChoice", word_of(request.light_choice));
    m.emplace_back("petzval:traversal", request.traversal == Traversal::Robust ? "robust" : "fast");
    return m;
}

bool same(const std::optional<Rgb>& a, const std::optional<Rgb>& b) {
    return a.has_value() == b.has_value() &&
           (!a || (a->v[0] == b->v[0] && a->v[1] == b->v[1] && a->v[2] == b->v[2]));
}

bool same_scene(const SceneRequest& a, const SceneRequest& b) {
    return a.scene == b.scene && a.environment == b.environment &&
           a.environment_rotate_deg == b.environment_rotate_deg &&
           a.environment_strength == b.environment_strength && same(a.background, b.background);
}

void load(SceneRequest request, Session& session,
          const std::function<void(const std::string&)>& notice) {
    GltfFile file = load_gltf(request.scene);
    for (const std::string& warning : file.warnings) notice("warning: " + warning);
    auto scene = std::make_shared<Scene>(std::move(file.scene));
    session.scene_hash = file.hash;
    session.cameras = std::make_shared<std::vector<GltfCamera>>(std::move(file.cameras));
    if (!request.environment && !request.background && is_dark(*scene)) {
        request.background = Rgb(1.f);
        notice(
            "no light in the file: a uniform white environment of 1 nit is used (--background "
            "1,1,1)");
    }
    session.background = request.background;
    scene->sky = sky_of(request, notice);
    finish_scene(*scene);
    if (scene->instances.empty())
        notice("warning: the scene is empty: only its background is rendered");
    session.scene = std::move(scene);
}

}  // namespace

Session open_session(const SceneRequest& asked,
                     const std::function<void(const std::string&)>& notice, const Session* like) {
    Session session;
    session.asked = asked;
    const auto load_start = Clock::now();
    const bool shares = like != nullptr && same_scene(asked, like->asked);
    if (shares) {
        session.cameras = like->cameras;
        session.scene = like->scene;
        session.background = like->background;
        session.scene_hash = like->scene_hash;
    } else {
        load(asked, session, notice);
    }
    SceneRequest request = asked;
    request.background = session.background;
    if (request.environment) session.visible_background = request.background;
    const Scene& scene = *session.scene;
    const CameraModel plan = choose_camera_model(
        request.camera, request.scene, *session.cameras,
        static_cast<float>(request.size.x) / static_cast<float>(request.size.y));
    request.spectral.dispersive_lens = plan.dispersive_lens();
    SpectralSetup spectra = set_up_spectra(request.spectral, scene, notice);
    session.observer = std::move(spectra.observer);
    session.scale = std::move(spectra.scale);
    session.dispersive_lens = request.spectral.dispersive_lens;
    session.depends = std::move(spectra.depends);
    session.spectral_decision = std::move(spectra.decision);
    session.metadata = describe(request);
    session.metadata.insert(session.metadata.end(), spectra.metadata.begin(),
                            spectra.metadata.end());
    session.load_s = seconds_since(load_start);

    const auto bvh_start = Clock::now();
    session.bvh = shares && asked.traversal == like->asked.traversal
                      ? like->bvh
                      : std::make_shared<const Bvh>(scene, request.traversal);
    session.lights = shares && asked.light_choice == like->asked.light_choice
                         ? like->lights
                         : std::make_shared<const LightChoice>(scene, request.light_choice);
    session.bvh_s = seconds_since(bvh_start);

    CameraSetup setup =
        set_up_camera(plan, request.scene.string(), request.size, scene, *session.bvh, notice);
    session.camera = std::move(setup.camera);
    session.camera_report = std::move(setup.report);
    return session;
}

}  // namespace petzval
