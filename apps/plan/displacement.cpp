// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/displacement.h"

#include <algorithm>
#include <cmath>

#include "io/image/symmetric_mse.h"

namespace petzval::apps {
namespace {

constexpr double kCells = 144;
constexpr float kFar_m = camera::FocusPlane::kFar_m;

/// Relative slope of a picture at its sharpest edges, 1/px: at the dark foot of an edge between
/// black and white, drawn by the pixel filter, where mid-grey's floor just holds it.
constexpr double kSlope = 4;

V2i cells_of(V2i size) {
    const double across = std::sqrt(kCells * size.x / size.y);
    const int x = std::clamp(static_cast<int>(std::lround(across)), 1, size.x);
    return {x, std::clamp(static_cast<int>(std::lround(kCells / x)), 1, size.y)};
}

/// Squared distance of a from b over that of c from b, at a distance along each ray.
double relative_square(const Ray& a, const Ray& b, const Ray& c, float at_m) {
    const V3f middle = b.origin + at_m * b.direction;
    // Across the middle ray: a plane through the point.
    const auto meet = [&](const Ray& ray) {
        const float forward = ray.direction.dot(b.direction);
        const float t = (middle - ray.origin).dot(b.direction) / forward;
        return ray.origin + t * ray.direction - middle;
    };
    if (!(a.direction.dot(b.direction) > 0) || !(c.direction.dot(b.direction) > 0)) return INFINITY;
    const double pixel = double(meet(c).length2());
    return pixel > 0 ? double(meet(a).length2()) / pixel : 0;
}

float distance(const Scene& scene, const Hit& hit, const Ray& ray) {
    const auto corners = triangle_corners(scene, hit.instance, hit.triangle);
    const V2f b = hit.barycentric;
    const V3f at = corners[0] * (1 - b.x - b.y) + corners[1] * b.x + corners[2] * b.y;
    return (at - ray.origin).dot(ray.direction);
}

}  // namespace

Displacement displacement_of(const AskedCamera& other, const AskedCamera& base, const Scene& scene,
                             const Bvh& bvh, const camera::FocusPlane& plane, V2i size_px,
                             uint32_t rays_per_cell, bool at_focus) {
    Displacement out;
    const V2i cells = cells_of(size_px);
    out.square_px = out.brightness = {cells, {}};
    const V2f size(size_px);
    for (int j = 0; j < cells.y; ++j)
        for (int i = 0; i < cells.x; ++i) {
            double sum = 0, count = 0, light = 0, other_light = 0;
            for (uint32_t k = 0; k < rays_per_cell; ++k) {
                const Sampler sampler(SamplerKind::Owen, 0, {i, j, k});
                const float u = sampler.get1(Dim::Wavelength);
                const V2f within = sampler.get2(Dim::Film);
                const V2f film((float(i) + within.x) / float(cells.x),
                               (float(j) + within.y) / float(cells.y));
                // Around the middle of the film, at the same height: both see the stop through
                // the same bounds, and draw nearly the same point of it.
                const V2f out_px = (film - V2f(0.5f)) * size;
                const V2f beside = film + V2f(-out_px.y, out_px.x).normalized() / size;
                const auto bands_of = [&](const AskedCamera& c) {
                    return c.observer.spectral() ? c.observer.draw(u) : Bands::rgb();
                };
                const Bands bands = bands_of(base), other_bands = bands_of(other);
                const camera::CameraSample middle = base.camera.sample({film, sampler}, bands);
                const camera::CameraSample next = base.camera.sample({beside, sampler}, bands);
                const camera::CameraSample there =
                    other.camera.sample({film, sampler}, other_bands);
                for (const camera::CameraPath& path : middle)
                    light += double(hsum(zero_off(path.lanes, path.weight))) / lane_count(bands.on);
                for (const camera::CameraPath& path : there)
                    other_light += double(hsum(zero_off(path.lanes, path.weight))) /
                                   lane_count(other_bands.on);
                if (middle.empty() || next.empty()) continue;
                const Ray& ray = middle[0].ray;
                const std::optional<Hit> hit = bvh.intersect(ray);
                const float met_m = hit ? distance(scene, *hit, ray) : kFar_m;
                ++out.rays;
                for (const camera::CameraPath& path : there) {
                    const auto at = [&](float m) {
                        return relative_square(path.ray, ray, next[0].ray, m);
                    };
                    double most = at(met_m);
                    if (at_focus)
                        most = std::max({most, at(std::min(plane.distance_m, kFar_m)), at(kFar_m)});
                    // Beyond the frame nothing is farther; rays that turn back have no distance.
                    most = std::min(most, double(size.length2()));
                    const double share = lane_count(path.lanes);
                    sum += share * most;
                    count += share;
                }
            }
            out.square_px.values.push_back(count > 0 ? sum / count : 0);
            out.brightness.values.push_back(io::symmetric_square(light, other_light, 0));
        }
    return out;
}

FilmMap most_error(const Displacement& displacement, double of_itself) {
    FilmMap out = displacement.square_px;
    for (size_t i = 0; i < out.values.size(); ++i)
        out.values[i] =
            std::min(io::kMostSymmetricMse, of_itself + displacement.brightness.values[i] +
                                                kSlope * kSlope * out.values[i]);
    return out;
}

}  // namespace petzval::apps
