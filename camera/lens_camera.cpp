// SPDX-License-Identifier: Apache-2.0
#include "camera/lens_camera.h"

#include "core/dispersion.h"

namespace petzval {
namespace {

f4 transmitted(const Iris& iris, f4 x, f4 y) {
    f4 out = splat(iris.transmits({x[0], y[0]}));
    for (int i = 1; i < 4; ++i)
        if (x[i] != x[0] || y[i] != y[0]) out[i] = iris.transmits({x[i], y[i]});
    return out;
}

}  // namespace

LensCamera::LensCamera(LensCameraInput in)
    : in_(std::move(in)),
      pose_(in_.to_world),
      pupil_(*in_.lens, in_.film_mm, 0.5 * std::hypot(in_.film_width_mm, in_.film_height_mm)),
      line_d_(in_.lens->exact_indices(splat(static_cast<float>(kLineD_nm)))),
      area_mm2_(static_cast<float>(in_.iris.area_mm2())) {}

// Irradiance is the integral of radiance dL dM, L and M the direction cosines at the film: the
// cosine is in it. A point drawn evenly on the iris and solved for one lane has the density
// stretch / area in (L, M); other lanes might have drawn the same direction, and all are weighed
// with the mean density (balance heuristic: Veach 1997, 9.2.3), so that light at the iris's edge is
// not lost where its image differs between wavelengths.
LensCamera::Draw LensCamera::draw(V2f film_mm, V2f u, float u_lane, const Bands& bands) const {
    const int lane = pick_lane(bands.on, u_lane);
    if (!bands.spectral || in_.chroma == Chroma::Shared)
        return draw(film_mm, u, lane, bands, line_d_, static_cast<float>(kLineD_nm));
    return draw(film_mm, u, lane, bands, in_.lens->indices(bands.nm), bands.nm[lane]);
}

LensCamera::Draw LensCamera::draw(V2f film_mm, V2f u, int lane, const Bands& bands,
                                  const LensIndices<f4>& indices, float nm) const {
    Draw out;
    const V2f on_iris = in_.iris.sample(u);
    const m4 on = in_.chroma == Chroma::Single ? only_lane(lane) : bands.on;
    const auto c = pupil_.solve(film_mm, on_iris, indices, lane, nm);
    if (!c) return out;
    // What the solver leaves is taken off, so that the lane crosses the iris where it was drawn:
    // an iris may be smaller than the tolerance.
    const f4 x = c->x_mm + (on_iris.x - c->x_mm[lane]), y = c->y_mm + (on_iris.y - c->y_mm[lane]);
    const f4 open = zero_off(on & c->ray.alive(), transmitted(in_.iris, x, y));
    const auto lanes = static_cast<float>(lane_count(on));
    const float density = hsum(open * c->stretch_mm2()) / (area_mm2_ * lanes);
    if (!(density > 0.f) || !any(c->clear & (open > 0.f))) return out;
    out.ray = c->ray;
    static_cast<void>(march<f4>(*in_.lens, indices, Towards::Scene, {0, in_.lens->stop() - 1},
                                out.ray, Clip::Yes));
    const float gain = gain_ * static_cast<float>(lane_count(bands.on)) / lanes;
    out.weight = zero_off(c->clear & out.ray.alive(), open * (gain / density));
    return out;
}

Ray LensCamera::world_ray(const LensRay<f4>& ray, int lane) const {
    const V3f point_mm{ray.origin.x[lane], ray.origin.y[lane], behind_pupil_mm(ray, lane)};
    Ray out;
    out.origin = pose_.origin + pose_.to_world(point_mm * 1e-3f);
    out.direction =
        unit(pose_.to_world({ray.direction.x[lane], ray.direction.y[lane], ray.direction.z[lane]}));
    return out;
}

float LensCamera::behind_pupil_mm(const LensRay<f4>& ray, int lane) const {
    return static_cast<float>(ray.origin.z[lane] + in_.lens->vertex_mm(ray.counted_from) -
                              in_.entrance_pupil_mm);
}

// Whether two lanes meet the plane of focus within the tolerance, seen from the lens.
bool LensCamera::together(const LensRay<f4>& ray, int a, int b) const {
    if (in_.chroma == Chroma::Split) return false;
    const float focus_mm = in_.focus_m * 1e3f;
    const auto on_plane = [&](int lane) {
        const float t = (focus_mm + behind_pupil_mm(ray, lane)) / -ray.direction.z[lane];
        return V2f(ray.origin.x[lane] + t * ray.direction.x[lane],
                   ray.origin.y[lane] + t * ray.direction.y[lane]);
    };
    // A fisheye's rays that lead backwards never meet the plane: no guess is made about them.
    if (!(ray.direction.z[a] < 0.f && ray.direction.z[b] < 0.f)) return false;
    return (on_plane(a) - on_plane(b)).length() <= in_.tolerance_rad * focus_mm;
}

CameraSample LensCamera::sample(const FilmPoint& point, const Bands& bands) const {
    // The image stands on its head: what is seen on the right falls on the left of the film.
    const V2f film((0.5f - point.film.x) * static_cast<float>(in_.film_width_mm),
                   (point.film.y - 0.5f) * static_cast<float>(in_.film_height_mm));
    const Draw drawn =
        draw(film, point.sampler.get2(Dim::Lens), point.sampler.get1(Dim::LensLane), bands);
    CameraSample out;
    const m4 alive = drawn.weight > 0.f;
    if (!any(alive)) return out;
    int first = 0;
    while (!alive[first]) ++first;
    const bool one_ray = !bands.spectral || in_.chroma == Chroma::Shared;
    m4 left = alive;
    // Lanes that go nearly the same way share the first one's ray.
    for (int lane = first; lane < 4; ++lane) {
        if (!left[lane]) continue;
        CameraPath& path = out.path[static_cast<size_t>(out.count++)];
        path.ray = world_ray(drawn.ray, lane);
        path.lanes = left;
        for (int other = lane + 1; other < 4; ++other)
            if (!one_ray && left[other] && !together(drawn.ray, lane, other)) path.lanes[other] = 0;
        path.weight = zero_off(path.lanes, drawn.weight);
        left &= ~path.lanes;
    }
    return out;
}

// Smooth but for the edges of the iris and of the rims.
double LensCamera::irradiance(V2f film_mm, int side) const {
    const Bands bands = Bands::rgb();
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const V2f u((static_cast<float>(i) + 0.5f) / static_cast<float>(side),
                        (static_cast<float>(j) + 0.5f) / static_cast<float>(side));
            sum += hsum(draw(film_mm, u, 0.f, bands).weight);
        }
    return sum / (double(side) * side * lane_count(bands.on));
}

}  // namespace petzval
