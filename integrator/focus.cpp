// SPDX-License-Identifier: Apache-2.0
#include "integrator/focus.h"

#include <algorithm>
#include <vector>

namespace petzval {

std::optional<float> depth_under(const Bvh& bvh, const Camera& pinhole, const V3f& eye,
                                 const V3f& axis, V2f film) {
    const CameraSample seen =
        pinhole.sample({film, Sampler(SamplerKind::Owen, 0, {0, 0, 0})}, Bands::rgb());
    if (seen.count == 0) return std::nullopt;
    const Ray& ray = seen.path[0].ray;
    const std::optional<Hit> hit = bvh.intersect(ray);
    if (!hit) return std::nullopt;
    return (ray.origin + ray.direction * hit->t - eye).dot(axis);
}

std::optional<float> depth_of_middle(const Bvh& bvh, const Camera& pinhole, const V3f& eye,
                                     const V3f& axis) {
    constexpr int side = 9;
    std::vector<float> depths;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const V2f film = (V2f(i + 0.5f, j + 0.5f) / side + V2f(1, 1)) / 3.f;
            if (const auto depth = depth_under(bvh, pinhole, eye, axis, film))
                depths.push_back(*depth);
        }
    }
    if (depths.empty()) return std::nullopt;
    const auto middle = depths.begin() + static_cast<long>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
}

}  // namespace petzval
