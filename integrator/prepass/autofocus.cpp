// SPDX-License-Identifier: Apache-2.0
#include "integrator/prepass/autofocus.h"

#include <algorithm>
#include <vector>

#include "core/shading/surface.h"
#include "integrator/path/front_at_back.h"

namespace petzval::integrator {

std::optional<float> depth_under(const Scene& scene, const Bvh& bvh, const camera::Camera& pinhole,
                                 const V3f& eye, const V3f& axis, V2f film) {
    const camera::CameraSample seen =
        pinhole.sample({film, Sampler(SamplerKind::Owen, 0, {0, 0, 0})}, Bands::rgb());
    if (seen.empty()) return std::nullopt;
    Ray ray = seen[0].ray;
    // Surfaces that are culled from view are no place to focus on.
    while (const std::optional<Hit> hit = bvh.intersect(ray)) {
        const Surface s = make_surface(scene, ray.direction, *hit);
        if (!culled_from_view(s) || front_at_back(scene, bvh, ray, s)) return (s.p - eye).dot(axis);
        ray.origin = offset_origin(s.p, s.p_error, s.ng, ray.direction);
    }
    return std::nullopt;
}

std::optional<float> depth_of_middle(const Scene& scene, const Bvh& bvh,
                                     const camera::Camera& pinhole, const V3f& eye,
                                     const V3f& axis) {
    constexpr int side = 9;
    std::vector<float> depths;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const V2f film = (V2f(i + 0.5f, j + 0.5f) / side + V2f(1, 1)) / 3.f;
            if (const auto depth = depth_under(scene, bvh, pinhole, eye, axis, film))
                depths.push_back(*depth);
        }
    }
    if (depths.empty()) return std::nullopt;
    const auto middle = depths.begin() + static_cast<long>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
}

}  // namespace petzval::integrator
