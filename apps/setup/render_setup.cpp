// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/render_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "apps/request/option_names.h"
#include "apps/setup/camera/camera_model.h"
#include "apps/setup/camera/camera_setup.h"
#include "apps/setup/diffraction.h"
#include "apps/setup/ghosts.h"
#include "apps/setup/glass_remarks.h"
#include "apps/setup/input_files.h"
#include "camera/models/moving_camera.h"
#include "camera/ray_bundle.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/target_grid.h"
#include "core/light/own_light.h"
#include "core/scene/studio.h"
#include "integrator/prepass/highlights.h"
#include "integrator/prepass/light_pilot.h"
#include "integrator/prepass/target_pilot.h"
#include "integrator/render/executor.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/printable.h"
#include "io/file/read_file.h"
#include "io/gltf/gltf.h"
#include "io/image/environment.h"

namespace petzval::apps {
namespace {

using Clock = std::chrono::steady_clock;

/// Clusters of the lamps of a class of brightness that may be targets.
constexpr size_t kMostTargets = 4096;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Lights a scene by the studio where nobody asked for light and the file has none, or too little.
void add_missing_light(SceneRequest& request, const Scene& scene, const io::Notice& notice) {
    if (request.environment || request.background || !scene.sky.black()) return;
    const OwnLight own = own_light(scene);
    if (own == OwnLight::Enough) return;
    request.environment = kStudioLight;
    if (own == OwnLight::None)
        notice(
            fmt::format("nothing lights this scene, so the built-in studio light is used (⟨env⟩ "
                        "{}); give ⟨env⟩ FILE or ⟨background⟩ R,G,B for another",
                        kStudioLight));
    else
        notice(
            fmt::format("what glows in this scene hardly lights it, so the built-in studio light "
                        "is used too (⟨env⟩ {}); give ⟨env⟩ FILE or ⟨background⟩ R,G,B for "
                        "another, ⟨background⟩ 0,0,0 for none",
                        kStudioLight));
}

// Takes the sky that the file asks for, where the user asks for none.
void take_sky_of_file(const io::SceneExtras& file, SceneRequest& request,
                      const io::Notice& notice) {
    if (!file.sky || request.environment || request.background) return;
    const auto folder = request.scene.parent_path(), path = folder / *file.sky;
    const auto refuse = [&](const char* why) {
        return io::InputError(request.scene.string(), file.path + "/sky",
                              fmt::format("\"{}\" {}", io::printable(*file.sky), why));
    };
    if (request.scope == io::FileScope::Confined && !io::lies_within(path, folder))
        throw refuse("lies outside the folder of the scene, and ⟨confine⟩ allows no file there");
    if (std::filesystem::path(*file.sky).is_absolute())
        throw refuse("is an absolute path, which is not read; put the file beside the scene");
    request.environment = path;
    request.environment_rotate_deg = file.sky_rotation_deg;
    notice(
        fmt::format("the scene asks for its sky, {}, turned by {:g} degrees (⟨env⟩ FILE or "
                    "⟨background⟩ R,G,B give another)",
                    io::printable(*file.sky), file.sky_rotation_deg));
}

Sky sky_of(const SceneRequest& request, const io::Notice& notice, io::PictureBudget& pictures) {
    if (request.environment == kStudioLight)
        return studio_sky(request.environment_rotate_deg, request.environment_strength);
    if (request.environment)
        return io::load_sky(*request.environment, request.environment_rotate_deg,
                            request.environment_strength, notice, pictures);
    return request.background ? Sky::uniform(*request.background) : Sky();
}

// Points of a shutter curve as time:open, the time as a share of the whole.
std::string text_of(const camera::ShutterCurve& curve) {
    std::string text;
    for (const auto& [time, open] : curve.points)
        text += fmt::format("{}{:.6g}:{:.6g}", text.empty() ? "" : ",", time, open);
    return text;
}

std::vector<std::pair<std::string, std::string>> describe(const SceneRequest& request,
                                                          const std::string& environment) {
    std::vector<std::pair<std::string, std::string>> m;
    m.emplace_back("petzval:scene", request.scene.filename().string());
    if (const auto& variant = request.choices.variant)
        m.emplace_back("petzval:variant", io::visible(*variant));
    if (const auto& name = request.choices.scene)
        m.emplace_back("petzval:sceneName", io::visible(*name));
    if (const auto& radius_m = request.choices.point_line_radius_m)
        m.emplace_back("petzval:pointLineRadius_m", fmt::format("{:.9g}", *radius_m));
    if (const auto& animation = request.choices.animation) {
        m.emplace_back("petzval:time_s", fmt::format("{:.9g}", animation->time_s));
        m.emplace_back("petzval:loop", animation->repeats ? "1" : "0");
        if (const auto& curve = request.camera.shutter_curve) {
            m.emplace_back("petzval:shutterOpen_s", fmt::format("{:.9g}", animation->open_s));
            m.emplace_back("petzval:shutterCurve", text_of(*curve));
        }
        if (!animation->names.empty())
            m.emplace_back("petzval:animations",
                           io::visible(fmt::format("{}", fmt::join(animation->names, ", "))));
    }
    if (request.environment) {
        m.emplace_back("petzval:environment", environment);
        m.emplace_back("petzval:environmentRotate_deg",
                       fmt::format("{:.9g}", request.environment_rotate_deg));
        m.emplace_back("petzval:environmentStrength",
                       fmt::format("{:.9g}", request.environment_strength));
    }
    if (const auto& b = request.background)
        m.emplace_back("petzval:background", io::with_commas(*b));
    m.emplace_back("petzval:lightChoice", name_of(request.lights()));
    m.emplace_back("petzval:targets", name_of(request.targets));
    m.emplace_back("petzval:traversal", name_of(request.traversal));
    return m;
}

bool same(const std::optional<Rgb>& a, const std::optional<Rgb>& b) {
    return a.has_value() == b.has_value() &&
           (!a || (a->v[0] == b->v[0] && a->v[1] == b->v[1] && a->v[2] == b->v[2]));
}

bool same_scene(const SceneRequest& a, const SceneRequest& b) {
    return a.scene == b.scene && a.choices == b.choices && a.environment == b.environment &&
           a.environment_rotate_deg == b.environment_rotate_deg &&
           a.environment_strength == b.environment_strength && same(a.background, b.background);
}

io::GltfFile load_file(const SceneRequest& request, io::PictureBudget& pictures,
                       FrameReuse* frames) {
    if (!frames) return io::load_gltf(request.scene, request.scope, pictures, request.choices);
    auto& reader = frames->reader;
    if (!reader)
        reader = std::make_unique<io::GltfReader>(request.scene, request.scope, request.choices);
    return reader->load(pictures,
                        request.choices.animation ? request.choices.animation->time_s : 0);
}

// Takes the sky that is asked for; of a sequence, that of the frame before.
void take_sky(const SceneRequest& request, const io::Notice& notice, PreparedScene& out, Sky& sky,
              Scene* before, const std::string& text_before) {
    if (before && !text_before.empty()) {
        sky = std::move(before->sky);
        out.environment_text = text_before;
        return;
    }
    sky = sky_of(request, notice, out.pictures);
    if (request.environment)
        out.environment_text = request.environment == kStudioLight
                                   ? kStudioLight
                                   : io::name_and_hash(*request.environment);
}

// The scene with its sky, not yet its BVH and lights.
PreparedScene load(SceneRequest request, const io::Notice& notice, FrameReuse* frames) {
    PreparedScene out;
    // Taken out of the sequence: where this frame fails, the next must not find what is left of it.
    std::shared_ptr<Scene> before = frames ? std::exchange(frames->before, nullptr) : nullptr;
    if (before.use_count() > 1) before.reset();  // somebody looks at it still
    if (before) frames->reader->give_back(std::move(before->images));
    out.pictures = request.pictures();
    io::GltfFile file = load_file(request, out.pictures, frames);
    check_camera_files(request.scene, request.scope, file.cameras);
    out.files = input_files(file, request.scene);
    io::refuse_overwriting(request.outputs, out.files);
    for (const std::string& warning : file.warnings) notice("warning: " + warning);
    for (const std::string& remark : file.remarks) notice(remark);
    auto scene = std::make_shared<Scene>(std::move(file.scene));
    out.hash = file.hash;
    out.cameras = std::make_shared<std::vector<io::GltfCamera>>(std::move(file.cameras));
    take_sky_of_file(file.extras, request, notice);
    add_missing_light(request, *scene, notice);
    out.environment = request.environment;
    out.environment_rotate_deg = request.environment_rotate_deg;
    out.extras = std::move(file.extras);
    out.holds = std::make_shared<io::GltfSummary>(std::move(file.holds));
    out.lamp_unit_doubt = std::move(file.lamp_unit_doubt);
    if (request.environment || request.background)  // instead of the file's own
        take_sky(request, notice, out, scene->sky, before.get(),
                 frames ? frames->environment_text : "");
    finish_scene(*scene);
    if (scene->instances.empty())
        notice("warning: the scene is empty: only its background is rendered");
    if (frames) {
        frames->before = scene;
        frames->environment_text = out.environment_text;
    }
    out.scene = std::move(scene);
    return out;
}

/// Small bright things to which a camera sends rays, where that pays; nullptr: none.
std::shared_ptr<const camera::TargetGrid> targets_of(camera::TargetCamera& camera,
                                                     const camera::Camera& still, V2i size_px,
                                                     const PreparedScene& prepared,
                                                     std::vector<SmallFeature> features,
                                                     const std::function<void()>& next_step) {
    const Scene& scene = *prepared.scene;
    const auto run = integrator::run_here(next_step);
    const std::vector<SmallFeature> images =
        integrator::highlights(still, scene, *prepared.bvh, size_px, features, run);
    features.insert(features.end(), images.begin(), images.end());
    camera.set_targets(camera::find_targets(camera, size_px, features, run));
    return integrator::targets_that_pay(camera, scene, *prepared.bvh, *prepared.lights, size_px,
                                        run);
}

/// A camera that the shutter of a view moves; the same where nothing moves.
std::shared_ptr<const camera::Camera> moved(std::shared_ptr<const camera::Camera> camera,
                                            const View& view) {
    if (!view.shutter) return camera;
    return std::make_shared<camera::MovingCamera>(std::move(camera), view.shutter);
}

/// The camera that renders, from the one that stands still: aimed at targets and moved by a
/// shutter, where there are any. Returns the small features among which targets were looked for.
std::vector<SmallFeature> compose_camera(const SceneRequest& asked, const RenderSetup* like,
                                         const PreparedScene& prepared, double focus_m, View& view,
                                         const io::Notice& notice,
                                         const std::function<void()>& next_step) {
    std::vector<SmallFeature> features;
    view.camera = view.still;
    if (asked.targets == TargetUse::Auto)
        if (auto aims = camera::target_camera(view.still)) {
            const bool same = like && like->view.still &&
                              like->from.asked.targets == TargetUse::Auto &&
                              like->from.asked.size == asked.size &&
                              camera::has_same_rays(*view.still, *like->view.still);
            if (!same) features = small_features_of(*prepared.scene, kMostTargets);
            view.targets =
                same ? like->view.targets
                     : targets_of(*aims, *view.still, asked.size, prepared, features, next_step);
            aims->set_targets(view.targets);
            if (view.targets) view.camera = std::move(aims);
        }
    if (const auto remark = add_diffraction(asked, focus_m, like, prepared, view); remark && !like)
        notice(*remark);
    add_ghosts(asked.camera, like, prepared, next_step, view);
    next_step();
    view.camera = moved(std::move(view.camera), view);
    return features;
}

RenderSetup set_up(const SceneRequest& asked, const io::Notice& notice, const PhaseSink& begins,
                   const RenderSetup* like, FrameReuse* frames) {
    const auto begin = [&](Phase phase) {
        if (begins) begins(phase);
    };
    begin(Phase::Loading);
    RenderSetup setup;
    PreparedScene& prepared = setup.prepared;
    Provenance& from = setup.from;
    from.asked = asked;
    const auto load_start = Clock::now();
    const bool shares = like != nullptr && same_scene(asked, like->from.asked);
    prepared = shares ? like->prepared : load(asked, notice, frames);
    const Scene& scene = *prepared.scene;
    SceneRequest request = asked;
    request.environment = prepared.environment;
    request.environment_rotate_deg = prepared.environment_rotate_deg;
    request.camera.iris_pictures = prepared.pictures;
    if (request.environment) setup.view.visible_background = request.background;
    const CameraModel model = choose_camera_model(
        request.camera, request.scene, request.scope, *prepared.cameras,
        static_cast<float>(request.size.x) / static_cast<float>(request.size.y));
    SpectralSetup spectra = set_up_spectra(
        request.spectral, scene, model.dispersive_lens(),
        model.has_iris() && request.camera.diffraction == DiffractionUse::Auto, notice);
    setup.view.observer = std::move(spectra.observer);
    from.scale = std::move(spectra.scale);
    from.spectral = std::move(spectra.decision);
    from.metadata = describe(request, prepared.environment_text);
    from.metadata.insert(from.metadata.end(), spectra.metadata.begin(), spectra.metadata.end());
    from.load_s = seconds_since(load_start);

    begin(Phase::Bvh);
    const auto bvh_start = Clock::now();
    if (!shares || asked.traversal != like->from.asked.traversal)
        prepared.bvh = std::make_shared<const Bvh>(scene, request.traversal);
    if (!shares || asked.lights() != like->from.asked.lights())
        prepared.lights = std::make_shared<const LightChoice>(scene, request.lights());
    if (!shares) {
        prepared.lost_light = integrator::lost_light(scene, *prepared.bvh);
        for (const std::string& remark : glass_remarks(scene, prepared.lost_light))
            notice("warning: " + remark);
    }
    from.bvh_s = seconds_since(bvh_start);
    begin(Phase::Planning);

    CameraSetup camera =
        set_up_camera(model, request.scene.string(), request.size, scene, *prepared.bvh, notice);
    setup.view.still = std::move(camera.camera);
    setup.view.finder = std::move(camera.finder);
    setup.view.shutter = std::move(camera.shutter);
    if (model.from && !asked.camera.pose)
        setup.view.of_file = static_cast<size_t>(model.from - prepared.cameras->data());
    const auto next_step = [&] { begin(Phase::Planning); };
    next_step();
    if (prepared.lights->divides())
        prepared.lights = std::make_shared<const LightChoice>(integrator::fitted_by_pilot(
            *prepared.lights, scene, *prepared.bvh, *moved(setup.view.still, setup.view),
            setup.view.observer, request.size));
    next_step();
    const std::vector<SmallFeature> lamps =
        compose_camera(request, shares ? like : nullptr, prepared, double(camera.report.focus_m),
                       setup.view, notice, next_step);
    if (!shares)
        if (const auto remark = ghost_remark(request.camera, setup.view, lamps, *prepared.bvh))
            notice(*remark);
    from.camera = std::move(camera.report);
    return setup;
}

}  // namespace

RenderSetup set_up_render(const SceneRequest& asked, const io::Notice& notice,
                          const PhaseSink& begins, FrameReuse* frames) {
    return io::naming_file(asked.scene.string(),
                           [&] { return set_up(asked, notice, begins, nullptr, frames); });
}

std::unique_ptr<NextFrame> set_up_velocity(const RenderSetup& setup, double fps) {
    const SceneRequest& asked = setup.from.asked;
    const std::string file = asked.scene.string();
    if (!asked.choices.animation)
        throw io::ArgumentError(file, "", "⟨aov⟩ velocity needs a time: ⟨at⟩ 1s or ⟨frames⟩ 1:48");
    io::GltfChoices choices = asked.choices;
    choices.animation->time_s += 1 / fps;
    io::PictureBudget pictures = asked.picture_memory_bytes
                                     ? io::PictureBudget(*asked.picture_memory_bytes)
                                     : io::PictureBudget();
    auto out = std::make_unique<NextFrame>();
    out->file = io::load_gltf(asked.scene, asked.scope, pictures, choices);
    const Scene &now = *setup.prepared.scene, &next = out->file.scene;
    const auto triangles = [](const Scene& scene, size_t i) {
        return scene.meshes[scene.instances[i].mesh].triangles.size();
    };
    bool same = now.instances.size() == next.instances.size() &&
                setup.prepared.cameras->size() == out->file.cameras.size();
    for (size_t i = 0; same && i < now.instances.size(); ++i)
        same = triangles(now, i) == triangles(next, i);
    if (!same)
        throw io::ArgumentError(
            file, "",
            "⟨aov⟩ velocity: the next frame shows other meshes, so that nobody can "
            "tell how they move");
    const auto curve = asked.camera.shutter_curve.value_or(camera::ShutterCurve::box());
    const auto& of_file = setup.view.of_file;
    const io::GltfCamera* const before = of_file ? &(*setup.prepared.cameras)[*of_file] : nullptr;
    const io::GltfCamera* const after = of_file ? &out->file.cameras[*of_file] : nullptr;
    const M44f middle = before ? before->to_world : M44f();
    out->velocity = std::make_unique<integrator::Velocity>(
        now, next, *setup.view.finder, asked.size, shutter_with(curve, before, middle),
        shutter_with(curve, after, middle));
    return out;
}

RenderSetup set_up_view(const RenderSetup& like, const SceneRequest& asked,
                        const io::Notice& notice, const PhaseSink& begins) {
    return io::naming_file(asked.scene.string(),
                           [&] { return set_up(asked, notice, begins, &like, nullptr); });
}

}  // namespace petzval::apps
