// SPDX-License-Identifier: Apache-2.0
#include "camera/ray_bundle.h"

#include <algorithm>
#include <array>

namespace petzval::camera {
RayBundle bundle_of(const Camera& camera, const FilmCell& cell, uint32_t seed, V2i drawn_for,
                    int rays) {
    RayBundle out;
    for (int first = 0; first < rays; first += int{kMostFilmPoints}) {
        const auto n = static_cast<size_t>(std::min(rays - first, int{kMostFilmPoints}));
        std::array<FilmPoint, kMostFilmPoints> points;
        std::array<Bands, kMostFilmPoints> bands;
        std::array<CameraSample, kMostFilmPoints> seen;
        for (size_t k = 0; k < n; ++k) {
            const auto i = static_cast<uint32_t>(first) + static_cast<uint32_t>(k);
            const Sampler sampler(SamplerKind::Owen, seed, {drawn_for.x, drawn_for.y, i});
            // The corners, and points within.
            const V2f within = i < 4 ? V2f(float(i & 1), float(i >> 1)) : sampler.get2(Dim::Film);
            points[k] = {cell.first + within * (cell.last - cell.first), sampler};
            bands[k] = Bands::rgb();
        }
        camera.sample_all({points.data(), n}, {bands.data(), n}, {seen.data(), n});
        for (size_t k = 0; k < n; ++k) {
            if (seen[k].empty()) continue;
            out.rays.push_back(seen[k][0].ray);
            out.direction += seen[k][0].ray.direction;
        }
    }
    const float length = out.direction.length();
    out.direction = length > 0 ? out.direction / length : V3f(0.f);
    if (out.rays.empty() || !(length > 0)) return out;
    for (const Ray& ray : out.rays) out.origin += ray.origin / float(out.rays.size());
    for (const Ray& ray : out.rays) {
        out.reach_m = std::max(out.reach_m, (ray.origin - out.origin).length());
        out.least_cosine = std::min(out.least_cosine, ray.direction.dot(out.direction));
    }
    return out;
}

bool has_same_rays(const Camera& a, const Camera& b) {
    constexpr V2i kFrame(6, 6);
    const auto same = [](const Ray& left, const Ray& right) {
        return left.origin == right.origin && left.direction == right.direction;
    };
    for (int y = 0; y < kFrame.y; ++y)
        for (int x = 0; x < kFrame.x; ++x) {
            const FilmCell cell{V2f(V2i(x, y)) / V2f(kFrame), V2f(V2i(x + 1, y + 1)) / V2f(kFrame)};
            const RayBundle of_a = bundle_of(a, cell, 0, {x, y}),
                            of_b = bundle_of(b, cell, 0, {x, y});
            if (!std::equal(of_a.rays.begin(), of_a.rays.end(), of_b.rays.begin(), of_b.rays.end(),
                            same))
                return false;
        }
    return true;
}

}  // namespace petzval::camera
