// SPDX-License-Identifier: Apache-2.0
#include "io/camera_setup.h"

#include <fmt/format.h>

#include <charconv>

#include "camera/thin_lens.h"
#include "integrator/focus.h"
#include "io/error.h"

namespace petzval {
namespace {

using Notice = std::function<void(const std::string&)>;

constexpr float kDegree = kPi / 180.f;
constexpr float kDefaultFov_deg = 40.f;

V3f position(const M44f& m) {
    return {m[3][0], m[3][1], m[3][2]};
}
V3f forward(const M44f& m) {
    return {-m[2][0], -m[2][1], -m[2][2]};
}
std::string numbers(const V3f& v) {
    return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z);
}

const GltfCamera& find_camera(const SceneRequest& request, const std::vector<GltfCamera>& cameras) {
    const std::string& wanted = *request.camera;
    size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    for (const GltfCamera& camera : cameras)
        if (camera.name == wanted) return camera;
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < cameras.size())
        return cameras[index];
    std::string known;
    for (size_t i = 0; i < cameras.size(); ++i)
        known += fmt::format("{}{} \"{}\"", i ? ", " : "", i, cameras[i].name);
    throw InputError(
        request.scene.string(), "",
        fmt::format("no camera \"{}\"; {}", wanted,
                    known.empty() ? "the file has none, use --look-at" : "it has " + known));
}

// The bounding sphere just fits the smaller angle of view, seen a little from above and the right.
std::array<V3f, 2> frame_bounds(const Box3f& bounds, float yfov_rad, float aspect) {
    if (bounds.isEmpty()) return {V3f(0, 0, 1), V3f(0, 0, 0)};
    const V3f centre = bounds.center();
    const float radius = std::fmax((bounds.max - bounds.min).length() / 2, 1e-6f);
    const float half = std::atan(std::tan(yfov_rad / 2) * std::fmin(1.f, aspect));
    const V3f direction = unit({0.3f, 0.25f, 1.f});
    return {centre + direction * (radius / std::sin(half)), centre};
}

// The largest part of a sensor with the picture's aspect, width and height in mm.
V2f cropped_sensor_mm(const SceneRequest& request, float aspect) {
    const V2f full = request.sensor_mm.value_or(V2f(36.f, 24.f));
    return full.x / full.y > aspect ? V2f(full.y * aspect, full.y) : V2f(full.x, full.x / aspect);
}

float find_focus(const SceneRequest& request, const ThinLens& lens, const Bvh& bvh,
                 const Notice& notice) {
    if (const auto* distance = std::get_if<FocusDistance>(&request.focus)) return distance->m;
    ThinLens pinhole = lens;
    pinhole.radius_m = 0;
    const ThinLensCamera camera(pinhole);
    const V3f eye = position(lens.to_world), axis = forward(lens.to_world);
    std::optional<float> depth;
    if (const auto* pixel = std::get_if<FocusPixel>(&request.focus)) {
        const V2f film = V2f(pixel->x, pixel->y) / V2f(request.size);
        depth = depth_under(bvh, camera, eye, axis, film);
        if (!depth)
            throw InputError(
                request.scene.string(), "",
                fmt::format("nothing to focus on under pixel {:g},{:g}", pixel->x, pixel->y));
    } else {
        depth = depth_of_middle(bvh, camera, eye, axis);
        if (!depth)
            throw InputError(
                request.scene.string(), "",
                "nothing in the middle of the picture to focus on; give --focus in metres");
    }
    notice(fmt::format("focus: {:.4g} m (--focus {:.6g})", *depth, *depth));
    return *depth;
}

CameraSetup orthographic(const GltfCamera& from, float aspect) {
    CameraSetup setup;
    // The picture's aspect wins over the file's; the height stays.
    setup.camera =
        std::make_unique<OrthographicCamera>(from.to_world, from.ymag_m * aspect, from.ymag_m);
    setup.report.name = from.name;
    setup.report.orthographic = true;
    setup.report.eye = position(from.to_world);
    setup.report.target = setup.report.eye + forward(from.to_world);
    return setup;
}

}  // namespace

CameraSetup set_up_camera(const SceneRequest& request, const std::vector<GltfCamera>& cameras,
                          const Scene& scene, const Bvh& bvh, const Notice& notice) {
    const float aspect = static_cast<float>(request.size.x) / static_cast<float>(request.size.y);
    const bool has_lens = request.fstop || request.lens_radius_m;
    const GltfCamera* from = nullptr;
    if (request.camera)
        from = &find_camera(request, cameras);
    else if (!request.look_at && !cameras.empty())
        from = &cameras.front();

    if (from && from->orthographic) {
        if (has_lens)
            throw InputError(
                request.scene.string(), "",
                fmt::format("camera \"{}\" is orthographic and takes no lens", from->name));
        return orthographic(*from, aspect);
    }

    CameraSetup setup;
    CameraReport& report = setup.report;
    const V2f sensor_mm = cropped_sensor_mm(request, aspect);
    ThinLens lens;
    lens.aspect = aspect;
    if (request.fov_deg)
        lens.yfov_rad = *request.fov_deg * kDegree;
    else if (request.focal_length_mm)
        lens.yfov_rad = 2 * std::atan(sensor_mm.y / 2 / *request.focal_length_mm);
    else
        lens.yfov_rad = from ? from->yfov_rad : kDefaultFov_deg * kDegree;

    if (from) {
        lens.to_world = from->to_world;
        report.name = from->name;
        report.target = position(from->to_world) + forward(from->to_world);
    } else {
        const auto aim =
            request.look_at.value_or(frame_bounds(scene.bounds, lens.yfov_rad, aspect));
        lens.to_world = look_at(aim[0], aim[1]);
        report.target = aim[1];
        if (!request.look_at)
            notice(fmt::format("no camera in the file: --look-at {},{} --fov {:.6g}",
                               numbers(aim[0]), numbers(aim[1]), lens.yfov_rad / kDegree));
    }

    const float focal_mm =
        request.focal_length_mm.value_or(sensor_mm.y / 2 / std::tan(lens.yfov_rad / 2));
    if (request.lens_radius_m) lens.radius_m = *request.lens_radius_m;
    if (request.fstop) lens.radius_m = focal_mm * 1e-3f / (2 * *request.fstop);
    if (has_lens) lens.focus_m = find_focus(request, lens, bvh, notice);

    setup.camera = std::make_unique<ThinLensCamera>(lens);
    report.eye = position(lens.to_world);
    report.yfov_deg = lens.yfov_rad / kDegree;
    report.focal_length_mm = focal_mm;
    report.sensor_width_mm = sensor_mm.x;
    report.sensor_height_mm = sensor_mm.y;
    report.lens_radius_m = lens.radius_m;
    report.focus_m = has_lens ? lens.focus_m : 0.f;
    return setup;
}

}  // namespace petzval
