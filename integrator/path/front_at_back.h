// SPDX-License-Identifier: Apache-2.0
// Surfaces whose back is a reversed copy of their triangles: exporters write such where both sides
// are to be seen. A ray that meets both faces at one place sees the one that faces it.
#pragma once

#include <algorithm>
#include <optional>

#include "core/math/math.h"
#include "core/shading/surface.h"

namespace petzval::integrator {

/// The face whose front a ray meets where it met the back of a single-sided surface: nothing where
/// none lies there. Places count as one within four times what rounding may do to the back, so that
/// copies with other vertices, or that stand at another node, are found too. What leaves the face
/// starts clear of the back. passed: as Bvh::intersect has it.
template <class Caster>
[[nodiscard]] std::optional<Surface> front_at_back(const Scene& scene, const Caster& caster,
                                                   const Ray& ray, const Surface& back,
                                                   const PassedBlends* passed = nullptr) {
    if (back.front) return std::nullopt;   // of a lamp that is not to be seen
    constexpr float least_cosine = 1e-3f;  // a grazing ray runs along both faces
    const float cosine = std::max(std::fabs(back.ng.dot(ray.direction)), least_cosine);
    const V3f& error = back.p_error;
    const float apart = 4 * std::max({error.x, error.y, error.z}) / cosine;
    const float t = (back.p - ray.origin).dot(ray.direction);
    Ray there = ray;
    there.t_max = t + apart + t * rounding_bound(8);
    const auto hit = caster.intersect_front(there, t - apart - t * rounding_bound(8), passed);
    if (!hit) return std::nullopt;
    Surface front = make_surface(scene, ray.direction, *hit);
    front.p_error += V3f(std::fabs((front.p - back.p).dot(back.ng)));
    return front;
}

}  // namespace petzval::integrator
