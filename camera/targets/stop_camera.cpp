// SPDX-License-Identifier: Apache-2.0
#include "camera/targets/stop_camera.h"

#include <algorithm>

#include "camera/lens/trace.h"

namespace petzval::camera {
namespace {

using Asked = std::array<bool, kMostFilmPoints>;
using Crossings = std::array<StopCrossings, kMostFilmPoints>;

const Iris& iris_of(const ThinLensCamera& camera) {
    return *camera.iris();
}
const Iris& iris_of(const AberratedLensCamera& camera) {
    return *camera.iris();
}
const Iris& iris_of(const LensCamera& camera) {
    return camera.input().iris;
}

bool led(const ThinLensCamera&, const FilmPoint&, const Bands&) {
    return true;
}
bool led(const LensCamera& camera, const FilmPoint& at, const Bands& bands) {
    return one_ray(bands, camera.input().dispersion) ||
           (camera.input().dispersion == DispersionMode::Hero && at.pixel.filter);
}
bool led(const AberratedLensCamera& camera, const FilmPoint& at, const Bands& bands) {
    return camera.is_led(at, bands);
}

StopPencil pencil(const ThinLensCamera& camera, V2f film, float) {
    return camera.pencil(film);
}
StopPencil pencil(const AberratedLensCamera& camera, V2f film, float nm) {
    return camera.pencil(film, double(nm));
}

float lane_nm(const Bands& bands, int lane) {
    return bands.spectral ? bands.nm[lane] : kMiddle_nm;
}

template <class C>
std::array<StopRay, 8> rays_of(const C& camera, const std::array<StopPoint, 8>& points) {
    std::array<StopRay, 8> out;
    for (size_t i = 0; i < 8; ++i) {
        const StopPencil rays = pencil(camera, points[i].film, points[i].nm);
        const V2d s = V2d(points[i].stop_mm) * 1e-3;
        out[i] = {V3d(s.x, s.y, 0), rays.direction(s), true, true};
    }
    return out;
}

std::array<StopRay, 8> rays_of(const LensCamera& camera, const std::array<StopPoint, 8>& points) {
    const Lens& lens = *camera.input().lens;
    PlanePoint<f8> film(f8{}, f8{}), stop(f8{}, f8{});
    f8 nm{};
    for (int i = 0; i < 8; ++i) {
        const StopPoint& p = points[size_t(i)];
        const V2f film_mm = camera.film_mm(p.film);
        film.x[i] = film_mm.x, film.y[i] = film_mm.y;
        stop.x[i] = p.stop_mm.x, stop.y[i] = p.stop_mm.y, nm[i] = p.nm;
    }
    const LensIndices<f8> indices = lens.indices(nm);
    const FoundRays aimed = camera.optics().aimer().aim(film, stop, indices, nm);
    const auto traced = [&](Clip clip) {
        LensRay<f8> ray = aimed.ray;
        static_cast<void>(
            trace_lens<f8>({lens, Towards::Scene, {0, lens.stop() - 1}, clip}, indices, ray));
        return ray;
    };
    const LensRay<f8> ray = traced(Clip::No);
    const m8 exists = aimed.found & ray.alive(),
             clear = exists & aimed.clear & traced(Clip::Yes).alive();
    const double z_mm = lens.vertex_mm(ray.counted_from) - camera.input().entrance_pupil_mm;
    const auto at = [](const Vec3<f8>& v, int i) {
        return V3d(double(v.x[i]), double(v.y[i]), double(v.z[i]));
    };
    std::array<StopRay, 8> out;
    for (int i = 0; i < 8; ++i)
        out[size_t(i)] = {(at(ray.origin, i) + V3d(0, 0, z_mm)) * 1e-3, at(ray.direction, i),
                          exists[i] != 0, clear[i] != 0};
    return out;
}

template <class C>
StopPoints drawn(const C& camera, std::span<const FilmPoint> points) {
    StopPoints out{};
    for (size_t i = 0; i < points.size(); ++i) out[i] = camera.drawn_stop_mm(points[i]);
    return out;
}

StopPoints drawn(const LensCamera& camera, std::span<const FilmPoint> points) {
    StopPoints out{};
    for (size_t i = 0; i < points.size(); ++i)
        out[i] = camera.optics()
                     .stop_at(camera.film_mm(points[i].film))
                     .sample(points[i].sampler.get2(Dim::Lens));
    return out;
}

template <class C>
void through(const C& camera, std::span<const FilmPoint> points, std::span<const Bands> bands,
             const StopPoints& stop_mm, std::span<CameraSample> out, const Asked& asked,
             Crossings& crossings) {
    const Iris& iris = iris_of(camera);
    for (size_t i = 0; i < points.size(); ++i) {
        out[i] = camera.through(points[i], stop_mm[i], bands[i]);
        if (!asked[i]) continue;
        out[i].density = iris.transmits(stop_mm[i]) / static_cast<float>(iris.area_mm2());
        StopCrossings& here = crossings[i];
        const bool one = led(camera, points[i], bands[i]);
        for (int lane = 0; lane < 4; ++lane) {
            if (one ? lane != bands[i].hero : !bands[i].on[lane]) continue;
            here.stop_mm[here.lanes] = stop_mm[i];
            here.nm[here.lanes] = lane_nm(bands[i], lane);
            here.stretch[here.lanes++] = 1;
        }
    }
}

/// Crossings of two film points whose lanes share a direction at the film.
void cross_lanes(const LensCamera& camera, const LensCamera::Batch& all, const LeadRays& rays,
                 std::array<size_t, 2> pair, Crossings& crossings) {
    const LensIndices<f8> indices =
        camera.input().lens->indices(joined(all.bands[pair[0]].nm, all.bands[pair[1]].nm));
    PlanePoint<f8> film(f8{}, f8{});
    f8 l{}, m{};
    for (int i = 0; i < 8; ++i) {
        const size_t point = pair[static_cast<size_t>(i / 4)];
        film.x[i] = all.at.film_mm[point].x, film.y[i] = all.at.film_mm[point].y;
        l[i] = rays.aimed.l[int(point)], m[i] = rays.aimed.m[int(point)];
    }
    const AimedRay<f8> crossed = camera.optics().aimer().cross<f8>(film, l, m, indices);
    const f8 stretch = crossed.stretch_mm2();
    for (int k = 0; k < (pair[0] == pair[1] ? 1 : 2); ++k) {
        const size_t point = pair[size_t(k)];
        const Bands& bands = all.bands[point];
        const auto at = [&](int lane) {
            return V2f(crossed.ray.origin.x[4 * k + lane], crossed.ray.origin.y[4 * k + lane]);
        };
        // What the solver left is taken off, as the camera does.
        const V2f off = rays.stop_mm[int(point)] - at(bands.hero);
        StopCrossings& here = crossings[point];
        for (int lane = 0; lane < 4; ++lane) {
            if (!bands.on[lane]) continue;
            here.stop_mm[here.lanes] =
                lane == bands.hero ? rays.stop_mm[int(point)] : at(lane) + off;
            here.nm[here.lanes] = bands.nm[lane];
            here.stretch[here.lanes++] = stretch[4 * k + lane];
        }
    }
}

void through(const LensCamera& camera, std::span<const FilmPoint> points,
             std::span<const Bands> bands, const StopPoints& stop_mm, std::span<CameraSample> out,
             const Asked& asked, Crossings& crossings) {
    const LensCamera::Batch all = camera.batch(points, bands);
    PlanePoint<f8> stop(f8{}, f8{});
    for (size_t i = 0; i < kMostFilmPoints; ++i) {
        // Lanes that are left over repeat the first.
        const V2f p = stop_mm[i < points.size() ? i : 0];
        stop.x[int(i)] = p.x, stop.y[int(i)] = p.y;
    }
    LeadRays rays = camera.optics().aim(all.at, stop, all.indices);
    camera.finish(all, rays, out);
    const auto wanted = [&](size_t i) { return asked[i] && !out[i].empty(); };
    if (all.of_hero) {
        const f8 stretch = rays.aimed.stretch_mm2();
        for (size_t i = 0; i < points.size(); ++i)
            if (wanted(i)) crossings[i] = {1, {stop_mm[i]}, {all.at.nm[int(i)]}, {stretch[int(i)]}};
        return;
    }
    for (size_t i = 0; i < points.size(); i += 2) {
        const size_t next = std::min(i + 1, points.size() - 1);
        if (wanted(i) || wanted(next)) cross_lanes(camera, all, rays, {i, next}, crossings);
    }
}

}  // namespace

std::optional<StopCamera> stop_camera(const std::shared_ptr<const Camera>& camera) {
    if (auto lens = std::dynamic_pointer_cast<const LensCamera>(camera)) return lens;
    if (auto lens = std::dynamic_pointer_cast<const AberratedLensCamera>(camera)) return lens;
    if (auto lens = std::dynamic_pointer_cast<const ThinLensCamera>(camera); lens && lens->iris())
        return lens;
    return std::nullopt;
}

const Iris& iris_of(const StopCamera& camera) {
    return std::visit([](const auto& c) -> const Iris& { return iris_of(*c); }, camera);
}

double stop_reach_mm(const StopCamera& camera) {
    return double(iris_of(camera).bounding_radius_mm());
}

double iris_area_mm2(const StopCamera& camera) {
    return iris_of(camera).area_mm2();
}

const Pose& pose_of(const StopCamera& camera) {
    return std::visit([](const auto& c) -> const Pose& { return c->pose(); }, camera);
}

float leading_nm(const StopCamera& camera, const Bands& bands) {
    if (const auto* lens = std::get_if<std::shared_ptr<const LensCamera>>(&camera))
        if (one_ray(bands, (*lens)->input().dispersion)) return kMiddle_nm;
    return lane_nm(bands, bands.hero);
}

bool is_led(const StopCamera& camera, const FilmPoint& at, const Bands& bands) {
    return std::visit([&](const auto& c) { return led(*c, at, bands); }, camera);
}

std::array<StopRay, 8> rays_through(const StopCamera& camera,
                                    const std::array<StopPoint, 8>& points) {
    return std::visit([&](const auto& c) { return rays_of(*c, points); }, camera);
}

StopPoints drawn_stop_mm(const StopCamera& camera, std::span<const FilmPoint> points) {
    return std::visit([&](const auto& c) { return drawn(*c, points); }, camera);
}

void sample_through(const StopCamera& camera, std::span<const FilmPoint> points,
                    std::span<const Bands> bands, const StopPoints& stop_mm,
                    std::span<CameraSample> out, const Asked& asked, Crossings& crossings) {
    std::visit([&](const auto& c) { through(*c, points, bands, stop_mm, out, asked, crossings); },
               camera);
}

}  // namespace petzval::camera
