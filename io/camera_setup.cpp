// SPDX-License-Identifier: Apache-2.0
#include "io/camera_setup.h"

#include <fmt/format.h>

#include <charconv>

#include "camera/sensor.h"
#include "camera/thin_lens.h"
#include "integrator/focus.h"
#include "io/error.h"
#include "io/json_parse.h"

namespace petzval {
namespace {

using Notice = std::function<void(const std::string&)>;

constexpr float kDegree = kPi / 180.f;
constexpr float kDefaultFov_deg = 40.f;
// Embree takes coordinates up to about 1e18; the square of a distance must be a float as well.
constexpr float kFarthest_m = 1e16f;

V3f position(const M44f& m) {
    return {m[3][0], m[3][1], m[3][2]};
}
V3f forward(const M44f& m) {
    return {-m[2][0], -m[2][1], -m[2][2]};
}
// As few digits as give the same number when they are read again.
std::string numbers(const V3f& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

ArgumentError unfit(const SceneRequest& request, const std::string& why) {
    return {request.scene.string(), "", why};
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
        known += fmt::format("{}{} \"{}\"", i ? ", " : "", i, printable(cameras[i].name));
    throw unfit(request, fmt::format("no camera \"{}\"; {}", wanted,
                                     known.empty() ? "the file has none, use --look-at"
                                                   : "it has " + known));
}

// The bounding sphere just fits the smaller angle of view, seen a little from above and the right.
std::array<V3f, 2> frame_bounds(const SceneRequest& request, const Box3f& bounds, float yfov_rad,
                                float aspect) {
    if (bounds.isEmpty()) return {V3f(0, 0, 1), V3f(0, 0, 0)};
    const V3f centre = bounds.min / 2 + bounds.max / 2;
    const float radius = std::fmax((bounds.max / 2 - bounds.min / 2).length(), 1e-6f);
    const float half = std::atan(std::tan(yfov_rad / 2) * std::fmin(1.f, aspect));
    const float distance_m = radius / std::sin(half);
    const V3f eye = centre + unit({0.3f, 0.25f, 1.f}) * distance_m;
    if (!(std::fmax(distance_m, centre.length()) < kFarthest_m) || eye == centre)
        throw unfit(request, "is too large or too far away to be framed; give --look-at");
    return {eye, centre};
}

// Where no camera of the file has a say. Degrees, so that a printed angle is the same angle.
float chosen_fov_deg(const SceneRequest& request, const V2f& sensor_mm) {
    if (request.fov_deg) return *request.fov_deg;
    if (!request.focal_length_mm) return kDefaultFov_deg;
    const float fov_deg = 2 * std::atan(sensor_mm.y / 2 / *request.focal_length_mm) / kDegree;
    if (fov_deg < kSmallestFov_deg || fov_deg > kLargestFov_deg)
        throw unfit(request, fmt::format("--focal-length {} with a sensor {:g} mm high gives an "
                                         "angle of view of {:g} degrees; it must be {} to {}",
                                         *request.focal_length_mm, sensor_mm.y, fov_deg,
                                         kSmallestFov_deg, kLargestFov_deg));
    return fov_deg;
}

float find_focus(const SceneRequest& request, const ThinLens& lens, const Scene& scene,
                 const Bvh& bvh, const Notice& notice) {
    if (const auto* distance = std::get_if<FocusDistance>(&request.focus)) return distance->m;
    ThinLens pinhole = lens;
    pinhole.radius_m = 0;
    const ThinLensCamera camera(pinhole);
    const V3f eye = position(lens.to_world), axis = forward(lens.to_world);
    std::optional<float> depth;
    if (const auto* pixel = std::get_if<FocusPixel>(&request.focus)) {
        const V2f film = (V2f(pixel->x, pixel->y) + V2f(0.5f)) / V2f(request.size);
        depth = depth_under(scene, bvh, camera, eye, axis, film);
        if (!depth)
            throw unfit(request,
                        fmt::format("nothing to focus on under pixel {},{}", pixel->x, pixel->y));
    } else {
        depth = depth_of_middle(scene, bvh, camera, eye, axis);
        if (!depth)
            throw unfit(request,
                        "nothing in the middle of the picture to focus on; give --focus in metres");
    }
    notice(fmt::format("focus: {:.4g} m (--focus {})", *depth, *depth));
    return *depth;
}

CameraSetup orthographic(const SceneRequest& request, const GltfCamera& from, float aspect) {
    if (request.fstop || request.lens_radius_m || request.fov_deg || request.focal_length_mm)
        throw unfit(request,
                    fmt::format("camera \"{}\" is orthographic: it takes neither a lens nor an "
                                "angle of view",
                                printable(from.name)));
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

// Where the lens stands and what it looks at; an angle of view is set already.
void place(const SceneRequest& request, const GltfCamera* from, const Box3f& bounds,
           const Notice& notice, ThinLens& lens, CameraReport& report) {
    if (from) {
        lens.to_world = from->to_world;
        report.name = from->name;
        report.target = position(from->to_world) + forward(from->to_world);
    } else {
        const auto aim = request.look_at
                             ? *request.look_at
                             : frame_bounds(request, bounds, lens.yfov_rad, lens.aspect);
        lens.to_world = look_at(aim[0], aim[1]);
        report.target = aim[1];
        if (!request.look_at)
            notice(fmt::format("no camera in the file: --look-at {},{} --fov {}", numbers(aim[0]),
                               numbers(aim[1]), report.yfov_deg));
    }
    report.eye = position(lens.to_world);
}

// The lens decides what is seen; where it stands and looks is as for a thin lens of its angle.
CameraSetup with_lens(const SceneRequest& request, const LoadedLens& loaded, const GltfCamera* from,
                      const Scene& scene, const Bvh& bvh, float aspect, const Notice& notice) {
    CameraSetup setup;
    CameraReport& report = setup.report;
    ThinLens stand_in;
    stand_in.aspect = aspect;
    stand_in.yfov_rad = loaded.yfov_rad();
    report.yfov_deg = stand_in.yfov_rad / kDegree;
    place(request, from, scene.bounds, notice, stand_in, report);
    report.focus_m = find_focus(request, stand_in, scene, bvh, notice);
    LensSetup lens = set_up_lens(*request.lens, loaded, stand_in.to_world, report.focus_m,
                                 request.fstop, request.size.x, notice);
    report.lens = loaded.name();
    report.aperture = request.lens->aperture;
    report.focal_length_mm = static_cast<float>(loaded.focal_length_mm);
    report.sensor_width_mm = loaded.film_mm.x;
    report.sensor_height_mm = loaded.film_mm.y;
    report.film_mm = lens.film_mm;
    report.stop_radius_mm = lens.stop_radius_mm;
    report.lens_radius_m = static_cast<float>(loaded.focal_length_mm * 1e-3 / (2 * lens.fnumber));
    setup.camera = std::move(lens.camera);
    return setup;
}

}  // namespace

CameraSetup set_up_camera(const SceneRequest& request, const std::vector<GltfCamera>& cameras,
                          const std::optional<LoadedLens>& loaded, const Scene& scene,
                          const Bvh& bvh, const Notice& notice) {
    const float aspect = static_cast<float>(request.size.x) / static_cast<float>(request.size.y);
    const GltfCamera* from = nullptr;
    if (request.camera)
        from = &find_camera(request, cameras);
    else if (!request.look_at && !cameras.empty())
        from = &cameras.front();
    if (from && from->orthographic) return orthographic(request, *from, aspect);

    if (loaded) return with_lens(request, *loaded, from, scene, bvh, aspect, notice);
    CameraSetup setup;
    CameraReport& report = setup.report;
    const V2f sensor_mm = film_within(request.sensor_mm.value_or(V2f(36.f, 24.f)), aspect);
    ThinLens lens;
    lens.aspect = aspect;
    if (from && !request.fov_deg && !request.focal_length_mm) {
        lens.yfov_rad = from->yfov_rad;
        report.yfov_deg = lens.yfov_rad / kDegree;
    } else {
        report.yfov_deg = chosen_fov_deg(request, sensor_mm);
        lens.yfov_rad = report.yfov_deg * kDegree;
    }
    place(request, from, scene.bounds, notice, lens, report);

    report.focal_length_mm =
        request.focal_length_mm.value_or(sensor_mm.y / 2 / std::tan(lens.yfov_rad / 2));
    if (request.lens_radius_m) lens.radius_m = *request.lens_radius_m;
    if (request.fstop) lens.radius_m = report.focal_length_mm * 1e-3f / (2 * *request.fstop);
    if (request.fstop || request.lens_radius_m) {
        lens.focus_m = find_focus(request, lens, scene, bvh, notice);
        report.focus_m = lens.focus_m;
    }
    report.sensor_width_mm = sensor_mm.x;
    report.sensor_height_mm = sensor_mm.y;
    report.lens_radius_m = lens.radius_m;
    setup.camera = std::make_unique<ThinLensCamera>(lens);
    return setup;
}

}  // namespace petzval
