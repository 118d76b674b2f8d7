// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/camera_setup.h"

#include <fmt/format.h>

#include <limits>

#include "apps/setup/camera/framing.h"
#include "apps/setup/camera/thin_setup.h"
#include "camera/models/zoom_camera.h"
#include "core/scene/motion.h"
#include "integrator/prepass/autofocus.h"
#include "io/base/error.h"
#include "io/base/format.h"

namespace petzval::apps {
namespace {

V3f position(const M44f& m) {
    return {m[3][0], m[3][1], m[3][2]};
}
V3f forward(const M44f& m) {
    return {-m[2][0], -m[2][1], -m[2][2]};
}
// Input of the steps below.
struct CameraContext {
    const CameraModel& model;
    const std::string& scene_file;
    V2i size;
    const Scene& scene;
    const Bvh& bvh;
    const io::Notice& notice;

    [[nodiscard]] float aspect() const {
        return static_cast<float>(size.x) / static_cast<float>(size.y);
    }
    [[nodiscard]] io::ArgumentError unfit(const std::string& why) const {
        return {scene_file, "", why};
    }
};

// The view of a camera that is still to be placed.
struct UnplacedView {
    float yfov_rad;          ///< when it is focused far away
    double stand_back_m;     ///< what its focal length takes from the angle of view when it is near
    std::string fov_option;  ///< what gives the same angle of view again
};

// Eye and target that frame the scene.
std::array<V3f, 2> framed(const CameraContext& at, const UnplacedView& view) {
    const auto aim = frame_scene(at.scene, view.yfov_rad, at.aspect(), view.stand_back_m,
                                 at.model.asked.orbit_deg.has_value());
    if (!aim) throw at.unfit("is too large or too far away to be framed; give ⟨look-at⟩");
    at.notice(fmt::format("no camera in the file: ⟨look-at⟩ {},{}{}", io::with_commas((*aim)[0]),
                          io::with_commas((*aim)[1]), view.fov_option));
    return *aim;
}

// A pose turned about the vertical axis that is asked for, or through a point; noted in the report.
M44f turned(const CameraContext& at, M44f to_world, const V3f& about, CameraReport& report) {
    const CameraRequest& asked = at.model.asked;
    report.orbit_about = asked.orbit_about.value_or(about);
    if (asked.orbit_deg) {
        M44f there, turn, back;
        there.setTranslation(-report.orbit_about);
        turn.rotate(V3f(0, *asked.orbit_deg * kDegree_rad, 0));
        back.setTranslation(report.orbit_about);
        to_world = to_world * there * turn * back;
        report.target = report.target * (there * turn * back);
    }
    report.eye = position(to_world);
    report.to_world = to_world;
    return to_world;
}

// Pose of the camera, also noted in the report.
M44f stand(const CameraContext& at, const UnplacedView& view, CameraReport& report) {
    const CameraRequest& asked = at.model.asked;
    const V3f middle = at.scene.bounds.isEmpty() ? V3f(0.f) : at.scene.bounds.center();
    const io::GltfCamera* const from = at.model.from;
    if (from) report.name = from->name;
    if (from && !asked.pose) {
        report.target = position(from->to_world) + forward(from->to_world);
        return turned(at, from->to_world, middle, report);
    }
    if (asked.pose) {
        report.target = position(*asked.pose) + forward(*asked.pose);
        return turned(at, *asked.pose, middle, report);
    }
    const auto aim = asked.look_at ? *asked.look_at : framed(at, view);
    report.target = aim[1];
    return turned(at, camera::look_at(aim[0], aim[1]), asked.look_at ? aim[1] : middle, report);
}

using Finder = std::function<std::unique_ptr<camera::Camera>(std::optional<float> focus_m)>;

float depth_of(const CameraContext& at, const Focus& focus, const M44f& to_world,
               const camera::Camera& finder) {
    const V3f eye = position(to_world), axis = forward(to_world);
    if (const auto* pixel = std::get_if<FocusPixel>(&focus)) {
        const V2f film = (V2f(pixel->x, pixel->y) + V2f(0.5f)) / V2f(at.size);
        const auto depth = integrator::depth_under(at.scene, at.bvh, finder, eye, axis, film);
        if (!depth)
            throw at.unfit(
                fmt::format("nothing to focus on under pixel {},{}; give ⟨focus⟩ in metres, or a "
                            "pixel that shows something",
                            pixel->x, pixel->y));
        return *depth;
    }
    const auto depth = integrator::depth_of_middle(at.scene, at.bvh, finder, eye, axis);
    if (!depth)
        throw at.unfit("nothing in the middle of the picture to focus on; give ⟨focus⟩ in metres");
    return *depth;
}

// Distance in focus. finder: makes a camera of narrow iris that shows what the real one will when
// it is focused there, or far away. What a pixel shows moves with the focus, as the film goes back:
// the depth is measured again until it stays, or jumps to and fro between two things.
float find_focus(const CameraContext& at, const M44f& to_world, const Finder& finder) {
    constexpr int kRounds = 8;
    constexpr float kSettled = 1e-5f;
    const Focus focus = at.model.asked.focus.value_or(FocusAuto{});
    if (const auto* distance = std::get_if<FocusDistance>(&focus)) return distance->m;
    float depth_m = depth_of(at, focus, to_world, *finder(std::nullopt));
    for (int i = 0; i < kRounds; ++i) {
        const float before_m = depth_m;
        depth_m = depth_of(at, focus, to_world, *finder(before_m));
        if (std::fabs(depth_m - before_m) <= kSettled * before_m) break;
    }
    if (depth_m > kFarthestFocus_m) {
        at.notice("focus: infinity (⟨focus⟩ infinity)");
        return std::numeric_limits<float>::infinity();
    }
    at.notice(fmt::format("focus: {:.4g} m (⟨focus⟩ {})", depth_m, depth_m));
    return depth_m;
}

// Camera whose view changes while the shutter is open; nullptr where it does not. make: a camera
// for a view of the file's camera, as at one of the steps.
template <class Make>
std::unique_ptr<camera::Camera> zooming(const CameraContext& at, const io::GltfCamera* from,
                                        Make make) {
    if (!from || from->zoom.empty() || !at.model.asked.shutter_curve) return nullptr;
    std::vector<std::unique_ptr<camera::Camera>> at_steps;
    io::GltfCamera now = *from;
    for (const float view : from->zoom) {
        (now.orthographic ? now.ymag_m : now.yfov_rad) = view;
        at_steps.push_back(make(now));
    }
    return std::make_unique<camera::ZoomCamera>(std::move(at_steps));
}

// Tells that a lens does not zoom as the file's camera does.
void tell_of_held_zoom(const CameraContext& at) {
    if (at.model.from && !at.model.from->zoom.empty() && at.model.asked.shutter_curve)
        at.notice(
            "the camera zooms while the shutter is open, but its lens cannot: the angle of "
            "view stays as in the middle of the exposure");
}

CameraSetup orthographic(const CameraContext& at, const io::GltfCamera& from) {
    CameraSetup setup;
    setup.report.asked = at.model.asked;
    setup.report.orthographic = true;
    setup.report.ymag_m = from.ymag_m;
    const M44f to_world = stand(at, {}, setup.report);
    // The picture's aspect wins over the file's; the height stays.
    const auto camera = [&](const io::GltfCamera& view) {
        return std::make_unique<camera::OrthographicCamera>(to_world, view.ymag_m * at.aspect(),
                                                            view.ymag_m);
    };
    setup.camera = zooming(at, &from, camera);
    setup.zooms = setup.camera != nullptr;
    if (!setup.zooms) setup.camera = camera(from);
    setup.finder = camera(from);
    return setup;
}

CameraSetup with_lens(const CameraContext& at, const LoadedLens& loaded) {
    CameraSetup setup;
    CameraReport& report = setup.report;
    report.asked = at.model.asked;
    if (report.asked.fit == Fit::Fov && !report.asked.fov_deg) tell_of_held_zoom(at);
    report.dispersive_lens = at.model.dispersive_lens();
    report.yfov_deg = loaded.yfov_rad / kDegree_rad;
    const M44f to_world = stand(at, {loaded.yfov_rad, 1e-3 * loaded.focal_length_mm, ""}, report);
    report.focus_m = find_focus(at, to_world, [&](std::optional<float> focus_m) {
        return viewfinder(loaded, to_world, focus_m);
    });
    LensSetup lens = set_up_lens(report.asked, loaded, to_world, report.focus_m, at.notice);
    report.lens = loaded.name();
    report.traced = true;
    report.focal_length_mm = static_cast<float>(loaded.focal_length_mm);
    report.sensor_mm = loaded.film_mm;
    report.film_mm = lens.film_mm;
    report.stop_radius_mm = lens.stop_radius_mm;
    report.lens_radius_m = static_cast<float>(loaded.focal_length_mm * 1e-3 / (2 * lens.fnumber));
    setup.camera = std::move(lens.camera);
    setup.finder = viewfinder(loaded, to_world, report.focus_m);
    return setup;
}

// Camera without a prescription with the angle of view of another moment.
std::unique_ptr<camera::Camera> thin_camera_at(const CameraContext& at, const io::GltfCamera& now,
                                               camera::ThinLens pose,
                                               std::optional<float> focus_m) {
    CameraModel model = at.model;
    model.from = &now;
    const ThinView view = thin_view(model, at.scene_file, at.aspect());
    pose.yfov_rad = yfov_at_rad(view, focus_m);
    return set_up_thin(model, view, std::move(pose), focus_m, at.notice).camera;
}

CameraSetup without_prescription(const CameraContext& at) {
    CameraSetup setup;
    CameraReport& report = setup.report;
    report.asked = at.model.asked;
    report.dispersive_lens = at.model.dispersive_lens();
    const ThinView view = thin_view(at.model, at.scene_file, at.aspect());
    report.sensor_mm = view.sensor_mm;
    report.yfov_deg = view.yfov_deg;
    const UnplacedView unplaced =
        view.angle_by_focal
            ? UnplacedView{view.yfov_rad, at.model.has_iris() ? 1e-3 * *view.focal_mm : 0, ""}
            : UnplacedView{view.yfov_rad, 0, fmt::format(" ⟨fov⟩ {}", view.yfov_deg)};
    camera::ThinLens pose;
    pose.aspect = at.aspect();
    pose.to_world = stand(at, unplaced, report);
    std::optional<float> focus_m = view.focus_m;
    if (at.model.has_iris() && !focus_m)
        focus_m = find_focus(at, pose.to_world, [&](std::optional<float> focused_m) {
            camera::ThinLens finder = pose;
            finder.yfov_rad = yfov_at_rad(view, focused_m);
            return std::make_unique<camera::ThinLensCamera>(finder);
        });
    pose.yfov_rad = yfov_at_rad(view, focus_m);
    if (pose.yfov_rad != view.yfov_rad) report.yfov_deg = pose.yfov_rad / kDegree_rad;
    ThinSetup thin = set_up_thin(at.model, view, pose, focus_m, at.notice);
    report.focus_m = focus_m.value_or(0);
    report.focal_length_mm = static_cast<float>(thin.focal_mm);
    report.lens_radius_m = static_cast<float>(thin.lens_radius_m);
    if (report.asked.natural_vignetting || report.asked.exposure == ExposureMode::Photographic)
        report.natural_vignetting = thin.natural_vignetting;
    if (std::holds_alternative<SingleLens>(at.model.optics)) {
        report.lens = *report.asked.lens;
        report.film_mm = thin.film_mm;
        report.stop_radius_mm = 1e3 * thin.lens_radius_m;
    }
    setup.camera = std::move(thin.camera);
    if (view.angle_of_file && std::holds_alternative<SingleLens>(at.model.optics))
        tell_of_held_zoom(at);
    else if (view.angle_of_file)
        if (auto camera = zooming(at, at.model.from, [&](const io::GltfCamera& now) {
                return thin_camera_at(at, now, pose, focus_m);
            })) {
            setup.camera = std::move(camera);
            setup.zooms = true;
        }
    setup.finder = std::make_unique<camera::ThinLensCamera>(pose);
    return setup;
}

CameraSetup still_camera(const CameraContext& at) {
    const CameraModel& model = at.model;
    if (model.from && model.from->orthographic) return orthographic(at, *model.from);
    if (const auto* lens = std::get_if<LoadedLens>(&model.optics)) return with_lens(at, *lens);
    return without_prescription(at);
}

// The shutter, where something moves while it is open.
std::shared_ptr<const camera::Shutter> shutter_of(const CameraModel& model, const Scene& scene,
                                                  bool zooms) {
    const io::GltfCamera* const carrier = model.asked.pose ? nullptr : model.from;
    const bool moves = zooms || (carrier && !carrier->steps.empty());
    if (!model.asked.shutter_curve || !(moves || has_motion(scene))) return nullptr;
    return shutter_with(*model.asked.shutter_curve, carrier, carrier ? carrier->to_world : M44f());
}

}  // namespace

std::shared_ptr<const camera::Shutter> shutter_with(const camera::ShutterCurve& curve,
                                                    const io::GltfCamera* camera,
                                                    const M44f& in_the_middle) {
    std::vector<M44f> steps;
    if (camera) steps = camera->steps;
    if (camera && steps.empty()) steps = {camera->to_world, camera->to_world};
    return std::make_shared<const camera::Shutter>(curve, steps, in_the_middle);
}

CameraSetup set_up_camera(const CameraModel& model, const std::string& scene_file, V2i size,
                          const Scene& scene, const Bvh& bvh, const io::Notice& notice) {
    const CameraContext at{model, scene_file, size, scene, bvh, notice};
    CameraSetup setup = still_camera(at);
    setup.shutter = shutter_of(model, scene, setup.zooms);
    return setup;
}

}  // namespace petzval::apps
